// SPDX-License-Identifier: BSD-3-Clause
#include "map/textured_octree.hpp"

#include <gtest/gtest.h>

#include <random>

#include "core/map/carpet_map.hpp"

namespace photonav {
namespace {

using test::kTop;

TEST(TexturedOcTree, CopiesAreDeep) {
    const TexturedOcTree map = test::carpetMap();
    TexturedOcTree copy(map);
    EXPECT_TRUE(copy == map);
    copy.search(0.125, 0.125, 0.025)->faces[kTop].mean = 0.F;
    EXPECT_FALSE(copy == map);
}

TEST(TexturedOcTree, PruningKeepsFaces) {
    TexturedOcTree map(0.1);
    for (int i = 0; i < 8; ++i) {
        map.setNodeValue(octomap::OcTreeKey(32768 + i % 2, 32768 + i / 2 % 2, 32768 + i / 4), 1.F,
                         true);
    }
    map.search(0.05, 0.05, 0.05)->faces[kTop].observe(0.25F, 1.F);
    map.updateInnerOccupancy();
    map.prune();
    EXPECT_EQ(map.getNumLeafNodes(), 8U);
    EXPECT_EQ(map.search(0.05, 0.05, 0.05)->faces[kTop].mean, 0.25F);
    EXPECT_FALSE(map.search(0.15, 0.05, 0.05)->faces[kTop].observed());

    for (auto leaf = map.begin_leafs(); leaf != map.end_leafs(); ++leaf) {
        leaf->faces = {};
        leaf->faces[kTop].observe(0.25F, 1.F);
    }
    map.prune();
    EXPECT_EQ(map.getNumLeafNodes(), 1U);
    EXPECT_EQ(map.search(0.15, 0.15, 0.05)->faces[kTop].mean, 0.25F);
    map.updateNode(octomap::OcTreeKey(32768, 32768, 32768), false);  // splits the node again
    EXPECT_EQ(map.getNumLeafNodes(), 8U);
    EXPECT_EQ(map.search(0.15, 0.15, 0.05)->faces[kTop].mean, 0.25F);
}

TEST(TexturedOcTree, BrickUpdatesEqualSingleUpdates) {
    TexturedOcTree bricks(0.1), singles(0.1);
    std::mt19937_64 random(3);
    const auto ignore = [](TexturedOcTreeNode&, const BrickObservation&, unsigned) {};
    for (int i = 0; i < 200; ++i) {
        std::vector<BrickObservation> observed;
        for (int x = 2; x >= 0; --x) {
            for (int y = 0; y < 3; ++y) {
                if (random() % 2 == 0) continue;
                const octomap::OcTreeKey corner(32764 + 4 * x, 32764 + 4 * y, 32768);
                const std::uint64_t hit = i % 3 == 0 ? random() & random() : 0;
                const std::uint64_t missed = i % 2 == 0 ? ~0ULL : random();
                observed.push_back({corner, missed & ~hit, hit});
            }
        }
        bricks.updateBricks(observed, ignore);
        for (const auto& [corner, missed, hit, change] : observed) {
            for (unsigned cell = 0; cell < 64; ++cell) {
                const unsigned x = cell & 3U, y = cell >> 2U & 3U, z = cell >> 4U;
                const unsigned bit = brickBit(x, y, z);
                if (((hit | missed) >> bit & 1U) == 0) continue;
                singles.updateNode(octomap::OcTreeKey(corner[0] + x, corner[1] + y, corner[2] + z),
                                   (hit >> bit & 1U) != 0);
            }
        }
    }
    EXPECT_TRUE(bricks == singles);
}

TEST(TexturedOcTree, MakesCellsUnknown) {
    TexturedOcTree map(0.1);
    const auto keyOf = [&](double x) { return map.coordToKey(x, 0.05, 0.05); };
    for (const double x : {0.05, 0.15, 0.25, 5.05}) map.updateNode(keyOf(x), true);
    for (int i = 0; i < 8; ++i) {  // merged into one node
        map.updateNode(octomap::OcTreeKey(100 + i % 2, 100 + i / 2 % 2, 100 + i / 4), false);
    }
    map.prune();
    map.makeUnknown(keyOf(0.05));
    map.makeUnknown(octomap::OcTreeKey(100, 100, 100));
    EXPECT_EQ(map.search(keyOf(0.05)), nullptr);
    EXPECT_TRUE(map.isNodeOccupied(map.search(keyOf(0.15))));
    EXPECT_EQ(map.search(octomap::OcTreeKey(100, 100, 100)), nullptr);
    EXPECT_FALSE(map.isNodeOccupied(map.search(octomap::OcTreeKey(101, 100, 100))));
    EXPECT_EQ(map.size(), map.calcNumNodes());
    map.makeUnknown(keyOf(5.05));  // with all nodes above it that have no other cell
    EXPECT_EQ(map.search(keyOf(5.15)), nullptr);
    EXPECT_EQ(map.search(keyOf(5.05), 14), nullptr);
    for (int i = 1; i < 8; ++i) {
        map.makeUnknown(octomap::OcTreeKey(100 + i % 2, 100 + i / 2 % 2, 100 + i / 4));
    }
    for (const double x : {0.15, 0.25, 0.25}) map.makeUnknown(keyOf(x));
    EXPECT_EQ(map.size(), 0U);
    map.updateNode(keyOf(0.05), true);
    EXPECT_TRUE(map.isNodeOccupied(map.search(keyOf(0.05))));
}

}  // namespace
}  // namespace photonav
