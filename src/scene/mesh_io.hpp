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
    UpAxis up = UpAxis::automatic;  ///< axis of the file that becomes the world's z axis
    double scale = 1.;              ///< metres per unit of the file
};

/// Reads glTF 2.0 (.gltf, .glb), OBJ with its .mtl, or PLY; the extension gives the format. Node
/// transforms are applied and polygons triangulated; points, lines and degenerate triangles are
/// dropped.
///
/// Grey values are display-referred: base-colour textures (sRGB) are decoded, multiplied by the
/// linear base-colour factor, summed to luma in linear light and encoded again. Without a texture,
/// vertex colours are used (interpolated), else the factor alone.
/// @throws InputError when the file cannot be read, has no usable triangle, has coordinates that
///        are not finite, or names a texture that cannot be read
Scene loadMesh(const std::string& file, const MeshOptions& options = {});

}  // namespace photonav
