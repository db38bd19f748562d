// SPDX-License-Identifier: BSD-3-Clause
// What the tracker would make of an image from a pose, predicted by the map.
#pragma once

#include "alignment/coarse_to_fine.hpp"
#include "photometry/photometric.hpp"
#include "photometry/view.hpp"

namespace photonav {

struct PredictedImage {
    Matrix6 information = Matrix6::Zero();  ///< of the planner: photometricInformation()
    /// Verdict (converged, degenerate or lostOverlap), overlap, open directions and mean depth of
    /// an image that equals its prediction.
    Alignment alignment;
};

/// Renders images and judges them by the rules of alignments.
class ImagePredictor {
  public:
    /// @param map must outlive it
    /// @param photometric of the planner's information
    /// @param alignment of the tracker; its noise and pixels must be the planner's
    ImagePredictor(const ViewSource& map, const Camera& camera,
                   const PhotometricOptions& photometric, const AlignmentOptions& alignment);

    PredictedImage at(const Pose& T_c_w);

  private:
    const ViewSource& map_;
    Camera camera_;
    PhotometricOptions photometric_;
    AlignmentOptions alignment_;
    ViewComparison comparison_;
    View view_;  ///< rendered last
};

}  // namespace photonav
