// SPDX-License-Identifier: BSD-3-Clause
// The surfaces of a map for other programs.
#pragma once

#include <string>

#include "map/textured_octree.hpp"

namespace photonav {

/// Writes the surfaces inside a map's cells as a point cloud that MeshLab and CloudCompare open:
/// binary PLY, a point for every surface (its mean), with its normal and its grey value as colour.
/// World frame [m]; empty for a map without surfaces.
/// @throws InputError when the file cannot be written
void saveSurfaceCloud(const TexturedOcTree& map, const std::string& file);

}  // namespace photonav
