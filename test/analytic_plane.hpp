// SPDX-License-Identifier: BSD-3-Clause
// Exact views of a plane with a smooth analytic texture: no renderer, no sampling, no filter.
#pragma once

#include <cmath>
#include <numbers>

#include "photometry/view.hpp"

namespace photonav {

/// An infinite plane through `point_w`, spanned by two orthonormal axes, with a sum of sinusoids as
/// its texture.
struct AnalyticPlane {
    Eigen::Vector3d point_w = Eigen::Vector3d::Zero();
    Eigen::Vector3d first_w = Eigen::Vector3d::UnitX();
    Eigen::Vector3d second_w = Eigen::Vector3d::UnitY();
    double wavelength = 1.;  ///< of the texture [m]
    bool stripes = false;    ///< vary along the first axis only

    double texture(double a, double b) const {
        const double k = 2. * std::numbers::pi / wavelength;
        if (stripes) return 0.5 + 0.3 * std::sin(k * a);
        return 0.5 + 0.15 * std::sin(k * a + 0.3) + 0.15 * std::sin(0.8 * k * b) +
               0.1 * std::sin(0.6 * k * (a + b)) + 0.05 * std::sin(0.9 * k * (a - 0.7 * b));
    }

    /// z in the camera frame along the ray of pixel (u, v); not positive where the plane is behind
    double depth(const Camera& camera, const Pose& T_c_w, double u, double v) const {
        const Eigen::Vector3d ray((u - camera.cx()) / camera.fx(), (v - camera.cy()) / camera.fy(),
                                  1.);
        const Eigen::Vector3d normal = T_c_w.linear() * first_w.cross(second_w);
        return normal.dot(T_c_w * point_w) / normal.dot(ray);
    }

    /// Exact grey value at pixel (u, v), which need not be an integer.
    double intensity(const Camera& camera, const Pose& T_c_w, double u, double v) const {
        const Eigen::Vector3d ray((u - camera.cx()) / camera.fx(), (v - camera.cy()) / camera.fy(),
                                  1.);
        const Eigen::Vector3d p_w = T_c_w.inverse() * (depth(camera, T_c_w, u, v) * ray);
        return texture((p_w - point_w).dot(first_w), (p_w - point_w).dot(second_w));
    }

    View view(const Camera& camera, const Pose& T_c_w) const {
        View view;
        view.intensity.resize(camera.height, camera.width);
        view.depth.resize(camera.height, camera.width);
        for (unsigned v = 0; v < camera.height; ++v) {
            for (unsigned u = 0; u < camera.width; ++u) {
                const double z = depth(camera, T_c_w, u, v);
                view.depth[v][u] = z > 0. ? static_cast<float>(z) : 0.F;
                view.intensity[v][u] =
                    z > 0. ? static_cast<float>(intensity(camera, T_c_w, u, v)) : 0.F;
            }
        }
        return view;
    }
};

/// The paper's camera at a quarter of its size.
inline Camera defaultCamera() { return makeCamera(188, 120, 70. * std::numbers::pi / 180.); }

}  // namespace photonav
