// SPDX-License-Identifier: BSD-3-Clause
// Where a depth camera sits beside the colour camera, from images that were not made for it.
#pragma once

#include <memory>

#include "dataset/depth_camera.hpp"
#include "geometry/types.hpp"

namespace photonav {

struct DepthCalibrationOptions {
    /// Prior of the depth camera's pose, about where the calibration starts: both cameras share a
    /// housing. Directions that the images leave open stay there.
    double translationSigma = 0.03;  ///< [m]
    double rotationSigma = 0.03;     ///< [rad]
    int stride = 3;                  ///< every n-th row and column of the depth images is used
    double minDepth = 0.3;           ///< nearer depths are not used [m]
    double maxDepth = 6.;            ///< farther depths are not used [m]
};

struct DepthCalibration {
    Pose T_c_d = Pose::Identity();
    Matrix6 covariance = Matrix6::Zero();  ///< left perturbation, colour camera's frame, (rho, phi)
    double residualBefore = 0.;            ///< median of the absolute residuals with the start's
                                           ///< pose of the depth camera [grey value]
    double residualAfter = 0.;             ///< the same with T_c_d
};

/// Pairs of colour images of one scene, of which the first has a depth image. Depth that is moved
/// against the colours gives texture wrong depths, which the motion between the images shows: with
/// p = T_c_d q the point of a depth pixel, n its normal, and T the motion, the residual
///     r = second(pi(T p)) - (gain * first(pi(p)) + offset)
/// changes with a displacement x of the depth camera by
///     -(g . D t) / (n . p) * n^T [1 | -p^] x,
/// g the image gradient, D the derivative of the projection and t the translation of T: a surface
/// moves along its normal, and pixels by their parallax. (By the gradients of both images at p
/// alone, whose noise does not cancel as the gradients do, steps are a fifth as long as they should
/// be.) Motions and exposures are estimated as well. The covariance is what leaving out blocks of
/// pairs changes, since neighbouring pairs see the same surfaces, and what leaving out regions of
/// the image changes, where the errors of intrinsics and distortion are the same in all pairs.
class DepthCalibrator {
  public:
    /// @param start where the depth camera is believed to be; its intrinsics are taken as exact
    DepthCalibrator(const Camera& colour, const DepthCamera& start,
                    const DepthCalibrationOptions& options = {});
    ~DepthCalibrator();
    DepthCalibrator(DepthCalibrator&&) noexcept;
    DepthCalibrator& operator=(DepthCalibrator&&) noexcept;

    /// @param depth_d taken with `first`, in the depth camera's frame [m]; 0: not measured
    /// @param T_second_first a first estimate, by a few pixels
    /// @throws std::invalid_argument for images of other sizes than the cameras'
    void add(const ImageF& first, const ImageF& depth_d, const ImageF& second,
             const Pose& T_second_first);

    std::size_t pairs() const;
    static constexpr std::size_t kLeastPairs = 12;

    /// @throws std::invalid_argument for fewer than kLeastPairs
    DepthCalibration solve();

  private:
    class Problem;
    std::unique_ptr<Problem> problem_;
};

}  // namespace photonav
