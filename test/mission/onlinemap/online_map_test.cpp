// SPDX-License-Identifier: BSD-3-Clause
#include "onlinemap/online_map.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "render/voxel_renderer.hpp"
#include "tracking/rooms.hpp"

namespace photonav {
namespace {

/// A camera looks down from 2 m on a floor with a box of 1.5 m beside it.
class MapOfABox : public testing::Test {
  protected:
    MapOfABox() {
        config.bounds = {Eigen::Vector3d(-2., -2., 0.5), Eigen::Vector3d(2., 2., 2.)};
        config.robotRadius = 0.25;
        config.camera.mount = "down";
        config.explore.resolution = 0.1;
        Scene scene = test::floorOf(valueNoise({.size = {20., 20.}, .seed = 3}));
        const auto sides = addTexture(scene, valueNoise({.seed = 4}));
        addBox(scene, {-0.2, 0.32, 0.}, {0.2, 0.42, 1.5}, sides);
        MeshRenderer(std::move(scene)).render(camera, T_c_w, image);
    }

    OnlineMap fused() const {
        OnlineMap map(config);
        map.fuse(image, camera, T_c_w);
        return map;
    }
    static bool isObstacle(const OnlineMap& map, double x, double y, double z) {
        const auto* node = map.obstacles()->search(x, y, z);
        return node != nullptr && map.obstacles()->isNodeOccupied(*node);
    }

