// SPDX-License-Identifier: BSD-3-Clause
#include "geometry/camera.hpp"

#include <cmath>
#include <numbers>
#include <stdexcept>

#include "geometry/se3.hpp"

namespace photonav {

Camera makeCamera(unsigned width, unsigned height, double horizontalFov) {
    if (width == 0 || height == 0) throw std::invalid_argument("camera: empty image");
    if (!(horizontalFov > 0. && horizontalFov < std::numbers::pi)) {
        throw std::invalid_argument("camera: field of view outside (0, pi)");
    }
    const double focal = 0.5 * width / std::tan(0.5 * horizontalFov);
    return {width, height,
            vpCameraParameters(focal, focal, 0.5 * (width - 1.), 0.5 * (height - 1.))};
}

Camera scaled(const Camera& camera, double factor) {
    const auto pixels = [&](unsigned n) { return static_cast<unsigned>(std::lround(n * factor)); };
    const auto centre = [&](double c) { return (c + 0.5) * factor - 0.5; };
    return {pixels(camera.width), pixels(camera.height),
            vpCameraParameters(camera.fx() * factor, camera.fy() * factor, centre(camera.cx()),
                               centre(camera.cy())),
            camera.hasPointSpread};
}

Pose cameraMount(double belowHorizon) {
    const double c = std::cos(belowHorizon);
    const double s = std::sin(belowHorizon);
    Pose T_b_c = Pose::Identity();
    T_b_c.linear().col(0) = -Eigen::Vector3d::UnitY();    // image right is the body's right
    T_b_c.linear().col(1) = Eigen::Vector3d(-s, 0., -c);  // image down
    T_b_c.linear().col(2) = Eigen::Vector3d(c, 0., -s);   // optical axis
    return T_b_c;
}

Pose lookFrom(const Eigen::Vector3d& p_w, double belowHorizon, double yaw) {
    return (levelPose(p_w, yaw) * cameraMount(belowHorizon)).inverse();
}

}  // namespace photonav
