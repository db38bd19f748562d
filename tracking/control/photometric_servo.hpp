// SPDX-License-Identifier: BSD-3-Clause
// Photometric visual servoing on the view of the goal, for the last centimetres.
#pragma once

#include <memory>

#include "control/body_velocity.hpp"
#include "photometry/photometric.hpp"

namespace photonav {

struct PhotometricServoOptions {
    PhotometricOptions photometric;
    double gain = 1.;  ///< rate at which the error decreases exponentially [1/s]
    /// Largest standard deviation that the goal's view may leave to be used [m, rad].
    double maxSigma = 0.02;
    double maxUnexplained = 0.4;  ///< see TrustOptions
};

/// Direct visual servoing (Collewet and Marchand 2011): the features are the grey values of all
/// pixels, with the depth of each from the map (PixelDepthLuminance), the control law is vpServo's
/// with the interaction matrix at the goal. No pose is estimated, so no error of an estimate stays.
class PhotometricServo {
  public:
    /// @param map must outlive the servo
    /// @param T_w_goal body pose at the goal
    PhotometricServo(const ViewSource& map, const Camera& camera, const Pose& T_b_c,
                     const Pose& T_w_goal, const PhotometricServoOptions& options);
    ~PhotometricServo();
    PhotometricServo(PhotometricServo&&) noexcept;
    PhotometricServo& operator=(PhotometricServo&&) noexcept;

    /// Whether the goal's view determines all four velocities well enough (maxSigma).
    bool isInformative() const;
    /// Largest standard deviation that the noise of one image leaves in a displacement [m, rad].
    double sigma() const;

    struct Step {
        BodyVelocity velocity;      ///< not limited
        BodyVelocity displacement;  ///< to the goal, to first order [m, rad]
        double unexplained = 1.;    ///< share of the images' variance, see TrustOptions
        bool isTrusted = false;     ///< the goal's view explains the image
    };
    /// @param T_w_b believed pose of the body. Only its tilt is used: the view of the goal is
    /// rendered
    ///        with this tilt, which the four velocities cannot correct
    Step toward(const ImageF& observed, const Pose& T_w_b);

  private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace photonav
