// SPDX-License-Identifier: BSD-3-Clause
// Calibrates the pose of a depth camera relative to the colour camera, from images of any scene.
#pragma once

#include <memory>

#include "dataset/depth_camera.hpp"
#include "geometry/types.hpp"

namespace photonav {

struct DepthCalibrationOptions {
    // Prior of the depth camera's pose, whose mean is the start: both cameras share a housing. In
    // directions that the images do not observe, the pose stays at the start.
    double translationSigma = 0.03;  ///< standard deviation [m]
    double rotationSigma = 0.03;     ///< standard deviation [rad]
    int stride = 3;                  ///< use every stride-th row and column of the depth images
    double minDepth = 0.3;           ///< nearer depths are not used [m]
    double maxDepth = 6.;            ///< farther depths are not used [m]
};

struct DepthCalibration {
    Pose T_c_d = Pose::Identity();         ///< transforms from depth to colour camera
    Matrix6 covariance = Matrix6::Zero();  ///< left perturbation, colour camera's frame, (rho, phi)
    /// Median of the absolute residuals with the depth camera at the start [grey value].
    double residualBefore = 0.;
    double residualAfter = 0.;  ///< median of the absolute residuals with T_c_d [grey value]
};

/// Calibrates by pairs of colour images of one scene, of which the first has a depth image. If the
/// depth image is displaced against the colour image, texture gets wrong depths, which appear in
/// the residuals between the two images: with p = T_c_d q the point of a depth pixel, n its normal,
/// and T the motion between the images, the residual
///     r = second(pi(T p)) - (gain * first(pi(p)) + offset)
/// changes with a displacement x of the depth camera by
///     -(g . D t) / (n . p) * n^T [1 | -p^] x,
/// g the image gradient, D the derivative of the projection and t the translation of T: a surface
/// moves along its normal, and pixels by their parallax. (The difference of the two images'
/// gradients would give steps a fifth as long as they should be: the gradients cancel, their noise
/// does not.) Motions and exposures are estimated as well. The covariance is the sum of two
/// jackknife estimates: leaving out blocks of pairs, because neighbouring pairs show the same
/// surfaces, and leaving out regions of the image, where the errors of intrinsics and distortion
/// are the same in all pairs.
class DepthCalibrator {
  public:
    /// @param start first estimate of the depth camera's pose; its intrinsics are assumed exact
    DepthCalibrator(const Camera& colour, const DepthCamera& start,
                    const DepthCalibrationOptions& options = {});
    ~DepthCalibrator();
    DepthCalibrator(DepthCalibrator&&) noexcept;
    DepthCalibrator& operator=(DepthCalibrator&&) noexcept;

    /// Adds a pair of colour images.
    /// @param depth_d depth image of the depth camera, taken with `first` [m]; 0: not measured
    /// @param T_second_first motion of the colour camera, accurate to a few pixels
    /// @throws std::invalid_argument for images of other sizes than the cameras'
    void add(const ImageF& first, const ImageF& depth_d, const ImageF& second,
             const Pose& T_second_first);

    std::size_t pairs() const;                      ///< number of pairs added
    static constexpr std::size_t kLeastPairs = 12;  ///< least number of pairs for solve()

    /// The calibration by all pairs.
    /// @throws std::invalid_argument for fewer than kLeastPairs
    DepthCalibration solve();

  private:
    class Problem;
    std::unique_ptr<Problem> problem_;
};

}  // namespace photonav
