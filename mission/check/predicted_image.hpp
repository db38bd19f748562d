// SPDX-License-Identifier: BSD-3-Clause
// Predicts an image from a map, and the tracker's verdict on it.
#pragma once

#include "alignment/coarse_to_fine.hpp"
#include "photometry/photometric.hpp"
#include "photometry/view.hpp"

namespace photonav {

struct PredictedImage {
    Matrix6 information = Matrix6::Zero();  ///< photometricInformation(), as the planner uses it
    /// The alignment of an image that equals its prediction: verdict (converged, degenerate or
    /// lostOverlap), overlap, open directions and mean depth.
    Alignment alignment;
};

/// Renders images and applies the tracker's rules for accepting alignments.
class ImagePredictor {
  public:
    /// @param map must outlive the predictor
    /// @param photometric options of the planner's information
    /// @param alignment options of the tracker; noise and stride must be those of `photometric`
    /// @param isStopped asked now and then with large images
    ImagePredictor(const ViewSource& map, const Camera& camera,
                   const PhotometricOptions& photometric, const AlignmentOptions& alignment,
                   IsStopped isStopped);

    /// @throws Interrupted
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
