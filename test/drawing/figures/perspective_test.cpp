// SPDX-License-Identifier: BSD-3-Clause
#include "figures/perspective.hpp"

#include <gtest/gtest.h>

#include "drawing/plot/decoded.hpp"
#include "figures/cutaway.hpp"

namespace photonav {
namespace {

constexpr double kFloorGrey = 0.2, kWallGrey = 0.8;
const Eigen::Vector3d kRoomSize(6., 5., 3.);

Config insideOfRoom() {
    Config config;
    config.bounds = {Eigen::Vector3d(0.5, 0.5, 0.5), Eigen::Vector3d(5.5, 4.5, 2.)};
    config.clearanceResolution = 0.2;
    return config;
}

/// A room with a dark floor and bright walls and ceiling.
Scene closedRoom() {
    Scene scene;
    const auto floor = addTexture(scene, uniformTexture(kFloorGrey));
    const auto wall = addTexture(scene, uniformTexture(kWallGrey));
    addPlane(scene, {0., 0., 0.}, {kRoomSize.x(), 0., 0.}, {0., kRoomSize.y(), 0.}, floor);
    addBox(scene, {0., 0., -0.01}, kRoomSize, wall, BoxInside::hollow);
    return scene;
}

/// A map of it: a shell of occupied cells of 0.1 m.
std::shared_ptr<TexturedOcTree> mapOfClosedRoom() {
    auto map = std::make_shared<TexturedOcTree>(0.1);
    const auto add = [&](int x, int y, int z) {
        const octomap::point3d center(0.1F * (static_cast<float>(x) + 0.5F),
                                      0.1F * (static_cast<float>(y) + 0.5F),
                                      0.1F * (static_cast<float>(z) + 0.5F));
        TexturedOcTreeNode* cell = map->updateNode(center, true, true);
        for (FaceTexture& face : cell->faces)
            face.observe(static_cast<float>(z == 0 ? kFloorGrey : kWallGrey), 1.F);
    };
    const Eigen::Vector3i last = (10. * kRoomSize).array().round().cast<int>() - 1;
    for (int x = 0; x <= last.x(); ++x)
        for (int y = 0; y <= last.y(); ++y)
            for (int z = 0; z <= last.z(); ++z)
                if (x == 0 || y == 0 || z == 0 || x == last.x() || y == last.y() || z == last.z())
                    add(x, y, z);
    map->updateInnerOccupancy();
    return map;
}

cv::Mat3b picture(const ViewSource& views, const World& world, const std::string& name) {
    Eigen::AlignedBox3d box = world.extent();
    box.max().z() = insideOfRoom().bounds.max().z();
    return decoded(perspectiveFigure(views, {name, box, {}}).png(), name);
}

/// Number of pixels of the floor in the picture.
int floorPixels(const cv::Mat3b& image) {
    constexpr double kGrey = 70. + 170. * kFloorGrey;
    cv::Mat1b floor;
    cv::inRange(image, cv::Scalar::all(kGrey - 2.), cv::Scalar::all(kGrey + 2.), floor);
    return cv::countNonZero(floor);
}

class PerspectiveOfClosedRoom : public testing::TestWithParam<bool> {
  protected:
    World world_ =
        GetParam() ? World(mapOfClosedRoom(), insideOfRoom()) : World(closedRoom(), insideOfRoom());
};

TEST_P(PerspectiveOfClosedRoom, ShowsTheFloor) {
    const cv::Mat3b closed = picture(world_.views(), world_, "room_closed");
    EXPECT_LT(floorPixels(closed), 2000);
    const auto open = cutawayViews(world_, insideOfRoom().bounds);
    EXPECT_GT(floorPixels(picture(*open, world_, "room_open")), 50000);
}

TEST_P(PerspectiveOfClosedRoom, LeavesOutNearWallsAndCeilingOnly) {
    const auto views = cutawayViews(world_, insideOfRoom().bounds);
    const auto depthAlong = [&](const Eigen::Vector3d& direction) {
        Pose T_w_c = Pose::Identity();
        T_w_c.linear() =
            Eigen::Quaterniond::FromTwoVectors(Eigen::Vector3d::UnitZ(), direction).matrix();
        T_w_c.translation() << 3.04, 2.54, 1.04;
        View view;
        views->render(makeCamera(3, 3, 0.01), T_w_c.inverse(), view);
        return view.depth[1][1];
    };
    EXPECT_EQ(depthAlong(Eigen::Vector3d::UnitZ()), 0.F);
    EXPECT_EQ(depthAlong(-Eigen::Vector3d::UnitX()), 0.F);
    EXPECT_EQ(depthAlong(-Eigen::Vector3d::UnitY()), 0.F);
    EXPECT_NEAR(depthAlong(Eigen::Vector3d::UnitX()), 2.96, 0.11);
    EXPECT_NEAR(depthAlong(Eigen::Vector3d::UnitY()), 2.46, 0.11);
    EXPECT_NEAR(depthAlong(-Eigen::Vector3d::UnitZ()), 1.04, 0.11);
    EXPECT_NEAR(depthAlong(Eigen::Vector3d(-2.84, 0., -1.).normalized()), 3., 0.2)
        << "the floor beyond the bounds stays";
}

INSTANTIATE_TEST_SUITE_P(ScenesAndMaps, PerspectiveOfClosedRoom, testing::Bool(),
                         [](const auto& test) { return test.param ? "Map" : "Scene"; });

TEST(CutawayViews, CutSolidsHaveADarkSection) {
    Scene scene = closedRoom();
    addBox(scene, {2., 2., 0.}, {4., 3., 2.5}, 1);
    const World world(std::move(scene), insideOfRoom());
    Pose T_w_c = Pose::Identity();
    T_w_c.linear() = Eigen::Vector3d(1., -1., -1.).asDiagonal();
    T_w_c.translation() << 3.1, 2.6, 8.;
    View view;
    cutawayViews(world, insideOfRoom().bounds)
        ->render(makeCamera(3, 3, 0.01), T_w_c.inverse(), view);
    EXPECT_NEAR(view.depth[1][1], 6., 1e-3);
    EXPECT_LT(view.intensity[1][1], 0.5F * static_cast<float>(kWallGrey));
}

}  // namespace
}  // namespace photonav
