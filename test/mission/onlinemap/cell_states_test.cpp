// SPDX-License-Identifier: BSD-3-Clause
#include "onlinemap/cell_states.hpp"

#include <gtest/gtest.h>

#include <random>

#include "map/brick_leaves.hpp"

namespace photonav {
namespace {

using octomap::OcTreeKey;

/// Random cells around the origin: half of them in whole cubes of 8, which the octree prunes.
class RandomCells : public testing::Test {
  protected:
    /// @return the bricks that may have changed
    std::vector<Eigen::Array3i> change() {
        std::vector<Eigen::Array3i> bricks;
        const auto set = [&](const OcTreeKey& key, bool isOccupied) {
            map.updateNode(key, isOccupied ? 3.5F : -3.5F);
            bricks.push_back(brickOf(key));
        };
        for (int i = 0; i < 200; ++i) {
            const OcTreeKey key = any();
            const bool isOccupied = coin(random);
            const unsigned edge = coin(random) ? 8 : 1;
            for (unsigned k = 0; k < edge * edge * edge; ++k) {
                set(OcTreeKey(inCube(key[0], edge, k % edge), inCube(key[1], edge, k / edge % edge),
                              inCube(key[2], edge, k / edge / edge)),
                    isOccupied);
            }
        }
        return bricks;
    }
    OcTreeKey any() { return {axis(random), axis(random), axis(random)}; }
    static octomap::key_type inCube(unsigned key, unsigned edge, unsigned offset) {
        return static_cast<octomap::key_type>(key / edge * edge + offset);
    }

    void expectSame(const CellStates& states) {
        for (int i = 0; i < 50000; ++i) {
            const OcTreeKey key = any();
            const TexturedOcTreeNode* node = map.search(key);
            const bool isOccupied = node != nullptr && map.isNodeOccupied(*node);
            ASSERT_EQ(states.isOccupied(key), isOccupied);
            ASSERT_EQ(states.isFree(key), node != nullptr && !isOccupied);
        }
    }

    std::mt19937 random{1};
    std::uniform_int_distribution<octomap::key_type> axis{kKeyOfZero - 32, kKeyOfZero + 31};
    std::bernoulli_distribution coin;
    TexturedOcTree map{0.1};
};

TEST_F(RandomCells, HaveTheStatesOfTheMap) {
    change();
    expectSame(CellStates(map));
}

TEST_F(RandomCells, AreKnownAfterEveryChange) {
    CellStates states(0.1);
    EXPECT_FALSE(states.isFree(any()));
    for (int i = 0; i < 3; ++i) {
        states.set(CellStates::bricksOf(map, change()));
        expectSame(states);
    }
    EXPECT_EQ(states.grid().size(), 0U);
    EXPECT_EQ(states.grid().keyToCoord(kKeyOfZero, 16), map.keyToCoord(kKeyOfZero, 16));
}

}  // namespace
}  // namespace photonav
