// SPDX-License-Identifier: BSD-3-Clause
// The pinhole camera and how it is mounted on the body.
#pragma once

#include <visp3/core/vpCameraParameters.h>

#include "geometry/types.hpp"

namespace photonav {

/// An undistorted pinhole camera. Normalised image coordinates are x = (u - u0) / px and y = (v -
/// v0) / py; pixel centres lie at integer (u, v).
struct Camera {
    unsigned width = 188;   ///< pixels (default: the paper's quarter-size image)
    unsigned height = 120;  ///< pixels
    vpCameraParameters intrinsics;
    /// False: rendered pixels are single rays, applyPointSpread() is left out.
    bool hasPointSpread = true;

    double fx() const { return intrinsics.get_px(); }
    double fy() const { return intrinsics.get_py(); }
    double cx() const { return intrinsics.get_u0(); }
    double cy() const { return intrinsics.get_v0(); }

    /// The pixel (u, v) of a point in the camera frame, z > 0.
    Eigen::Vector2d project(const Eigen::Vector3d& p_c) const {
        return {cx() + fx() * p_c.x() / p_c.z(), cy() + fy() * p_c.y() / p_c.z()};
    }

    /// The point of pixel (u, v) at depth z along the optical axis, in the camera frame.
    Eigen::Vector3d unproject(double u, double v, double z = 1.) const {
        return z * Eigen::Vector3d((u - cx()) / fx(), (v - cy()) / fy(), 1.);
    }

    /// Derivative of project() by p_c [pixels/m].
    Eigen::Matrix<double, 2, 3> projectionJacobian(const Eigen::Vector3d& p_c) const {
        const double x = fx() / p_c.z(), y = fy() / p_c.z();
        Eigen::Matrix<double, 2, 3> J;
        J << x, 0., -x * p_c.x() / p_c.z(), 0., y, -y * p_c.y() / p_c.z();
        return J;
    }
};

/// Square pixels, principal point in the image centre.
/// @param horizontalFov full angle between the outer edges of the first and last column [rad]
/// @throws std::invalid_argument for an empty image or a field of view outside (0, pi)
Camera makeCamera(unsigned width, unsigned height, double horizontalFov);

/// The same field of view with `factor` times as many pixels along each axis; factor < 1 merges
/// pixels.
Camera scaled(const Camera& camera, double factor);

/// Camera mount T_b_c for an optical axis in the body's x-z plane.
/// @param belowHorizon angle of the optical axis below the horizon [rad]: 0 looks forward, pi/4 is
///        the 45-degree front camera, pi/2 looks straight down with the image's top toward body x.
Pose cameraMount(double belowHorizon);

/// Camera pose T_c_w on a level body at p_w.
/// @param belowHorizon angle of the optical axis below the horizon [rad], see cameraMount()
/// @param yaw heading about the world's z axis [rad]
Pose lookFrom(const Eigen::Vector3d& p_w, double belowHorizon, double yaw = 0.);

}  // namespace photonav
