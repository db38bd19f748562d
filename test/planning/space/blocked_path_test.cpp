// SPDX-License-Identifier: BSD-3-Clause
// The quick check of a way against clearance from scratch.
#include "space/blocked_path.hpp"

#include <gtest/gtest.h>

#include <random>

#include "map/brick_leaves.hpp"
#include "map/distance_map.hpp"

namespace photonav {
namespace {

using Eigen::Vector3d;

constexpr double kCell = 0.1;

MapChange occupy(TexturedOcTree& map, const Vector3d& p_w) {
    const octomap::OcTreeKey key = map.coordToKey(p_w.x(), p_w.y(), p_w.z());
    map.setNodeValue(key, 1.F);
    MapChange change{.resolution = kCell};
    change.occupancy.push_back(
        (Eigen::Array3i(key[0], key[1], key[2]) - kKeyOfZero).unaryExpr([](int i) {
            return i >> 2;
        }));
    return change;
}

double leastClearance(const TexturedOcTree& map, const std::vector<Vector3d>& way) {
    const DistanceMap distances(map, {Vector3d(-2., -2., -2.), Vector3d(3., 3., 3.)},
                                {.maxDistance = 2., .unknown = UnknownPolicy::free});
    double least = 2.;
    for (std::size_t i = 0; i < way.size(); ++i) {
        const Vector3d& to = way[std::min(i + 1, way.size() - 1)];
        for (double t = 0.; t <= 1.; t += 0.01) {
            least = std::min(least, distances.clearance(way[i] + t * (to - way[i])));
        }
    }
    return least;
}

TEST(BlockedPath, AgreesWithTheClearanceOfTheMap) {
    std::mt19937 random(5);
    std::uniform_real_distribution<double> at(-1., 2.);
    const std::vector<Vector3d> way{{0., 0., 0.}, {1., 0., 0.}, {1., 1., 0.5}};
    int blocked = 0, free = 0;
    for (int i = 0; i < 150; ++i) {
        TexturedOcTree map(kCell);
        const MapChange change = occupy(map, {at(random), at(random), 0.5 * at(random)});
        const double clearance = leastClearance(map, way);
        for (const double radius : {0.2, 0.5}) {
            const bool isBlocked = blocksPath(map, change, way, radius);
            if (clearance < radius) {
                EXPECT_TRUE(isBlocked) << clearance;
            }
            if (clearance > radius + 1.5 * kCell) {
                EXPECT_FALSE(isBlocked) << clearance;
            }
            (isBlocked ? blocked : free) += 1;
        }
    }
    EXPECT_GT(blocked, 15);
    EXPECT_GT(free, 15);
}

TEST(BlockedPath, IsNotBlockedByCellsThatBecameFree) {
    TexturedOcTree map(kCell);
    const MapChange change = occupy(map, {0.5, 0., 0.});
    const std::vector<Vector3d> way{{0., 0., 0.}, {1., 0., 0.}};
    EXPECT_TRUE(blocksPath(map, change, way, 0.2));
    EXPECT_TRUE(blocksPath(map, change, {{0.5, 0., 0.}}, 0.2));
    EXPECT_FALSE(blocksPath(map, change, {}, 0.2));
    EXPECT_FALSE(blocksPath(map, {}, way, 0.2));
    map.setNodeValue(map.coordToKey(0.5, 0., 0.), -5.F);
    EXPECT_FALSE(blocksPath(map, change, way, 0.2));
}

}  // namespace
}  // namespace photonav
