// SPDX-License-Identifier: BSD-3-Clause
// The result of tracking for one image.
#pragma once

#include <optional>

#include "alignment/alignment.hpp"

namespace photonav {

struct TrackedFrame {
    double time = 0.;         ///< time of the exposure [s]
    UncertainPose predicted;  ///< belief T_c_w at the exposure, before the image and its vertical
    /// Belief after the image and its vertical; if the image is rejected, after the vertical only.
    UncertainPose T_c_w;
    /// The alignment that the belief follows from; if the image is rejected, the first alignment
    /// that was tried.
    Alignment alignment;
    /// Whether the image did not change the belief: no alignment explained it, or it shows a part
    /// of the scene that the map does not contain. A single rejected image is no loss of tracking:
    /// see Tracker::loss().
    bool rejected = false;
    /// Whether the map, which is built on the same flight, has disagreed with the images for long
    /// (LossOptions::inconsistentAfter). The part in view should be erased and built again at the
    /// pose that odometry predicts.
    bool isMapInconsistent = false;
    /// Time of the keyframe that the image was aligned to, or of the image itself if it became the
    /// first keyframe [s]; none: it was aligned to the map.
    std::optional<double> keyframe;
};

}  // namespace photonav
