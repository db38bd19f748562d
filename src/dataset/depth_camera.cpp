// SPDX-License-Identifier: BSD-3-Clause
#include "dataset/depth_camera.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>
#include <vector>

namespace photonav {
namespace {

constexpr float kSpread = 0.05F;  // of the depths of one surface, relative to the nearest

/// A point in the colour image: pixel and inverse depth, which is linear in the pixel on a plane.
struct Vertex {
    float u = 0.F, v = 0.F, w = 0.F;
};

/// Twice the signed area of the triangle a, b, (u, v).
float side(const Vertex& a, const Vertex& b, float u, float v) {
    return (b.u - a.u) * (v - a.v) - (b.v - a.v) * (u - a.u);
}

/// Keeps the larger inverse depth at the pixels whose centres lie in the triangle.
void draw(const Vertex& a, const Vertex& b, const Vertex& c, ImageF& inverse) {
    const float area = side(a, b, c.u, c.v);
    if (area == 0.F) return;
    const auto [left, right] = std::minmax({a.u, b.u, c.u});
    const auto [top, bottom] = std::minmax({a.v, b.v, c.v});
    const int u0 = std::max(0, static_cast<int>(std::ceil(left)));
    const int v0 = std::max(0, static_cast<int>(std::ceil(top)));
    const int u1 = std::min(static_cast<int>(inverse.getWidth()) - 1, static_cast<int>(right));
    const int v1 = std::min(static_cast<int>(inverse.getHeight()) - 1, static_cast<int>(bottom));
    for (int v = v0; v <= v1; ++v) {
        for (int u = u0; u <= u1; ++u) {
            const float x = static_cast<float>(u), y = static_cast<float>(v);
            const float ofA = side(b, c, x, y) / area;
            const float ofB = side(c, a, x, y) / area;
            const float ofC = 1.F - ofA - ofB;
            if (std::min({ofA, ofB, ofC}) < -1e-4F) continue;
            float& pixel = inverse[v][u];
            pixel = std::max(pixel, ofA * a.w + ofB * b.w + ofC * c.w);
        }
    }
}

/// The pixels of a row of the depth image in the colour image; w is 0 where there is no depth.
std::vector<Vertex> projectedRow(const ImageF& depth_d, unsigned v, const DepthCamera& from,
                                 const Camera& colour) {
    constexpr double kFarthest = 1e6;  // from the image, where floats still tell pixels apart
    std::vector<Vertex> row(depth_d.getWidth());
    for (unsigned u = 0; u < depth_d.getWidth(); ++u) {
        const float z = depth_d[v][u];
        if (!(z > 0.F)) continue;
        const Eigen::Vector3d p_c = from.T_c_d * from.camera.unproject(u, v, z);
        if (!(p_c.z() > 0.)) continue;
        const Eigen::Vector2d pixel = colour.project(p_c);
        if (!(pixel.cwiseAbs().maxCoeff() < kFarthest)) continue;
        row[u] = {static_cast<float>(pixel.x()), static_cast<float>(pixel.y()),
                  static_cast<float>(1. / p_c.z())};
    }
    return row;
}

bool isSurface(const std::array<Vertex, 4>& corners) {
    const auto [far, near] = std::minmax({corners[0].w, corners[1].w, corners[2].w, corners[3].w});
    return far > 0.F && near <= (1.F + kSpread) * far;
}

}  // namespace

ImageF registeredDepth(const ImageF& depth_d, const DepthCamera& from, const Camera& colour) {
    if (depth_d.getWidth() != from.camera.width || depth_d.getHeight() != from.camera.height) {
        throw std::invalid_argument("depth camera: image and camera differ in size");
    }
    ImageF depth(colour.height, colour.width, 0.F);
    if (depth_d.getHeight() == 0) return depth;
    std::vector<Vertex> above = projectedRow(depth_d, 0, from, colour);
    for (unsigned v = 1; v < depth_d.getHeight(); ++v) {
        const std::vector<Vertex> row = projectedRow(depth_d, v, from, colour);
        for (unsigned u = 1; u < depth_d.getWidth(); ++u) {
            if (!isSurface({above[u - 1], above[u], row[u - 1], row[u]})) continue;
            draw(above[u - 1], above[u], row[u], depth);
            draw(above[u - 1], row[u], row[u - 1], depth);
        }
        above = row;
    }
    for (unsigned i = 0; i < depth.getSize(); ++i) {
        if (depth.bitmap[i] > 0.F) depth.bitmap[i] = 1.F / depth.bitmap[i];
    }
    return depth;
}

}  // namespace photonav
