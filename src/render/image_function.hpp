// SPDX-License-Identifier: BSD-3-Clause
// Linear functions of a ray as functions of the pixel.
#pragma once

#include <Eigen/Core>

#include "geometry/camera.hpp"

namespace photonav {

/// a x + b y + c over the image, x and y in pixels.
struct ImageFunction {
    double a = 0., b = 0., c = 0.;

    double operator()(double x, double y) const { return a * x + b * y + c; }
    ImageFunction operator-(const ImageFunction& other) const {
        return {a - other.a, b - other.b, c - other.c};
    }
};

/// The function perRay . d of the rays d = (x, y, 1) of the pixels.
inline ImageFunction inPixels(const Eigen::Vector3d& perRay, const Camera& camera) {
    const double a = perRay.x() / camera.fx(), b = perRay.y() / camera.fy();
    return {a, b, perRay.z() - a * camera.cx() - b * camera.cy()};
}

}  // namespace photonav
