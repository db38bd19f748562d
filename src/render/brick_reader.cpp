// SPDX-License-Identifier: BSD-3-Clause
#include "render/brick_reader.hpp"

#include "map/brick_leaves.hpp"

namespace photonav {
namespace {

using Eigen::Array3i;

void readLeaf(const TexturedOcTree& map, const TexturedOcTreeNode& leaf, const Array3i& lowest,
              int edge, BrickContent& content) {
    const bool occupied = map.isNodeOccupied(leaf);
    const std::optional<ShownGreys> greys = occupied ? leaf.shownGreys() : std::nullopt;
    const ShownWeights weights = greys ? leaf.shownWeights() : ShownWeights{};
    visitCells(lowest, edge, [&](int x, int y, int z) {
        const unsigned bit = surfaceBit(x, y, z);
        content.present |= 1ULL << bit;
        if (occupied) content.surface.occupied |= 1ULL << bit;
        if (!greys) return;
        content.surface.known |= 1ULL << bit;
        for (unsigned f = 0; f < 6; ++f) {
            content.surface.grey[f][bit] = (*greys)[f];
            content.surface.weight[f][bit] = weights[f];
        }
        content.surface.inside[bit] = leaf.surfaces.shown();
    });
}

}  // namespace

BrickContent readBrick(const TexturedOcTree& map, const TexturedOcTreeNode& node) {
    BrickContent content;
    visitLeaves(map, node, [&](const auto& leaf, const Array3i& lowest, int edge) {
        readLeaf(map, leaf, lowest, edge, content);
    });
    return content;
}

BrickContent readBrick(const TexturedOcTree& map, const Array3i& brick) {
    const TexturedOcTreeNode* node = findBrick(map, brick);
    return node != nullptr ? readBrick(map, *node) : BrickContent{};
}

}  // namespace photonav
