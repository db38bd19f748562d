// SPDX-License-Identifier: BSD-3-Clause
#include "render/brick_reader.hpp"

#include <bit>

#include "map/brick_leaves.hpp"

namespace photonav {
namespace {

using Eigen::Array3i;

void readLeaf(const TexturedOcTree& map, const TexturedOcTreeNode& leaf, const Array3i& lowest,
              int edge, BrickContent& content) {
    std::uint64_t cells = 0;
    visitCells(lowest, edge, [&](int x, int y, int z) { cells |= 1ULL << surfaceBit(x, y, z); });
    content.present |= cells;
    if (!map.isNodeOccupied(leaf)) return;
    content.surface.occupied |= cells;
    const std::optional<ShownGreys> greys = leaf.shownGreys();
    if (!greys) return;
    content.surface.known |= cells;
    const ShownWeights weights = leaf.shownWeights();
    for (; cells != 0; cells &= cells - 1) {
        const int cell = std::countr_zero(cells);
        for (unsigned f = 0; f < 6; ++f) {
            content.surface.grey[f][cell] = (*greys)[f];
            content.surface.weight[f][cell] = weights[f];
        }
        content.surface.inside[cell] = leaf.surfaces.shown();
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
