// SPDX-License-Identifier: BSD-3-Clause
// A textured triangle scene: what a mesh file or a procedural description becomes.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "types.hpp"

namespace photonav {

/// A grey texture in [0, 1] (display-referred: what an 8-bit camera would store, divided by 255).
/// Texture coordinates (u, v) in [0, 1) span the image, v downward from its first row; it repeats.
struct Texture {
    ImageF image;
};

/// A triangle with its own corners: world frame, metres.
struct Triangle {
    std::array<Eigen::Vector3f, 3> corners;
    std::array<Eigen::Vector2f, 3> uv;
    std::uint32_t texture = 0;  ///< index into Scene::textures
};

struct Scene {
    std::vector<Texture> textures;
    std::vector<Triangle> triangles;

    Eigen::AlignedBox3d boundingBox() const;
};

}  // namespace photonav
