// SPDX-License-Identifier: BSD-3-Clause
// Visual odometry without a map: an image with depth is the model to which other images are
// aligned.
#pragma once

#include <memory>

#include "alignment/coarse_to_fine.hpp"

namespace photonav {

struct KeyframeOptions {
    KeyframeOptions();

    /// `alignment.levels` counts from `finest` on. By default iterations end at steps of one
    /// standard deviation, which is far below the errors of real depth images.
    AlignmentOptions alignment;
    int finest = 1;         ///< finest level used: 0 full size, 1 half the size
    double minDepth = 0.1;  ///< nearer depths are not used [m]
    double maxDepth = 10.;  ///< farther depths are not used [m]
    /// Largest relative difference of the depths that are merged to a pixel of the next level.
    double depthSpread = 0.05;
    /// Largest relative second difference of inverse depth between pixels, divided by the angle of
    /// a pixel [1/rad]. Measured depth that bends more is mostly wrong.
    double maxBend = 1.5;
    /// Least gradient of the pixels used [grey value per pixel of the level]. Others have little
    /// information but take time.
    double minGradient = 0.01;
};

/// Aligns images to a keyframe with intensity I and depth. The alignment is inverse-compositional:
/// gradients and geometry of the keyframe are computed once, and its pixels are projected into the
/// observed image,
///     r = observed(pi(T p)) - (gain * I + offset),   T <- T exp(xi^),   r = -gain * J xi,
/// where J is the Jacobian of photometricInformation() at the keyframe. The gradients of a keyframe
/// are noisy, which makes covariances less consistent than those of alignment to a rendered map
/// (dense_aligner.hpp). Covariances follow from the residuals.
class KeyframeModel {
  public:
    /// @param view of the camera's size; depth 0: not measured
    /// @param T_k_w pose of the keyframe, assumed exact: covariances are relative to the keyframe
    /// @throws std::invalid_argument for a view of another size, or too small for the finest level
    KeyframeModel(const View& view, const Camera& camera, const Pose& T_k_w = Pose::Identity(),
                  const KeyframeOptions& options = {});
    ~KeyframeModel();
    KeyframeModel(KeyframeModel&&) noexcept;
    KeyframeModel& operator=(KeyframeModel&&) noexcept;

    /// Pose T_c_w of the camera when it took `observed`, from a start or from a prior of T_c_w.
    /// Alignment::overlap is the share of the keyframe's points that fall into the image. Not
    /// thread-safe.
    /// @throws std::invalid_argument for an image of another size
    Alignment align(const ImageF& observed, const Pose& T_start);
    Alignment align(const ImageF& observed, const UncertainPose& prior);

    const Pose& pose() const;  ///< T_k_w

  private:
    class Points;
    std::unique_ptr<Points> points_;
};

}  // namespace photonav
