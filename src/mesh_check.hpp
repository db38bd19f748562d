// SPDX-License-Identifier: BSD-3-Clause
// What can be told of a mesh file before assimp opens it: it trusts headers, and leaves out in
// silence what it does not find.
#pragma once

#include <string>

namespace photonav {

/// Checks that the elements a PLY header promises fit into the file, and that the material
/// libraries an OBJ names are there. Other formats pass.
/// @throws InputError naming file and element or library
void checkMeshFile(const std::string& file);

}  // namespace photonav
