// SPDX-License-Identifier: BSD-3-Clause
// What a robot may fly into, and how far it may fly at once.
#include <gtest/gtest.h>

#include <random>

#include "exploration/map_noise.hpp"
#include "exploration/obstacle_map.hpp"
#include "exploration/way_ahead.hpp"
#include "render/mesh_renderer.hpp"
#include "tracking/rooms.hpp"

namespace photonav {
namespace {

constexpr double kCell = 0.1;

/// Cells from x = y = 0 upward: 'o' occupied, '.' free, '?' unknown.
struct ObservedColumn {
    explicit ObservedColumn(const std::string& cells) {
        change.resolution = kCell;
        for (std::size_t z = 0; z < cells.size(); ++z) {
            if (cells[z] != '?') map.updateNode(0.05, 0.05, kCell * (z + 0.5), cells[z] == 'o');
            change.occupancy.emplace_back(0, 0, static_cast<int>(z) / MapChange::kBrickEdge);
        }
        change.normalize();
    }

    std::string obstacles(UnknownSpace unknown) {
        ObstacleMap obstacles(kCell, {Eigen::Vector3d(-1., -1., 0.), Eigen::Vector3d(1., 1., 1.)},
                              unknown);
        changed = obstacles.update(map, change);
        std::string cells;
        for (int z = 0; z < 12; ++z) {
            const auto* node = obstacles.cells()->search(0.05, 0.05, kCell * (z + 0.5));
            cells += node == nullptr ? '?' : obstacles.cells()->isNodeOccupied(*node) ? 'o' : '.';
        }
        return cells;
    }

