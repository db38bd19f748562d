// SPDX-License-Identifier: BSD-3-Clause
#include "onlinemap/obstacles_in_view.hpp"

#include <gtest/gtest.h>

#include "map/map_fusion.hpp"
#include "tracking/rooms.hpp"

namespace photonav {
namespace {

using Eigen::Vector3d;

/// A camera 1.2 m above a floor looks along x, 45 degrees below the horizon. The map is that of the
/// empty floor.
class EmptyFloor : public testing::Test {
  protected:
    EmptyFloor() { fuseFloor(map); }

    static Scene floor() { return test::floorOf(valueNoise({.size = {20., 20.}, .seed = 3})); }
    static Pose at(double x) { return lookFrom({x, 0., 1.2}, test::kOblique); }
    View render(Scene scene, double x) const {
        View view;
        MeshRenderer(std::move(scene)).render(camera, at(x), view);
        return view;
    }
    void fuseFloor(TexturedOcTree& tree) const {
        for (const double x : {-1.5, -1., -0.5, 0.}) fuse(tree, x, render(floor(), x));
    }
    void fuse(TexturedOcTree& tree, double x, const View& view) const {
        photonav::fuse(tree, view, camera, at(x));
    }
    /// A box ahead.
    View boxOf(double height, double distance = 1.) const {
        Scene scene = floor();
        addBox(scene, {distance, -0.3, 0.}, {distance + 0.3, 0.3, height},
               addTexture(scene, valueNoise({.seed = 4})));
        return render(std::move(scene), 0.);
    }
    ObstaclesInView seenIn(const View& view) const { return seenIn(view, map); }
    ObstaclesInView seenIn(const View& view, const TexturedOcTree& tree) const {
        return {view.depth, camera, at(0.), CellStates(tree), {1.6, 3., 0.7, 1.7}};
    }

    Camera camera = makeCamera(188, 120, 1.2);
    TexturedOcTree map{0.05};
    const std::vector<Vector3d> ahead{{0., 0., 1.2}, {0.5, 0., 1.2}, {2., 0., 1.2}};
    const std::vector<Vector3d> aside{{0., 0., 1.2}, {0.5, 0.7, 1.2}, {2., 0.7, 1.2}};
};

TEST_F(EmptyFloor, IsNoObstacle) {
    const ObstaclesInView seen = seenIn(render(floor(), 0.));
    EXPECT_EQ(seen.clearance({1., 0., 1.2}), kInfinity);
    EXPECT_FALSE(seen.isOn(ahead, 0.3));
    EXPECT_EQ(ObstaclesInView().clearance({1., 0., 1.2}), kInfinity);
}

/// The image shows the lower part of the box, which is higher than the robot flies.
TEST_F(EmptyFloor, ABoxThatAppearsGoesOnUpward) {
    const ObstaclesInView seen = seenIn(boxOf(3.));
    EXPECT_NEAR(seen.clearance({0.5, 0., 1.2}), 0.5, 0.06);
    EXPECT_TRUE(seen.isOn(ahead, 0.3));
    EXPECT_FALSE(seen.isOn(aside, 0.3));
    EXPECT_TRUE(seen.isOn(aside, 0.5));
    EXPECT_GT(seen.aboveNewWalls().size(), 12U * 15U);
    EXPECT_GE(seen.newWalls().size(), 12U);
}

/// The robot may leave an obstacle that it is near to, but not come nearer.
TEST_F(EmptyFloor, ARobotTooNearMayFlyAway) {
    const ObstaclesInView seen = seenIn(boxOf(3.));
    EXPECT_FALSE(seen.isOn({{0.8, 0., 1.2}, {0.2, 0., 1.2}}, 0.3));
    EXPECT_TRUE(seen.isOn({{0.8, 0., 1.2}, {0.9, 0., 1.2}}, 0.3));
    EXPECT_TRUE(seen.isOn({{0.8, 0., 1.2}, {0.2, 0., 1.2}, {0.9, 0., 1.2}}, 0.3));
}

TEST_F(EmptyFloor, ABoxIsAsHighAsItIsSeen) {
    const ObstaclesInView seen = seenIn(boxOf(0.6));
    EXPECT_FALSE(seen.isOn(ahead, 0.3));
    EXPECT_LT(seen.aboveNewWalls().size(), 2U * 13U);
}

/// It takes 20 cm that are not the floor's, whatever the size of the cells.
TEST_F(EmptyFloor, ALowBoxIsNoWallInSmallCells) {
    TexturedOcTree fine(0.035);
    fuseFloor(fine);
    EXPECT_TRUE(seenIn(boxOf(0.22), fine).newWalls().empty());
    EXPECT_FALSE(seenIn(boxOf(0.4), fine).newWalls().empty());
}

/// Of a column of such cells, pixels hit only some.
TEST_F(EmptyFloor, AWallIsSeenInCellsSmallerThanPixels) {
    TexturedOcTree fine(0.01);
    fuseFloor(fine);
    const ObstaclesInView seen(boxOf(3., 2.).depth, camera, at(0.), CellStates(fine),
                               {2.5, 3., 0.7, 1.7});
    EXPECT_FALSE(seen.newWalls().empty());
}

/// Errors of depth and pose move a wall by more than one small cell.
TEST_F(EmptyFloor, AWallBesideItsPlaceIsNotNew) {
    TexturedOcTree fine(0.035);
    for (int i = 0; i < 12; ++i) fuse(fine, 0., boxOf(3.));
    EXPECT_TRUE(seenIn(boxOf(3., 0.94), fine).newWalls().empty());
}

/// What stands above a wall that the map has was seen when that wall was.
TEST_F(EmptyFloor, AWallOfTheMapIsNotNew) {
    const View box = boxOf(3.);
    for (int i = 0; i < 12; ++i) fuse(map, 0., box);
    EXPECT_TRUE(seenIn(box).newWalls().empty());
    const ObstaclesInView unknown(box.depth, camera, at(0.), CellStates(0.05), {1.6, 3., 0.7, 1.7});
    EXPECT_TRUE(unknown.newWalls().empty());
}

TEST_F(EmptyFloor, DepthsThatAreTooCoarseShowNothingNew) {
    const View box = boxOf(3.);
    const ObstaclesInView seen(box.depth, camera, at(0.), CellStates(map), {1.6, 0.8, 0.7, 1.7});
    EXPECT_TRUE(seen.newWalls().empty());
}

/// Surfaces at the robot's own height count wherever they are, but not a pixel or two.
TEST_F(EmptyFloor, AFewPixelsAreNoObstacle) {
    View view = render(floor(), 0.);
    const auto put = [&](unsigned u, const Vector3d& p_w) {
        view.depth[2][u] = static_cast<float>((at(0.) * p_w).z());
    };
    const auto rays = [&](unsigned u) {  // where pixels of row 2 are at x = 0.6
        const Pose T_w_c = at(0.).inverse();
        const Vector3d eye = T_w_c.translation();
        const Vector3d ray = T_w_c * camera.unproject(u, 2, 1.) - eye;
        return Vector3d(eye + 0.6 / ray.x() * ray);
    };
    for (const unsigned u : {60U, 120U}) put(u, rays(u));
    EXPECT_FALSE(seenIn(view).clearance({0.6, 0., 1.}) < 0.3);
    for (unsigned v = 1; v < 30; ++v) {
        for (unsigned u = 80; u < 110; ++u) view.depth[v][u] = 0.6F;
    }
    EXPECT_TRUE(seenIn(view).clearance({0.6, 0., 1.}) < 0.3);
}

}  // namespace
}  // namespace photonav
