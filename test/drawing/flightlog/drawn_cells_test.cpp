// SPDX-License-Identifier: BSD-3-Clause
#include "flightlog/drawn_cells.hpp"

#include <gtest/gtest.h>

#include <array>
#include <map>
#include <random>

#include "map/map_fusion.hpp"

namespace photonav {
namespace {

using Cells = std::map<std::array<int, 3>, std::uint8_t>;

void accumulate(const CellChanges& changes, Cells& cells) {
    ASSERT_EQ(changes.indices.size(), 3 * changes.greys.size());
    for (std::size_t i = 0; i < changes.greys.size(); ++i) {
        const auto* at = changes.indices.data() + 3 * i;
        const std::array<int, 3> index{at[0], at[1], at[2]};
        if (changes.greys[i] == CellChanges::kGone) {
            EXPECT_EQ(cells.erase(index), 1U);  // only what was there goes
        } else {
            cells[index] = changes.greys[i];
        }
    }
}

/// Occupied cells of a map, in cubes of `side` cells.
std::map<std::array<int, 3>, std::pair<double, int>> occupied(TexturedOcTree& map, int side) {
    std::map<std::array<int, 3>, std::pair<double, int>> cubes;
    map.expand();
    for (auto leaf = map.begin_leafs(); leaf != map.end_leafs(); ++leaf) {
        if (!map.isNodeOccupied(*leaf)) continue;
        std::array<int, 3> index{};
        for (int i = 0; i < 3; ++i) {
            index[i] = static_cast<int>(
                std::floor((static_cast<int>(leaf.getKey()[i]) - kKeyOfZero) / double(side)));
        }
        auto& [sum, count] = cubes[index];
        sum += greyLevel(leaf->meanGrey().value_or(0.5F));
        ++count;
    }
    return cubes;
}

class RandomMap : public testing::TestWithParam<double> {};

/// Whatever comes, changes and goes: what the changes add up to is what the map holds.
TEST_P(RandomMap, ChangesAddUpToTheMap) {
    const double resolution = 0.05;
    const double extent = GetParam();
    DrawnCells drawn({Eigen::Vector3d::Zero(), Eigen::Vector3d::Constant(extent)}, resolution);
    const int side = static_cast<int>(std::lround(drawn.size() / resolution));
    TexturedOcTree map(resolution);
    Cells cells;
    std::mt19937 random(1);
    std::uniform_int_distribution<int> place(-12, 12), what(0, 3);
    std::uniform_real_distribution<float> grey(0.F, 1.F);
    for (int step = 0; step < 15; ++step) {
        MapChange change{.resolution = resolution};
        for (int i = 0; i < 80; ++i) {
            const Eigen::Array3i cell(place(random), place(random), place(random));
            const octomap::OcTreeKey key(static_cast<octomap::key_type>(cell.x() + kKeyOfZero),
                                         static_cast<octomap::key_type>(cell.y() + kKeyOfZero),
                                         static_cast<octomap::key_type>(cell.z() + kKeyOfZero));
            const bool isOccupied = what(random) > 0;
            TexturedOcTreeNode* node = map.setNodeValue(key, isOccupied ? 2.F : -2.F);
            node->faces = {};
            if (isOccupied) node->faces[0].observe(grey(random), 1.F);
            change.occupancy.emplace_back(cell.unaryExpr([](int x) { return x >> 2; }));
        }
        change.normalize();
        accumulate(drawn.update(map, change), cells);
    }
    const auto expected = occupied(map, side);
    ASSERT_EQ(cells.size(), expected.size());
    for (const auto& [index, sum] : expected) {
        ASSERT_TRUE(cells.contains(index));
        EXPECT_NEAR(cells[index], sum.first / sum.second, 7.5);
    }
}

INSTANTIATE_TEST_SUITE_P(Sizes, RandomMap, testing::Values(4., 10., 40.));

TEST(DrawnCells, SmallChangesOfGreyAreLeftOutUntilTheyAddUp) {
    DrawnCells drawn({Eigen::Vector3d::Zero(), Eigen::Vector3d::Ones()}, 0.1);
    TexturedOcTree map(0.1);
    const octomap::OcTreeKey key(kKeyOfZero, kKeyOfZero, kKeyOfZero);
    const MapChange change{.resolution = 0.1, .occupancy = {{0, 0, 0}}};
    const auto show = [&](double grey) {
        TexturedOcTreeNode* node = map.setNodeValue(key, 2.F);
        node->faces = {};
        node->faces[0].observe(static_cast<float>(grey), 1.F);
        return drawn.update(map, change).greys.size();
    };
    EXPECT_EQ(show(0.5), 1U);
    EXPECT_EQ(show(0.5), 0U);
    EXPECT_EQ(show(0.51), 0U);
    EXPECT_EQ(show(0.52), 0U);
    EXPECT_EQ(show(0.53), 1U);
}

}  // namespace
}  // namespace photonav
