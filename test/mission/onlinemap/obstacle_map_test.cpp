// SPDX-License-Identifier: BSD-3-Clause
#include "onlinemap/obstacle_map.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "tracking/rooms.hpp"

namespace photonav {
namespace {

using Eigen::Vector3d;

constexpr double kCell = 0.1;

/// Cells from x = y = 0 upward: 'o' occupied, '.' free, '?' unknown.
struct ObservedColumn {
    explicit ObservedColumn(const std::string& cells, double edge = kCell) : cell(edge), map(edge) {
        change.resolution = cell;
        for (std::size_t z = 0; z < cells.size(); ++z) {
            if (cells[z] != '?') map.updateNode(middleOf(static_cast<int>(z)), cells[z] == 'o');
            change.occupancy.emplace_back(0, 0, static_cast<int>(z) / MapChange::kBrickEdge);
        }
        change.normalize();
    }

    std::string obstacles(UnknownSpace unknown) {
        ObstacleMap obstacles(cell, {Vector3d(-1., -1., 0.), Vector3d(1., 1., 1.)}, unknown);
        changed = obstacles.update(map, change);
        std::string cells;
        for (int z = 0; z < 12; ++z) {
            const auto* node = obstacles.cells()->search(middleOf(z));
            cells += node == nullptr ? '?' : obstacles.cells()->isNodeOccupied(*node) ? 'o' : '.';
        }
        return cells;
    }

    octomap::point3d middleOf(int z) const {
        const auto half = static_cast<float>(0.5 * cell);
        return {half, half, static_cast<float>(cell * (z + 0.5))};
    }

    double cell;
    TexturedOcTree map;
    MapChange change, changed;
};

TEST(ObstacleMap, WallsGoOnAboveWhatWasSeenOfThem) {
    EXPECT_EQ(ObservedColumn("?ooooo??????").obstacles(UnknownSpace::optimistic), "?ooooooooooo");
    EXPECT_EQ(ObservedColumn("ooooo..?????").obstacles(UnknownSpace::optimistic), "ooooo???????");
    EXPECT_EQ(ObservedColumn("o???????????").obstacles(UnknownSpace::optimistic), "o???????????");
    // Rays to places beside it clear a cell, but a table is no wall.
    EXPECT_EQ(ObservedColumn("ooooo.??????").obstacles(UnknownSpace::optimistic), "ooooo?oooooo");
    EXPECT_EQ(ObservedColumn("ooo.oo??????").obstacles(UnknownSpace::optimistic), "ooo?oooooooo");
    EXPECT_EQ(ObservedColumn("ooo..oo?????").obstacles(UnknownSpace::optimistic), "ooo??oo?????");
    ObservedColumn column("?ooooo??????");
    column.obstacles(UnknownSpace::optimistic);
    EXPECT_GE(column.changed.occupancy.size(), 3U);
}

/// A wall is 20 cm, and a hole 5 cm: smaller cells do not make walls of lower things.
TEST(ObstacleMap, WallsAndHolesHaveTheirLengthInSmallCells) {
    const auto obstacles = [](const std::string& cells) {
        return ObservedColumn(cells, 0.035).obstacles(UnknownSpace::optimistic);
    };
    EXPECT_EQ(obstacles("ooooo???????"), "ooooo???????");
    EXPECT_EQ(obstacles("oooooo??????"), "oooooooooooo");
    EXPECT_EQ(obstacles("oooooo..????"), "oooooo??oooo");
    EXPECT_EQ(obstacles("oooooo...???"), "oooooo??????");
}

TEST(ObstacleMap, PessimismKeepsWhatIsKnownToBeFree) {
    EXPECT_EQ(ObservedColumn("ooooo..?????").obstacles(UnknownSpace::pessimistic), "ooooo..?????");
}

/// What was seen free above a wall before it came says nothing of its height.
TEST(ObstacleMap, NewWallsGoOnThroughForgottenCells) {
    ObservedColumn column("ooooo.......");
    ObstacleMap obstacles(kCell, {Vector3d(-1., -1., 0.), Vector3d(1., 1., 1.)},
                          UnknownSpace::optimistic);
    obstacles.update(column.map, column.change);
    const auto isObstacle = [&](double z) {
        const auto* node = obstacles.cells()->search(0.05, 0.05, z);
        return node != nullptr && obstacles.cells()->isNodeOccupied(*node);
    };
    EXPECT_FALSE(isObstacle(0.55));
    std::vector<octomap::OcTreeKey> above;
    for (const double z : {0.55, 0.65}) above.push_back(column.map.coordToKey(0.05, 0.05, z));
    EXPECT_FALSE(obstacles.forget(column.map, above).empty());
    EXPECT_TRUE(isObstacle(0.55) && isObstacle(0.65));
    EXPECT_FALSE(isObstacle(0.75));
    // A camera level with them sees a surface behind, then.
    const Camera camera = makeCamera(94, 60, 1.2);
    const Pose T_c_w = lookFrom({-1., 0.05, 0.6}, 0.);
    ImageF depth(camera.height, camera.width, 1.F);
    EXPECT_TRUE(obstacles.remember(column.map, depth, camera, T_c_w).empty());
    depth = 2.F;
    EXPECT_FALSE(obstacles.remember(column.map, depth, camera, T_c_w).empty());
    EXPECT_FALSE(isObstacle(0.55) || isObstacle(0.65));
    EXPECT_TRUE(obstacles.remember(column.map, depth, camera, T_c_w).empty());
}

TEST(ObstacleMap, TheBodysOwnPlaceIsFree) {
    ObservedColumn column("oo??????????");
    ObstacleMap obstacles(kCell, {Vector3d(-1., -1., 0.), Vector3d(1., 1., 1.)},
                          UnknownSpace::pessimistic);
    obstacles.update(column.map, column.change);
    const Vector3d body(0.05, 0.05, 0.6);
    EXPECT_FALSE(obstacles.addBody(column.map, body, body, 0.2).empty());
    EXPECT_NE(obstacles.cells()->search(0.05, 0.05, 0.65), nullptr);
    EXPECT_EQ(obstacles.cells()->search(0.05, 0.05, 1.15), nullptr);
    EXPECT_TRUE(obstacles.addBody(column.map, body, body, 0.2).empty());
    const Vector3d ahead(0.05, 0.05, 1.1);
    EXPECT_FALSE(obstacles.addBody(column.map, body, ahead, 0.2).empty());
    EXPECT_NE(obstacles.cells()->search(0.05, 0.05, 1.15), nullptr);
}

/// A camera 2 m above the floor, looking down: the right side of its image shows y < 0. From
/// y = -0.4 on, the floor is hidden by something higher.
class HiddenPlaces : public testing::Test {
  protected:
    HiddenPlaces() {
        image.intensity.resize(camera.height, camera.width, 0.5F);
        image.depth.resize(camera.height, camera.width, 2.F);
        cover(1.F);
    }

