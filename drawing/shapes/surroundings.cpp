// SPDX-License-Identifier: BSD-3-Clause
#include "shapes/surroundings.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <optional>

#include "dataset/image_file.hpp"

namespace photonav {
namespace {

/// Cells of the map in one drawn voxel.
struct VoxelSum {
    double grey = 0., cells = 0.;
};
using Voxels = std::map<std::array<int, 3>, VoxelSum>;  // by index: x, y, z

/// The occupied cells in voxels of 2^level of them a side; nothing beyond `limit` voxels. A pruned
/// leaf may stand for 10^14 cells: it is never expanded further than to the voxels.
std::optional<Voxels> voxelsOf(const TexturedOcTree& map, unsigned level, std::size_t limit) {
    Voxels voxels;
    for (auto leaf = map.begin_leafs(); leaf != map.end_leafs(); ++leaf) {
        if (!map.isNodeOccupied(*leaf)) continue;
        const unsigned leafLevel = map.getTreeDepth() - leaf.getDepth();
        const int side = leafLevel > level ? 1 << (leafLevel - level) : 1;
        if (std::pow(side, 3) > static_cast<double>(limit)) return {};
        const double cells = std::pow(8., std::min(level, leafLevel));
        const double grey = greyLevel(leaf->meanGrey().value_or(0.5F));
        const octomap::OcTreeKey corner = leaf.getIndexKey();
        for (int x = 0; x < side; ++x) {
            for (int y = 0; y < side; ++y) {
                for (int z = 0; z < side; ++z) {
                    VoxelSum& sum = voxels[{(corner[0] >> level) + x, (corner[1] >> level) + y,
                                            (corner[2] >> level) + z}];
                    sum.grey += cells * grey;
                    sum.cells += cells;
                }
            }
        }
        if (voxels.size() > limit) return {};
    }
    return voxels;
}

}  // namespace

DrawnMesh drawnMesh(const Scene& scene) {
    DrawnMesh mesh;
    for (const Texture& texture : scene.textures) mesh.images.push_back(greyPng(texture.image));
    for (const Triangle& triangle : scene.triangles) {
        for (const Eigen::Vector3f& corner : triangle.corners)
            mesh.positions.insert(mesh.positions.end(), corner.data(), corner.data() + 3);
        for (const Eigen::Vector2f& uv : triangle.uv)
            mesh.uv.insert(mesh.uv.end(), uv.data(), uv.data() + 2);
        mesh.textures.push_back(triangle.texture);
    }
    return mesh;
}

DrawnVoxels drawnVoxels(const TexturedOcTree& map, std::size_t limit) {
    unsigned level = 0;
    std::optional<Voxels> voxels;
    while (!(voxels = voxelsOf(map, level, std::max<std::size_t>(limit, 1)))) ++level;
    DrawnVoxels drawn;
    drawn.size = std::ldexp(map.getResolution(), static_cast<int>(level));
    for (const auto& [index, sum] : *voxels) {
        for (const int i : index) {
            const double centre = std::ldexp(i + 0.5, static_cast<int>(level)) - kKeyOfZero;
            drawn.centers.push_back(static_cast<float>(centre * map.getResolution()));
        }
        drawn.grey.push_back(static_cast<std::uint8_t>(std::lround(sum.grey / sum.cells)));
    }
    return drawn;
}

}  // namespace photonav
