// SPDX-License-Identifier: BSD-3-Clause
// The last centimetres: servoing on the grey values of the goal's view.
#pragma once

#include <memory>

#include "control/body_velocity.hpp"
#include "photometry/photometric.hpp"

namespace photonav {

struct PhotometricServoOptions {
    PhotometricOptions photometric;
    double gain = 1.;        ///< of the error's exponential decrease [1/s]
    double maxSigma = 0.02;  ///< the goal's view is good for it when it leaves no more [m, rad]
    double maxUnexplained = 0.4;  ///< see TrustOptions
};

/// Direct visual servoing (Collewet and Marchand 2011): the features are the grey values of all
/// pixels, with the depth of each from the map (PixelDepthLuminance), the control law is vpServo's
/// with the interaction matrix at the goal. No pose is estimated, so no error of an estimate stays.
class PhotometricServo {
  public:
    /// @param map must outlive the servo
    /// @param T_w_goal body pose of the goal
    PhotometricServo(const ViewSource& map, const Camera& camera, const Pose& T_b_c,
                     const Pose& T_w_goal, const PhotometricServoOptions& options);
    ~PhotometricServo();
    PhotometricServo(PhotometricServo&&) noexcept;
    PhotometricServo& operator=(PhotometricServo&&) noexcept;

    /// Whether the goal's view determines all four velocities.
    bool isInformative() const;
    /// Largest standard deviation that the noise of one image leaves in a displacement [m, rad].
    double sigma() const;

    struct Step {
        BodyVelocity velocity;      ///< before any limit
        BodyVelocity displacement;  ///< from here to the goal to first order [m, rad]
        double unexplained = 1.;    ///< share of the images' variance, see TrustOptions
        bool isTrusted = false;     ///< the goal's view explains the image
    };
    /// @param T_w_b believed pose of the body; of it only the tilt counts, which the four
    /// velocities cannot mend and which a view that hung otherwise would take for a displacement
    Step toward(const ImageF& observed, const Pose& T_w_b);

  private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace photonav
