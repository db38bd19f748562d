// SPDX-License-Identifier: BSD-3-Clause
// The result of tracking for one image.
#pragma once

#include <optional>

#include "alignment/alignment.hpp"

namespace photonav {

struct TrackedFrame {
    double time = 0.;         ///< of the exposure [s]
    UncertainPose predicted;  ///< belief at the exposure, before the image and its vertical
    UncertainPose T_c_w;  ///< after the image and its vertical; when rejected, without the image
    /// The alignment that the belief follows from; when rejected, the first that was tried.
    Alignment alignment;
    /// The image did not change the belief: no alignment explained it, or it shows what the map
    /// lacks. One rejected image is no loss of tracking: see Tracker::loss().
    bool rejected = false;
    /// The map, made on the same flight, has contradicted the images for long: it is to be
    /// forgotten where it is in view, and made again at the pose that odometry predicts.
    bool isMapDoubted = false;
    /// Time of the keyframe that the image was aligned to, its own if it began one [s]; none: it
    /// was aligned to the map.
    std::optional<double> keyframe;
};

}  // namespace photonav
