// SPDX-License-Identifier: BSD-3-Clause
#include "onlinemap/cell_states.hpp"

#include "map/brick_leaves.hpp"
#include "onlinemap/known_map.hpp"

namespace photonav {
namespace {

using octomap::OcTreeKey;

OcTreeKey firstCellBeside(const OcTreeKey& cell) {
    const auto first = [&](int axis) { return static_cast<octomap::key_type>(cell[axis] & ~3); };
    return {first(0), first(1), first(2)};
}

OcTreeKey firstCellOf(const Eigen::Array3i& brick) {
    const Eigen::Array3i first = MapChange::kBrickEdge * brick + kKeyOfZero;
    const auto key = [&](int axis) { return static_cast<octomap::key_type>(first[axis]); };
    return {key(0), key(1), key(2)};
}

}  // namespace

CellStates::CellStates(const TexturedOcTree& map) : CellStates(map.getResolution()) {
    set(bricksOf(map, bricksWith(map, [](const TexturedOcTreeNode&) { return true; })));
}

CellStates::Brick CellStates::brickOf(const TexturedOcTree& map, const Eigen::Array3i& index) {
    Brick brick{index};
    const TexturedOcTreeNode* node = findBrick(map, index);
    if (node == nullptr) return brick;
    visitLeaves(map, *node,
                [&](const TexturedOcTreeNode& leaf, const Eigen::Array3i& lowest, int edge) {
                    std::uint64_t& mask = map.isNodeOccupied(leaf) ? brick.occupied : brick.free;
                    mask |= cubeBits(lowest, edge);
                });
    return brick;
}

std::vector<CellStates::Brick> CellStates::bricksOf(const TexturedOcTree& map,
                                                    const std::vector<Eigen::Array3i>& bricks) {
    std::vector<Brick> states;
    states.reserve(bricks.size());
    for (const Eigen::Array3i& index : bricks) states.push_back(brickOf(map, index));
    return states;
}

void CellStates::set(const std::vector<Brick>& bricks) {
    for (const Brick& brick : bricks) bricks_.insert_or_assign(firstCellOf(brick.index), brick);
}

const CellStates::Brick* CellStates::brickAt(const Key& key) const {
    const auto found = bricks_.find(firstCellBeside(key));
    return found == bricks_.end() ? nullptr : &found->second;
}

bool CellStates::isFree(const Key& key) const {
    const Brick* brick = brickAt(key);
    return brick != nullptr && brick->at(key) == CellState::free;
}

bool CellStates::isOccupied(const Key& key) const {
    const Brick* brick = brickAt(key);
    return brick != nullptr && brick->at(key) == CellState::occupied;
}

}  // namespace photonav
