// SPDX-License-Identifier: BSD-3-Clause
// Exact views of a textured horizontal plane, for tests of mapping and of view synthesis.
#pragma once

#include <cmath>
#include <functional>
#include <random>

#include "photometry/view.hpp"

namespace photonav::test {

using FloorTexture = std::function<double(double x, double y)>;

/// A carpet: soft blobs of 0.2 to 1 m.
inline double carpet(double x, double y) {
    return 0.5 + 0.12 * std::sin(6.1 * x + 1.7 * std::sin(2.3 * y)) +
           0.12 * std::sin(7.3 * y + 1.3 * std::sin(3.1 * x + 1.)) +
           0.08 * std::sin(17. * (x + 0.6 * y)) * std::sin(13. * (y - 0.4 * x));
}

/// A camera at (x, y, height) with the given angle below the horizon, looking along `yaw`.
inline Pose lookDown(double x, double y, double height, double belowHorizon, double yaw = 0.) {
    return lookFrom({x, y, height}, belowHorizon, yaw);
}

/// The plane z = height over |x|, |y| < extent; each pixel is the mean of 2 x 2 rays.
inline View floorView(const Camera& camera, const Pose& T_c_w, const FloorTexture& texture,
                      double height = 0., double extent = 1e3) {
    View view;
    view.intensity.resize(camera.height, camera.width, 0.F);
    view.depth.resize(camera.height, camera.width, 0.F);
    const Pose T_w_c = T_c_w.inverse();
    const auto plane = [&](double u, double v, Eigen::Vector3d& p) {
        const Eigen::Vector3d ray((u - camera.cx()) / camera.fx(), (v - camera.cy()) / camera.fy(),
                                  1.);
        const Eigen::Vector3d d = T_w_c.linear() * ray;
        const double z = (height - T_w_c.translation().z()) / d.z();
        p = T_w_c.translation() + z * d;
        return z > 0. && std::abs(p.x()) < extent && std::abs(p.y()) < extent ? z : 0.;
    };
    for (unsigned v = 0; v < camera.height; ++v) {
        for (unsigned u = 0; u < camera.width; ++u) {
            Eigen::Vector3d p;
            view.depth[v][u] = static_cast<float>(plane(u, v, p));
            if (view.depth[v][u] == 0.F) continue;
            double sum = 0.;
            for (int i = 0; i < 4; ++i) {
                plane(u + 0.5 * (i % 2) - 0.25, v + 0.5 * (i / 2) - 0.25, p);
                sum += texture(p.x(), p.y());
            }
            view.intensity[v][u] = static_cast<float>(sum / 4.);
        }
    }
    return view;
}

/// The point that pixel (u, v) shows, in w.
inline Eigen::Vector3d pointOf(const View& view, const Camera& camera, const Pose& T_c_w,
                               unsigned u, unsigned v) {
    return T_c_w.inverse() *
           (view.depth[v][u] *
            Eigen::Vector3d((u - camera.cx()) / camera.fx(), (v - camera.cy()) / camera.fy(), 1.));
}

inline void addNoise(ImageF& image, double sigma, unsigned seed) {
    std::mt19937 random(seed);
    std::normal_distribution<float> noise(0.F, static_cast<float>(sigma));
    for (unsigned i = 0; i < image.getSize(); ++i) {
        image.bitmap[i] = std::clamp(image.bitmap[i] + noise(random), 0.F, 1.F);
    }
}

inline std::vector<float> pixels(const ImageF& image) {
    return {image.bitmap, image.bitmap + image.getSize()};
}

inline constexpr double kDown = std::numbers::pi / 2.;

}  // namespace photonav::test
