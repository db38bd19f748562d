// SPDX-License-Identifier: BSD-3-Clause
// Exports the surfaces of a map for other programs.
#pragma once

#include <string>

#include "map/textured_octree.hpp"

namespace photonav {

/// Writes the surfaces inside a map's cells as a point cloud that MeshLab and CloudCompare open: a
/// binary PLY file with the mean point of every surface, its normal, and its grey value as colour.
/// World frame [m]. A map without surfaces gives a file without points.
/// @throws InputError when the file cannot be written
void saveSurfaceCloud(const TexturedOcTree& map, const std::string& file);

}  // namespace photonav