    TexturedOcTree map{kCell};
    MapChange change, changed;
};

TEST(ObstacleMap, WallsGoOnAboveWhatWasSeenOfThem) {
    EXPECT_EQ(ObservedColumn("?ooooo??????").obstacles(UnknownSpace::optimistic), "?ooooooooooo");
    EXPECT_EQ(ObservedColumn("ooooo.??????").obstacles(UnknownSpace::optimistic), "ooooo???????");
    EXPECT_EQ(ObservedColumn("o???????????").obstacles(UnknownSpace::optimistic), "o???????????");
    ObservedColumn column("?ooooo??????");
    column.obstacles(UnknownSpace::optimistic);
    EXPECT_GE(column.changed.occupancy.size(), 3U);
}

TEST(ObstacleMap, PessimismKeepsWhatIsKnownToBeFree) {
    EXPECT_EQ(ObservedColumn("ooooo..?????").obstacles(UnknownSpace::pessimistic), "ooooo..?????");
}

TEST(ObstacleMap, TheBodysOwnPlaceIsFree) {
    ObservedColumn column("oo??????????");
    ObstacleMap obstacles(kCell, {Eigen::Vector3d(-1., -1., 0.), Eigen::Vector3d(1., 1., 1.)},
                          UnknownSpace::pessimistic);
    obstacles.update(column.map, column.change);
    EXPECT_FALSE(obstacles.addBody(column.map, {0.05, 0.05, 0.6}, 0.2).empty());
    EXPECT_NE(obstacles.cells()->search(0.05, 0.05, 0.65), nullptr);
    EXPECT_EQ(obstacles.cells()->search(0.05, 0.05, 1.15), nullptr);
    EXPECT_TRUE(obstacles.addBody(column.map, {0.05, 0.05, 0.6}, 0.2).empty());
}

/// A straight path of 4 m along x.
std::vector<BeliefPoint> straightPath(double yaw) {
    std::vector<BeliefPoint> path;
    for (int i = 0; i <= 8; ++i) {
        BeliefPoint point;
        point.T_w_b.translation() << 0.5 * i, 0., 1.;
        point.T_w_b.linear() = Eigen::AngleAxisd(yaw, Eigen::Vector3d::UnitZ()).toRotationMatrix();
        point.length = point.distance = 0.5 * i;
        path.push_back(point);
    }
    return path;
}

SpaceAhead openSpace() {
    return {.clearance = [](const Eigen::Vector3d&) { return 1.; },
            .isSeen = [](const Eigen::Vector3d&) { return true; },
            .radius = 0.3,
            .hidden = 0.3,
            .canLook = true};
}

TEST(WayAhead, IsThePathWhereAllOfItWasSeenAndIsFree) {
    const WayAhead way = wayAhead(straightPath(0.), openSpace());
    EXPECT_TRUE(way.isWhole);
    EXPECT_EQ(way.plan.back().T_w_b.translation().x(), 4.);
}

TEST(WayAhead, EndsBeforeWhatWasNotSeen) {
    SpaceAhead space = openSpace();
    space.isSeen = [](const Eigen::Vector3d& p_w) { return p_w.x() < 2.; };
    const WayAhead way = wayAhead(straightPath(0.), space);
    EXPECT_FALSE(way.isWhole || way.isBlocked || way.isBlind);
    EXPECT_NEAR(way.plan.back().T_w_b.translation().x(), 1.7, 0.06);
}

TEST(WayAhead, TurnsToLookFirst) {
    SpaceAhead space = openSpace();
    space.isSeen = [](const Eigen::Vector3d& p_w) { return p_w.norm() < 1.1; };
    const WayAhead way = wayAhead(straightPath(2.), space);
    EXPECT_EQ(way.plan.back().T_w_b.translation().x(), 0.);
    EXPECT_NEAR(yawOf(way.plan.back().T_w_b), 0., 1e-9);
    EXPECT_FALSE(way.isBlind);
    // Where it looks there already, or cannot, it takes a short step.
    EXPECT_NEAR(wayAhead(straightPath(0.), space).plan.back().T_w_b.translation().x(), 0.3, 0.06);
    space.canLook = false;
    EXPECT_NEAR(wayAhead(straightPath(2.), space).plan.back().T_w_b.translation().x(), 0.3, 0.06);
}

TEST(WayAhead, NeverLeadsIntoAnObstacle) {
    SpaceAhead space = openSpace();
    space.clearance = [](const Eigen::Vector3d& p_w) { return 2.5 - p_w.x(); };
    const WayAhead way = wayAhead(straightPath(0.), space);
    EXPECT_TRUE(way.isBlocked);
    EXPECT_LT(way.plan.back().T_w_b.translation().x(), 2.2);
    space.clearance = [](const Eigen::Vector3d& p_w) { return 0.35 - p_w.x(); };
    EXPECT_EQ(wayAhead(straightPath(0.), space).plan.back().T_w_b.translation().x(), 0.);
    // A robot that is too near may fly away, but not nearer.
    space.clearance = [](const Eigen::Vector3d& p_w) { return 0.2 + p_w.x(); };
    EXPECT_TRUE(wayAhead(straightPath(0.), space).isWhole);
    space.clearance = [](const Eigen::Vector3d& p_w) { return 0.2 - p_w.x(); };
    EXPECT_EQ(wayAhead(straightPath(0.), space).plan.back().T_w_b.translation().x(), 0.);
}

/// A blank floor, mapped by noisy images, has gradients as well.
TEST(MapNoise, TellsNoiseFromTexture) {
    const Camera camera = makeCamera(94, 60, 1.2);
    PhotometricOptions options;
    const auto pose = test::cameraAt({0., 0., 2.}, test::kDown);
    const auto informationOf = [&](const Texture& texture) {
        View image;
        MeshRenderer(test::floorOf(texture)).render(camera, pose, image);
        std::mt19937 random(1);
        std::normal_distribution<float> normal(0.F, 0.02F);
        View map = image;
        for (unsigned i = 0; i < image.intensity.getSize(); ++i) {
            map.intensity.bitmap[i] += normal(random);
            image.intensity.bitmap[i] += normal(random);
        }
        MapNoise noise;
        const Matrix6 before = noise.model(camera, options)(map);
        noise.observe(map, image.intensity, camera);
        return std::pair(before.trace(), noise.model(camera, options)(map).trace());
    };
    const auto blank = informationOf(uniformTexture(0.5));
    EXPECT_LT(blank.second, 1e-3 * blank.first);
    const auto rich = informationOf(valueNoise({.size = {20., 20.}, .seed = 3}));
    EXPECT_GT(rich.second, 0.3 * rich.first);
}

}  // namespace
}  // namespace photonav
