// SPDX-License-Identifier: BSD-3-Clause
// Checks of a mesh file before assimp opens it: assimp trusts the sizes in a header and the depth
// of a scene, and reports neither elements nor files that are missing.
#pragma once

#include <string>

namespace photonav {

enum class MeshFormat { ply, obj, gltf, glb };

/// By the extension. @throws InputError for others
MeshFormat meshFormatOf(const std::string& file);

/// Checks that a PLY header is whole and that its elements fit into the file, that the material
/// libraries an OBJ names are there, and that a glTF is of version 2 and its nodes are not nested
/// without end.
/// @throws InputError naming file and element, library or node; for other formats
void checkMeshFile(const std::string& file);

}  // namespace photonav
