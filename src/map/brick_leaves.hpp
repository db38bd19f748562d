// SPDX-License-Identifier: BSD-3-Clause
// Access to the leaves of an octree within a brick of 4 x 4 x 4 cells.
#pragma once

#include "map/map_change.hpp"
#include "map/textured_octree.hpp"

namespace photonav {

/// The brick of a cell, by its index in the world as in MapChange.
inline Eigen::Array3i brickOf(const octomap::OcTreeKey& key) {
    return Eigen::Array3i(key[0] - kKeyOfZero, key[1] - kKeyOfZero, key[2] - kKeyOfZero)
        .unaryExpr([](int cell) { return cell >> 2; });
}

inline bool hasChildren(const TexturedOcTree& map, const TexturedOcTreeNode& node) {
    for (unsigned i = 0; i < 8; ++i) {
        if (map.nodeChildExists(&node, i)) return true;
    }
    return false;
}

/// The node of a brick, or the larger leaf that contains it; null if all of its cells are unknown.
/// @param brick index in the world, as in MapChange
inline const TexturedOcTreeNode* findBrick(const TexturedOcTree& map, const Eigen::Array3i& brick) {
    const Eigen::Array3i corner = MapChange::kBrickEdge * brick + kKeyOfZero;
    const TexturedOcTreeNode* node = map.size() > 0 ? map.getRoot() : nullptr;
    for (int edge = kKeyOfZero; node != nullptr && edge >= MapChange::kBrickEdge; edge /= 2) {
        if (!hasChildren(map, *node)) break;
        const auto child = static_cast<unsigned>((corner.x() & edge) != 0) |
                           static_cast<unsigned>((corner.y() & edge) != 0) << 1U |
                           static_cast<unsigned>((corner.z() & edge) != 0) << 2U;
        node = map.nodeChildExists(node, child) ? map.getNodeChild(node, child) : nullptr;
    }
    return node;
}

/// Calls visit(x, y, z) for the cells of a cube, x fastest.
/// @param lowest the first cell
/// @param edge of the cube [cells]
template <class Visit>
void visitCells(const Eigen::Array3i& lowest, int edge, const Visit& visit) {
    for (int z = lowest.z(); z < lowest.z() + edge; ++z) {
        for (int y = lowest.y(); y < lowest.y() + edge; ++y) {
            for (int x = lowest.x(); x < lowest.x() + edge; ++x) visit(x, y, z);
        }
    }
}

/// Calls visit(leaf, lowest, edge) for every leaf at and below the node of a brick, with the first
/// cell (relative to the brick's first) and the edge [cells] of the leaf.
/// @param lowest the first cell of the node, relative to the brick's first
/// @param edge of the node [cells]
template <class Visit>
void visitLeaves(const TexturedOcTree& map, const TexturedOcTreeNode& node, const Visit& visit,
                 const Eigen::Array3i& lowest = Eigen::Array3i::Zero(),
                 int edge = MapChange::kBrickEdge) {
    bool isLeaf = true;
    if (edge > 1) map.prefetchChildren(node);
    for (int i = 0; edge > 1 && i < 8; ++i) {
        if (!map.nodeChildExists(&node, i)) continue;
        isLeaf = false;
        const Eigen::Array3i half(i & 1, i >> 1 & 1, i >> 2 & 1);
        const Eigen::Array3i corner = lowest + edge / 2 * half;
        visitLeaves(map, *map.getNodeChild(&node, i), visit, corner, edge / 2);
    }
    if (isLeaf) visit(node, lowest, edge);
}

/// The cells of a cube within a brick, as bits brickBit(): OctoMap's order, so they are
/// consecutive.
/// @param lowest the first cell, relative to the brick's first
/// @param edge 1, 2 or 4 [cells]
inline std::uint64_t cubeBits(const Eigen::Array3i& lowest, int edge) {
    const Eigen::Array3<unsigned> first = lowest.cast<unsigned>();
    return ~std::uint64_t{0} >> (64 - edge * edge * edge)
                                    << brickBit(first.x(), first.y(), first.z());
}

/// The cells of a brick that are free or occupied, as bits brickBit().
/// @param brick index in the world, as in MapChange
inline std::uint64_t knownCells(const TexturedOcTree& map, const Eigen::Array3i& brick) {
    std::uint64_t known = 0;
    if (const TexturedOcTreeNode* node = findBrick(map, brick)) {
        visitLeaves(map, *node,
                    [&](const TexturedOcTreeNode&, const Eigen::Array3i& lowest, int edge) {
                        known |= cubeBits(lowest, edge);
                    });
    }
    return known;
}

}  // namespace photonav
