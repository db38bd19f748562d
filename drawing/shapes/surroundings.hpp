// SPDX-License-Identifier: BSD-3-Clause
// The surfaces of a scene and the cells of a map, for 3-D views.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "map/textured_octree.hpp"
#include "plot/picture.hpp"
#include "scene/scene.hpp"

namespace photonav {

/// Textured triangles, world frame [m].
struct DrawnMesh {
    std::vector<float> positions;         ///< 9 per triangle
    std::vector<float> uv;                ///< 6 per triangle; v points down, textures repeat
    std::vector<std::uint32_t> textures;  ///< 1 per triangle, index into `images`
    std::vector<Png> images;
};

/// Grey cubes, world frame [m].
struct DrawnVoxels {
    std::vector<float> centers;      ///< 3 per voxel
    std::vector<std::uint8_t> grey;  ///< 1 per voxel
    double size = 0.0;               ///< edge length [m]
};

/// The surfaces of a scene, with textures as PNG files of at most 2048 pixels per side.
DrawnMesh drawnMesh(const Scene& scene);

/// The occupied cells of a map with the mean grey value of their faces (0.5 if never observed). If
/// there are more than `limit`, eight neighbours are merged into one voxel of twice the size with
/// their mean grey value; this is repeated until the number is at most `limit`.
DrawnVoxels drawnVoxels(const TexturedOcTree& map, std::size_t limit = 400000);

}  // namespace photonav
