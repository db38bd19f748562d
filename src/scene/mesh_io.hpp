// SPDX-License-Identifier: BSD-3-Clause
// Mesh files as scenes (the only includer of assimp is the .cpp).
#pragma once

#include <string>

#include "scene/scene.hpp"

namespace photonav {

enum class UpAxis {
    automatic,  ///< y for glTF (its definition), z for everything else
    y,
    z
};

struct MeshOptions {
    UpAxis up = UpAxis::automatic;  ///< which axis of the file becomes the world's z
    double scale = 1.;              ///< metres per unit of the file
};

/// Reads glTF 2.0 (.gltf, .glb), OBJ with its .mtl, or PLY, as its name says: node transforms
/// applied, polygons triangulated, points and lines dropped, degenerate triangles too.
///
/// Grey values are display-referred: base-colour textures (sRGB) are decoded, multiplied by the
/// linear base-colour factor, summed to luma in linear light and encoded again. Where there is no
/// texture, vertex colours are used (interpolated), else the factor alone.
/// @throws InputError when the file cannot be read, has no usable triangle, has coordinates that
/// are
///         not finite, or names a texture that cannot be read
Scene loadMesh(const std::string& file, const MeshOptions& options = {});

}  // namespace photonav
