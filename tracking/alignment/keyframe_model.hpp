// SPDX-License-Identifier: BSD-3-Clause
// Visual odometry: an image with depth as the model of the images around it, where there is no map.
#pragma once

#include <memory>

#include "alignment/coarse_to_fine.hpp"

namespace photonav {

struct KeyframeOptions {
    KeyframeOptions();

    /// `levels` counts from `finest` on. By default iterations end at steps of one standard
    /// deviation, which is far below the errors of real depth images.
    AlignmentOptions alignment;
    int finest = 1;             ///< finest level used: 0 full size, 1 half the size
    double minDepth = 0.1;      ///< nearer depths are not used [m]
    double maxDepth = 10.;      ///< farther depths are not used [m]
    double depthSpread = 0.05;  ///< pixels merged by the pyramid must agree in depth to this share
    /// Largest relative second difference of inverse depth from pixel to pixel, per pixel's angle
    /// [1/rad]. Measured depth that bends more is mostly wrong.
    double maxBend = 1.5;
    /// Pixels with a smaller gradient are not used, because they inform little but take time [grey
    /// value per pixel of the level].
    double minGradient = 0.01;
};

/// Intensity and depth of a keyframe, aligned inverse-compositionally: gradients and geometry of
/// the keyframe are computed once, its pixels are looked up in the observed image,
///     r = observed(pi(T p)) - (gain * I + offset),   T <- T exp(xi^),   r = -gain * J xi,
/// J the Jacobian of photometricInformation() at the keyframe. Both images are noisy and so are the
/// gradients, which makes covariances less consistent than those of alignment to a rendered map
/// (dense_aligner.hpp). They follow from the residuals.
class KeyframeModel {
  public:
    /// @param view of the camera's size; depth 0: not measured
    /// @param T_k_w pose of the keyframe, taken as certain: covariances are relative to it
    /// @throws std::invalid_argument for a view of another size, or too small for the finest level
    KeyframeModel(const View& view, const Camera& camera, const Pose& T_k_w = Pose::Identity(),
                  const KeyframeOptions& options = {});
    ~KeyframeModel();
    KeyframeModel(KeyframeModel&&) noexcept;
    KeyframeModel& operator=(KeyframeModel&&) noexcept;

    /// Pose of the camera when it took `observed`. `overlap` is the share of the keyframe's points
    /// that fall into the image. Not thread-safe.
    /// @throws std::invalid_argument for an image of another size
    Alignment align(const ImageF& observed, const Pose& T_start);
    Alignment align(const ImageF& observed, const UncertainPose& prior);

    const Pose& pose() const;  ///< T_k_w

  private:
    class Points;
    std::unique_ptr<Points> points_;
};

}  // namespace photonav
