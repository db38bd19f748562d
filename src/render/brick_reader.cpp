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
    for (int i = 0; i < edge * edge * edge; ++i) {
        const Array3i cell = lowest + Array3i(i % edge, i / edge % edge, i / edge / edge);
        const unsigned bit = surfaceBit(cell.x(), cell.y(), cell.z());
        content.present |= 1ULL << bit;
        if (occupied) content.surface.occupied |= 1ULL << bit;
        if (!greys) continue;
        content.surface.known |= 1ULL << bit;
        content.surface.grey[bit] = *greys;
        content.surface.weight[bit] = leaf.shownWeights();
        content.surface.inside[bit] = leaf.surfaces.shown();
    }
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
