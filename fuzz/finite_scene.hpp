// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "fuzz_input.hpp"
#include "scene/scene.hpp"

namespace photonav::fuzz {

/// What renderers rely on, whatever the scene was read from.
inline void requireFinite(const Scene& scene) {
    for (const Triangle& triangle : scene.triangles) {
        require(triangle.texture < scene.textures.size(), "a triangle has a texture");
        for (const auto& corner : triangle.corners)
            require(corner.allFinite(), "corners are finite");
        for (const auto& uv : triangle.uv)
            require(uv.allFinite(), "texture coordinates are finite");
    }
}

}  // namespace photonav::fuzz
