// SPDX-License-Identifier: BSD-3-Clause
#include "scene/coincident_surfaces.hpp"

#include <algorithm>
#include <cmath>

namespace photonav {
namespace {

constexpr double kThickness = 1e-3;  // [m]
constexpr double kParallel = 1e-2;   // sine of the angle between planes
constexpr int kSamples = 8;          // along a side of a triangle

using Corners = std::array<Eigen::Vector3d, 3>;

Corners cornersOf(const Triangle& triangle) {
    const auto& c = triangle.corners;
    return {c[0].cast<double>(), c[1].cast<double>(), c[2].cast<double>()};
}

Eigen::Vector3d normalOf(const Corners& t) { return (t[1] - t[0]).cross(t[2] - t[0]).normalized(); }

bool areInOnePlane(const Corners& a, const Corners& b) {
    const Eigen::Vector3d normal = normalOf(a);
    return normal.cross(normalOf(b)).norm() < kParallel &&
           std::ranges::all_of(b, [&](const Eigen::Vector3d& corner) {
               return std::abs(normal.dot(corner - a[0])) < kThickness;
           });
}

/// Of a point in its plane.
bool contains(const Corners& t, const Eigen::Vector3d& p) {
    const Eigen::Vector3d normal = normalOf(t);
    for (int i = 0; i < 3; ++i) {
        const Eigen::Vector3d side = t[(i + 1) % 3] - t[i];
        if (normal.dot(side.cross(p - t[i])) < kThickness * side.norm()) return false;
    }
    return true;
}

/// Whether any of some points inside a triangle is in the other one.
bool reaches(const Corners& from, const Corners& to) {
    for (int i = 0; i < kSamples; ++i) {
        for (int j = 0; i + j < kSamples; ++j) {
            const double u = (i + 1. / 3.) / kSamples, v = (j + 1. / 3.) / kSamples;
            if (contains(to, from[0] + u * (from[1] - from[0]) + v * (from[2] - from[0]))) {
                return true;
            }
        }
    }
    return false;
}

bool isInside(const Prism& prism, const Eigen::Vector3f& corner) {
    const Eigen::Vector3d p = corner.cast<double>();
    const std::size_t n = prism.footprint.size();
    for (std::size_t i = 0; i < n; ++i) {
        const Eigen::Vector2d side = prism.footprint[(i + 1) % n] - prism.footprint[i];
        const Eigen::Vector2d way = p.head<2>() - prism.footprint[i];
        const double toTheLeft = side.x() * way.y() - side.y() * way.x();
        if (toTheLeft < -kThickness * side.norm()) return false;
    }
    return p.z() > prism.low - kThickness && p.z() < prism.high + kThickness;
}

}  // namespace

Scene withoutSolids(const Scene& scene) {
    Scene sheets = scene;
    std::erase_if(sheets.triangles, [&](const Triangle& triangle) {
        return std::ranges::any_of(scene.solids, [&](const Prism& solid) {
            return std::ranges::all_of(triangle.corners,
                                       [&](const auto& corner) { return isInside(solid, corner); });
        });
    });
    sheets.solids.clear();
    return sheets;
}

bool haveCoincidentSurfaces(const Scene& a, const Scene& b) {
    return std::ranges::any_of(a.triangles, [&](const Triangle& one) {
        const Corners first = cornersOf(one);
        return std::ranges::any_of(b.triangles, [&](const Triangle& other) {
            const Corners second = cornersOf(other);
            return areInOnePlane(first, second) &&
                   (reaches(first, second) || reaches(second, first));
        });
    });
}

}  // namespace photonav