    Config config;
    Camera camera = makeCamera(94, 60, 1.2);
    Pose T_c_w = lookFrom({0., 0., 2.}, test::kDown);
    View image;
};

TEST(LooksAhead, UnlessTheCameraLooksNearlyDown) {
    EXPECT_TRUE(looksAhead(cameraMount(0.)));
    EXPECT_TRUE(looksAhead(cameraMount(test::kOblique)));
    EXPECT_FALSE(looksAhead(cameraMount(test::kDown - 0.2)));
    EXPECT_FALSE(looksAhead(cameraMount(test::kDown)));
}

/// A camera that looks ahead sees obstacles at the robot's own height.
TEST_F(MapOfABox, PlacesBehindItAreObstaclesToACameraThatLooksDown) {
    const OnlineMap down = fused();
    EXPECT_TRUE(isObstacle(down, 0.05, 0.35, 1.05));  // its side
    EXPECT_TRUE(isObstacle(down, 0.05, 0.55, 2.05));  // behind it
    EXPECT_FALSE(isObstacle(down, 0.05, -0.55, 2.05));
    EXPECT_FALSE(isObstacle(down, 0.05, 0.85, 2.05));  // farther away than twice the radius
    config.camera.mount = "front45";
    const OnlineMap ahead = fused();
    EXPECT_TRUE(isObstacle(ahead, 0.05, 0.35, 1.05));
    EXPECT_FALSE(isObstacle(ahead, 0.05, 0.55, 2.05));
}

/// What a view of the map shows is gone, with its obstacles, and only that.
TEST_F(MapOfABox, ForgetsWhatIsInView) {
    OnlineMap map = fused();
    const auto shownBy = [&](const Pose& pose) {
        View shown;
        VoxelRenderer(*map.cells(), UnknownPolicy::free).render(camera, pose, shown);
        return shown;
    };
    const auto surfaces = [&](const Pose& pose) {
        const View shown = shownBy(pose);
        return std::count_if(shown.depth.bitmap, shown.depth.bitmap + shown.depth.getSize(),
                             [](float z) { return z > 0.F; });
    };
    const Pose aside = lookFrom({0., -1.5, 2.}, test::kDown);
    const auto before = surfaces(T_c_w), asideBefore = surfaces(aside);
    const auto isFloorObstacle = [&](double x, double y) {
        return isObstacle(map, x, y, 0.05) || isObstacle(map, x, y, -0.05);
    };
    ASSERT_TRUE(isFloorObstacle(-0.55, 0.05));
    const Pose low = lookFrom({0.05, 0.35, 2.}, test::kDown);
    const MapChange change = map.forget(shownBy(low), camera, low);
    EXPECT_FALSE(isFloorObstacle(-0.55, 0.05));
    for (const double z : {0.05, -0.05}) {  // a wall that was forgotten is no free space
        EXPECT_EQ(map.cells()->search(-0.55, 0.05, z), nullptr);
    }
    EXPECT_LT(surfaces(T_c_w), before / 2);
    EXPECT_GT(surfaces(aside), asideBefore / 5);  // what both see is gone
    const auto lists = [&](double x, double y, double z) {
        const Eigen::Array3i brick = (Eigen::Array3d(x, y, z) / 0.4).floor().cast<int>();
        return std::ranges::any_of(change.occupancy,
                                   [&](const auto& other) { return (other == brick).all(); });
    };
    EXPECT_TRUE(lists(-0.55, 0.05, 0.05) || lists(-0.55, 0.05, -0.05));
    EXPECT_FALSE(lists(0.05, -1.5, -0.05));
}

/// Free for ever so long, and occupied after two images of a box that was not there before; free
/// again when it has gone.
TEST_F(MapOfABox, FollowsWhatMoves) {
    View empty;
    MeshRenderer(test::floorOf(valueNoise({.size = {20., 20.}, .seed = 3})))
        .render(camera, T_c_w, empty);
    OnlineMap map(config);
    const auto isOccupied = [&] { return isObstacle(map, 0.05, 0.35, 1.05); };
    for (int i = 0; i < 20; ++i) map.fuse(empty, camera, T_c_w);
    EXPECT_TRUE(map.isSeen({0., -1.2, 1.}));
    map.fuse(image, camera, T_c_w);
    EXPECT_FALSE(isOccupied());
    map.fuse(image, camera, T_c_w);
    EXPECT_TRUE(isOccupied());
    for (int i = 0; i < 20; ++i) map.fuse(image, camera, T_c_w);
    for (int i = 0; i < 4; ++i) map.fuse(empty, camera, T_c_w);
    EXPECT_FALSE(isOccupied());
}

/// Beyond the border of the image that shows it, a new box may go on.
TEST_F(MapOfABox, DoubtsWhatIsNotInViewAroundANewOne) {
    View empty;
    const MeshRenderer floor(test::floorOf(valueNoise({.size = {20., 20.}, .seed = 3})));
    OnlineMap map(config);
    const auto look = [&](double x) {
        const Pose there = lookFrom({x, 0., 2.}, test::kDown);
        floor.render(camera, there, empty);
        map.fuse(empty, camera, there);
    };
    look(1.2);
    look(0.);
    const Eigen::Vector3d beyond(1.05, 0.35, 1.2), farBeyond(1.5, 0.35, 1.2);
    ASSERT_TRUE(map.isSeen(beyond) && map.isSeen(farBeyond));
    map.fuse(image, camera, T_c_w);
    EXPECT_FALSE(map.isSeen(beyond));
    EXPECT_TRUE(map.isSeen(farBeyond));
    EXPECT_TRUE(map.isSeen({0., -0.5, 1.2}));   // in view
    EXPECT_FALSE(map.isSeen({0., 0.75, 1.2}));  // behind the box
    look(1.2);
    EXPECT_TRUE(map.isSeen(beyond));
}

TEST(DepthSigma, OfStereoIsThatOfDisparities) {
    Config config;
    EXPECT_EQ(depthSigmaAtOneMetre(config), config.explore.depthSigma);
    config.explore.sensor = ExploreSensor::stereo;
    const double f = config.camera.camera().fx();
    EXPECT_NEAR(depthSigmaAtOneMetre(config), 0.25 / (f * config.explore.baseline), 1e-12);
}

/// How far new walls are told from known ones does not depend on the size of small cells.
TEST(OnlineMap, NewWallsAreSeenAsFarInSmallCells) {
    Config config;
    config.explore.resolution = 0.05;
    const double precise = obstacleRange(config, 1.).precise;
    config.explore.resolution = 0.02;
    EXPECT_EQ(obstacleRange(config, 1.).precise, precise);
}

/// A wall of 20 cm below would have been seen, whatever the size of the cells.
TEST_F(MapOfABox, IsSeenAboveTwentyCentimetresThatAreKnown) {
    config.explore.resolution = 0.035;
    const auto isSeenAbove = [&](int cells) {
        TexturedOcTree known(config.explore.cell());
        for (int i = 1; i <= cells; ++i) {
            const auto z = static_cast<float>(1. - i * config.explore.cell());
            known.setNodeValue(octomap::point3d(0.F, 0.F, z), -1.F);
        }
        return OnlineMap(config, &known).isSeen({0., 0., 1.});
    };
    EXPECT_FALSE(isSeenAbove(5));
    EXPECT_TRUE(isSeenAbove(6));
}

TEST_F(MapOfABox, IsSeenAboveSurfacesWithinRange) {
    const OnlineMap map = fused();
    EXPECT_TRUE(map.isSeen({0., -0.5, 1.}));
    EXPECT_TRUE(map.isSeen({0., -0.5, 3.5}));
    EXPECT_FALSE(map.isSeen({0., -0.5, 9.}));
    EXPECT_FALSE(map.isSeen({3., 0., 1.}));
    EXPECT_FALSE(OnlineMap(config).isSeen({0., -0.5, 1.}));
}

/// What is below a shelf says nothing of what stands on it.
TEST_F(MapOfABox, IsNotSeenAboveASurfaceWithUnknownSpaceOnIt) {
    TexturedOcTree known(config.explore.cell());
    for (double z = 0.35; z < 1.2; z += config.explore.cell()) {
        known.setNodeValue(0.05, 0.05, z, -1.F);
        known.setNodeValue(1.05, 0.05, z, -1.F);
    }
    known.setNodeValue(1.05, 0.05, 1.15, 3.F);  // the shelf
    OnlineMap map(config, &known);
    EXPECT_TRUE(map.isSeen({0.05, 0.05, 1.55}));
    EXPECT_TRUE(map.isSeen({1.05, 0.05, 0.85}));
    EXPECT_FALSE(map.isSeen({1.05, 0.05, 1.55}));
}

TEST_F(MapOfABox, SurfacesOutOfRangeAreNotMapped) {
    config.explore.range = 0.4;
    EXPECT_FALSE(isObstacle(fused(), 0.05, -0.45, 0.05));
}

/// The noise of the images left in the map does not inform; unknown space does as the config says.
TEST_F(MapOfABox, MeasuresTheInformationOfViewsByComparisons) {
    MeshRenderer(test::floorOf(uniformTexture(0.5))).render(camera, T_c_w, image);
    std::mt19937_64 random(1);
    View shown = image;
    shown.intensity = test::noisy(image.intensity, 0.02, random);
    OnlineMap map(config);
    const InformationModel model = map.information(camera, config.photometric);
    const double before = model(shown).trace();
    map.compare(shown, test::noisy(image.intensity, 0.02, random), camera);
    EXPECT_LT(model(shown).trace(), 0.01 * before);

    MeshRenderer(test::floorOf(valueNoise({.size = {20., 20.}, .seed = 3})))
        .render(camera, T_c_w, shown);
    View unknown = shown;
    unknown.depth = 0.F;
    for (const auto& [assumed, informs] : {std::pair(UnknownInformation::none, false),
                                           std::pair(UnknownInformation::predicted, true)}) {
        config.explore.unknownInformation = assumed;
        OnlineMap learning(config);
        learning.compare(shown, shown.intensity, camera);
        EXPECT_EQ(learning.information(camera, config.photometric)(unknown).trace() > 0., informs);
    }
}

}  // namespace
}  // namespace photonav
