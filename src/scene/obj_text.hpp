// SPDX-License-Identifier: BSD-3-Clause
// OBJ files and their material libraries, changed so that assimp reads them as they are meant.
#pragma once

#include <span>
#include <string>
#include <string_view>

namespace photonav {

/// Makes comments of the points and lines of an OBJ file. Only triangles are wanted, and assimp's
/// importer (5.2) writes beyond its arrays where a mesh has faces and lines of one vertex.
void commentLines(std::span<char> obj);

/// A material library (.mtl) in which every material starts as white. Blender gives no colour to a
/// material with a texture; assimp would multiply the texture by 0.6.
std::string withWhiteMaterials(std::string_view library);

}  // namespace photonav
