// SPDX-License-Identifier: BSD-3-Clause
// Checks of a mesh file before assimp opens it: assimp trusts the sizes in a header, and reports
// neither elements nor files that are missing.
#pragma once

#include <string>

namespace photonav {

/// Checks that the elements a PLY header promises fit into the file, and that the material
/// libraries an OBJ names are there. Other formats pass.
/// @throws InputError naming file and element or library
void checkMeshFile(const std::string& file);

}  // namespace photonav
