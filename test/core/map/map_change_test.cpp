// SPDX-License-Identifier: BSD-3-Clause
#include "map/map_change.hpp"

#include <gtest/gtest.h>

#include <stdexcept>

namespace photonav {
namespace {

using Eigen::Array3i;

MapChange makeChange(std::vector<Array3i> occupancy, std::vector<Array3i> texture) {
    MapChange change;
    change.resolution = 0.05;
    change.occupancy = std::move(occupancy);
    change.texture = texture;
    change.anyTexture = std::move(texture);
    change.normalize();
    return change;
}

bool areEqual(const std::vector<Array3i>& a, const std::vector<Array3i>& b) {
    return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                      [](const Array3i& p, const Array3i& q) { return (p == q).all(); });
}

TEST(MapChange, ListsAreSortedByZThenYThenXWithoutRepetition) {
    const MapChange change =
        makeChange({{5, 0, 0}, {0, 1, 0}, {0, 0, 1}, {5, 0, 0}, {-3, 0, 0}, {0, 0, -1}}, {});
    EXPECT_TRUE(
        areEqual(change.occupancy, {{0, 0, -1}, {-3, 0, 0}, {5, 0, 0}, {0, 1, 0}, {0, 0, 1}}));
}

TEST(MapChange, AJoinedChangeListsWhatEitherLists) {
    MapChange change = makeChange({{0, 0, 0}, {2, 0, 0}}, {{1, 0, 0}});
    change.join(makeChange({{1, 0, 0}, {2, 0, 0}}, {{1, 0, 0}, {0, 0, -4}}));
    EXPECT_TRUE(areEqual(change.occupancy, {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}}));
    EXPECT_TRUE(areEqual(change.texture, {{0, 0, -4}, {1, 0, 0}}));
    EXPECT_TRUE(areEqual(change.bricks(), {{0, 0, -4}, {0, 0, 0}, {1, 0, 0}, {2, 0, 0}}));
}

TEST(MapChange, AnEmptyChangeTakesTheOthersResolution) {
    MapChange change;
    EXPECT_TRUE(change.empty());
    EXPECT_TRUE(change.box().isEmpty());
    change.join(makeChange({{0, 0, 0}}, {}));
    EXPECT_FALSE(change.empty());
    EXPECT_EQ(change.resolution, 0.05);
    change.join(MapChange{});
    EXPECT_EQ(change.resolution, 0.05);
}

TEST(MapChange, ChangesOfMapsOfDifferentResolutionsCannotBeJoined) {
    MapChange change = makeChange({{0, 0, 0}}, {});
    MapChange other = change;
    other.resolution = 0.1;
    EXPECT_THROW(change.join(other), std::invalid_argument);
}

TEST(MapChange, BoxesAreInMetresAndHoldWholeBricks) {
    const MapChange change = makeChange({{-1, 0, 2}}, {{3, 0, 2}});
    EXPECT_TRUE(makeChange({{-1, 0, 2}}, {})
                    .box()
                    .isApprox(Eigen::AlignedBox3d(Eigen::Vector3d(-0.2, 0., 0.4),
                                                  Eigen::Vector3d(0., 0.2, 0.6))));
    EXPECT_TRUE(change.box().isApprox(
        Eigen::AlignedBox3d(Eigen::Vector3d(-0.2, 0., 0.4), Eigen::Vector3d(0.8, 0.2, 0.6))));
}

}  // namespace
}  // namespace photonav