    /// The depth of what hides the floor; 0: not measured.
    void cover(float depth) {
        for (unsigned v = 0; v < camera.height; ++v) {
            for (unsigned u = 60; u < camera.width; ++u) image.depth[v][u] = depth;
        }
    }
    MapChange addHidden() { return obstacles.addHidden(map, image, camera, T_c_w, 0.55); }
    bool isObstacle(double x, double y, double z) const {
        const auto* node = obstacles.cells()->search(x, y, z);
        return node != nullptr && obstacles.cells()->isNodeOccupied(*node);
    }
    /// Marks the hidden columns as seen at a height.
    void see(double z) {
        for (double y = -0.75; y < -0.4; y += kCell) {
            for (double x = -0.75; x < 0.8; x += kCell) map.updateNode(x, y, z, false);
        }
    }

    Camera camera = makeCamera(94, 60, 1.2);
    Pose T_c_w = lookFrom({0., 0., 2.}, test::kDown);
    View image;
    TexturedOcTree map{kCell};
    ObstacleMap obstacles{
        kCell, {Vector3d(-1., -1., 0.), Vector3d(1., 1., 2.)}, UnknownSpace::optimistic};
};

TEST_F(HiddenPlaces, AreObstaclesFromTheHeightOfTheRobotUpward) {
    const MapChange change = addHidden();
    EXPECT_TRUE(isObstacle(0.05, -0.45, 1.55));
    EXPECT_TRUE(isObstacle(0.05, -0.45, 3.15));
    EXPECT_FALSE(isObstacle(0.05, -0.45, 1.35));  // farther below than the radius
    EXPECT_FALSE(isObstacle(0.05, -0.45, 3.25));  // farther above the bounds than matters
    EXPECT_TRUE(isObstacle(0.05, -0.35, 1.55));   // the surface that hides it is beside it
    EXPECT_FALSE(isObstacle(0.05, -0.25, 1.55));  // its floor is in view
    EXPECT_FALSE(isObstacle(0.05, 0.45, 1.55));
    EXPECT_FALSE(isObstacle(0.05, -0.85, 1.55));  // beyond the radius
    EXPECT_FALSE(isObstacle(0.75, -0.45, 1.55));
    const auto& bricks = change.occupancy;
    EXPECT_TRUE(std::any_of(bricks.begin(), bricks.end(), [](const Eigen::Array3i& brick) {
        return (brick == Eigen::Array3i(0, -2, 3)).all();  // of the first place
    }));
    EXPECT_TRUE(addHidden().empty());
}

TEST_F(HiddenPlaces, AreThoseThatWereNeverSeen) {
    see(1.05);
    EXPECT_TRUE(addHidden().empty());
    map.clear();
    see(2.15);  // above the camera: it says nothing of what is below
    EXPECT_FALSE(addHidden().empty());
}

TEST_F(HiddenPlaces, AreFreeOnceTheyAreSeen) {
    addHidden();
    see(1.55);
    MapChange change;
    change.resolution = kCell;
    change.occupancy.emplace_back(0, -2, 3);
    obstacles.update(map, change);
    EXPECT_FALSE(isObstacle(0.05, -0.45, 1.55));
    EXPECT_TRUE(isObstacle(-0.15, -0.45, 1.55));  // in the column of bricks beside
}

TEST_F(HiddenPlaces, AreNotBehindWhatIsHardlyHigherThanTheFloor) {
    cover(1.85F);
    EXPECT_TRUE(addHidden().empty());
    cover(1.75F);
    EXPECT_FALSE(addHidden().empty());
}

TEST_F(HiddenPlaces, AreNotWhereDepthIsMissing) {
    cover(0.F);
    EXPECT_TRUE(addHidden().empty());
    image.depth = 0.F;
    EXPECT_TRUE(addHidden().empty());
}

/// If a few depths that are far too large were the floor, all of it would seem to be hidden.
TEST_F(HiddenPlaces, AreJudgedByTheFloorAndNotByOutliers) {
    cover(2.F);
    for (unsigned v = 0; v < 8; ++v) {
        for (unsigned u = 0; u < 8; ++u) image.depth[v][u] = 5.F;
    }
    EXPECT_TRUE(addHidden().empty());
}

}  // namespace
}  // namespace photonav
