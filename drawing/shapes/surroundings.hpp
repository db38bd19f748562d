// SPDX-License-Identifier: BSD-3-Clause
// The surfaces of a scene and the cells of a map, as pages and files draw them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "map/textured_octree.hpp"
#include "plot/picture.hpp"
#include "scene/scene.hpp"

namespace photonav {

/// Textured triangles of the 3-D view, in w [m].
struct DrawnMesh {
    std::vector<float> positions;         ///< 9 per triangle
    std::vector<float> uv;                ///< 6 per triangle; v downward, textures repeat
    std::vector<std::uint32_t> textures;  ///< 1 per triangle, index into `images`
    std::vector<Png> images;
};

/// Grey cubes of the 3-D view, in w [m].
struct DrawnVoxels {
    std::vector<float> centers;      ///< 3 per voxel
    std::vector<std::uint8_t> grey;  ///< 1 per voxel
    double size = 0.0;               ///< edge length [m]
};

/// The scene as the page draws it: textures as PNG of at most 2048 pixels a side.
DrawnMesh drawnMesh(const Scene& scene);

/// The occupied cells of a map with the mean grey value of their faces (0.5 where never observed).
/// Beyond `limit`, eight neighbours become one voxel of twice the size and their mean grey value,
/// until they are few enough.
DrawnVoxels drawnVoxels(const TexturedOcTree& map, std::size_t limit = 400000);

}  // namespace photonav
