// SPDX-License-Identifier: BSD-3-Clause
// Checks a mesh file before assimp opens it: assimp does not check the sizes in a header and the
// nesting of nodes, and does not report missing elements or files.
#pragma once

#include <string>

namespace photonav {

enum class MeshFormat { ply, obj, gltf, glb };

/// Whether a file is a mesh, as its extension says.
bool isMeshFile(const std::string& file);

/// The format of a mesh file by its extension.
/// @throws InputError for any other extension
MeshFormat meshFormatOf(const std::string& file);

/// Checks that a PLY header is complete and its elements fit into the file; that the material
/// libraries of an OBJ file exist; and that a glTF file has version 2 and its nodes are not nested
/// too deeply or in a cycle.
/// @throws InputError naming file and element, library or node; for other formats
void checkMeshFile(const std::string& file);

}  // namespace photonav
