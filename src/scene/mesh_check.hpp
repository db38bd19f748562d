// SPDX-License-Identifier: BSD-3-Clause
// Checks of a mesh file before assimp opens it: assimp trusts the sizes in a header and the depth
// of a scene, and reports neither elements nor files that are missing.
#pragma once

#include <string>

namespace photonav {

/// Checks that a PLY header is whole and that its elements fit into the file, that the material
/// libraries an OBJ names are there, and that the nodes of a glTF are not nested without end. Other
/// formats pass.
/// @throws InputError naming file and element, library or node
void checkMeshFile(const std::string& file);

}  // namespace photonav
