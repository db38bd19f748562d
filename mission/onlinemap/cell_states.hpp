// SPDX-License-Identifier: BSD-3-Clause
// Which cells of a map are free and which are occupied, as a copy for another thread.
#pragma once

#include <cstdint>
#include <memory>
#include <unordered_map>
#include <vector>

#include "map/textured_octree.hpp"

namespace photonav {

enum class CellState : char { unknown, free, occupied };

/// The states of a map's cells, without texture. A thread that must not wait while another one
/// writes the map keeps such a copy, and is sent the bricks (blocks of 4 x 4 x 4 cells) that have
/// changed.
class CellStates {
  public:
    using Key = octomap::OcTreeKey;

    /// The states of 64 cells; bit brickBit() of each mask is a cell's. A cell in neither of the
    /// masks is unknown.
    struct Brick {
        Eigen::Array3i index;  ///< in the world, as in MapChange
        std::uint64_t free = 0, occupied = 0;

        /// The state of a cell of the brick.
        CellState at(const Key& key) const {
            const unsigned bit = brickBit(key[0], key[1], key[2]);
            if ((occupied >> bit & 1U) != 0) return CellState::occupied;
            return (free >> bit & 1U) != 0 ? CellState::free : CellState::unknown;
        }
    };

    /// All cells are unknown. @param resolution edge of a cell [m]
    explicit CellStates(double resolution) : grid_(std::make_shared<TexturedOcTree>(resolution)) {}
    /// The cells of a map. Visits all of them.
    explicit CellStates(const TexturedOcTree& map);

    /// The present state of a map's brick.
    /// @param index in the world, as in MapChange
    static Brick brickOf(const TexturedOcTree& map, const Eigen::Array3i& index);
    /// The present states of some of a map's bricks.
    /// @param bricks indices in the world, as in MapChange
    static std::vector<Brick> bricksOf(const TexturedOcTree& map,
                                       const std::vector<Eigen::Array3i>& bricks);
    void set(const std::vector<Brick>& bricks);

    bool isFree(const Key& key) const;
    bool isOccupied(const Key& key) const;
    /// An empty map with the same cells, for their keys and coordinates.
    const TexturedOcTree& grid() const { return *grid_; }

  private:
    const Brick* brickAt(const Key& key) const;

    std::shared_ptr<const TexturedOcTree> grid_;
    std::unordered_map<Key, Brick, Key::KeyHash> bricks_;  // by the key of the first cell
};

}  // namespace photonav
