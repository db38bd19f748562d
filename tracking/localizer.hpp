// SPDX-License-Identifier: BSD-3-Clause
// Where the camera is in a map, image by image, when nothing but its images is known.
#pragma once

#include "motion_model.hpp"
#include "pose_filter.hpp"

namespace photonav {

struct LocalizerOptions {
    AlignmentOptions alignment;
    MotionNoise motion;
    double mostTranslation = 1.;  ///< standard deviation at which a lost belief stops growing [m]
    double mostRotation = 0.5;    ///< [rad]
    /// Share of maxUnexplained that an image after a lost one may leave: little else speaks for it.
    double sureness = 0.5;
};

/// PoseFilter with MotionModel in place of measured motion. A lost image is tried again from where
/// the camera was last certain; then the belief stays there and grows.
class Localizer {
  public:
    /// @param map must outlive the localizer
    Localizer(const ViewSource& map, const Camera& camera, const UncertainPose& start,
              const LocalizerOptions& options = {});

    /// @param observed of the camera's size @throws std::invalid_argument otherwise
    /// @param timestamp [s] larger than the one before
    TrackedFrame track(const ImageF& observed, double timestamp);

    const UncertainPose& belief() const { return filter_.belief(); }

  private:
    UncertainPose bounded(UncertainPose belief) const;
    bool isSure(const Alignment& alignment) const;

    LocalizerOptions options_;
    DenseAligner aligner_;
    MotionModel motion_;
    PoseFilter filter_;
    std::optional<double> lastTime_;
    bool isLost_ = false;
};

}  // namespace photonav
