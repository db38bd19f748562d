// SPDX-License-Identifier: BSD-3-Clause
#include "map/distance_map.hpp"

#include <dynamicEDT3D/dynamicEDTOctomap.h>
#include <gtest/gtest.h>
#include <octomap/OcTree.h>

#include <random>

namespace photonav {
namespace {

using Eigen::AlignedBox3d;
using Eigen::Vector3d;

Triangle triangle(const Vector3d& a, const Vector3d& b, const Vector3d& c) {
    Triangle t;
    t.corners = {a.cast<float>(), b.cast<float>(), c.cast<float>()};
    t.uv.fill(Eigen::Vector2f::Zero());
    return t;
}

Scene randomTriangles(int count, std::mt19937& random) {
    std::uniform_real_distribution<double> position(-1.5, 1.5);
    const auto point = [&] {
        return Vector3d(position(random), position(random), position(random));
    };
    Scene scene;
    for (int i = 0; i < count; ++i) {
        const Vector3d a = point();
        scene.triangles.push_back(triangle(a, a + 0.3 * point(), a + 0.3 * point()));
    }
    return scene;
}

Vector3d randomInside(const AlignedBox3d& box, std::mt19937& random) {
    std::uniform_real_distribution<double> unit(0., 1.);
    const Vector3d t(unit(random), unit(random), unit(random));
    return box.min() + t.cwiseProduct(box.sizes());
}

double distanceToTriangle(const Triangle& t, const Vector3d& p, int samples) {
    const Vector3d a = t.corners[0].cast<double>();
    const Vector3d ab = t.corners[1].cast<double>() - a;
    const Vector3d ac = t.corners[2].cast<double>() - a;
    double least = std::numeric_limits<double>::infinity();
    for (int i = 0; i <= samples; ++i) {
        for (int j = 0; i + j <= samples; ++j) {
            least = std::min(least, (a + ab * i / samples + ac * j / samples - p).norm());
        }
    }
    return least;
}

TEST(DistanceMap, EmptySceneIsFreeEverywhere) {
    const DistanceMap map(Scene{}, 0.05, AlignedBox3d(Vector3d::Zero(), Vector3d::Ones()),
                          {.maxDistance = 0.7});
    EXPECT_EQ(map.clearance(Vector3d(0.5, 0.5, 0.5)), 0.7);
    EXPECT_EQ(DistanceMap(0.4).clearance(Vector3d::Zero()), 0.4);
}

TEST(DistanceMap, MatchesBruteForceOverSampledTriangles) {
    std::mt19937 random(1);
    const Scene scene = randomTriangles(12, random);
    const double resolution = 0.1;
    const AlignedBox3d bounds(Vector3d(-1., -1.2, -0.9), Vector3d(1.3, 1., 1.));
    const DistanceMap map(scene, resolution, bounds, {.maxDistance = 0.8});
    for (int i = 0; i < 300; ++i) {
        const Vector3d p = randomInside(bounds, random);
        double expected = std::numeric_limits<double>::infinity();
        for (const auto& t : scene.triangles) {
            expected = std::min(expected, distanceToTriangle(t, p, 100));
        }
        expected = std::min(expected, 0.8);
        const double clearance = map.clearance(p);
        // The surface is anywhere in its cell, half a cell is taken off, and slanted outlines take
        // a neighbouring cell with them.
        EXPECT_LE(clearance, std::min(0.8, expected + 0.4 * resolution) + 1e-6) << p.transpose();
        EXPECT_GE(clearance, std::min(0.8, expected - 2. * resolution) - 1e-6) << p.transpose();
    }
}

TEST(DistanceMap, SlantedTrianglesHaveNoGaps) {
    std::mt19937 random(2);
    const AlignedBox3d bounds(Vector3d::Constant(-2.), Vector3d::Constant(2.));
    for (int i = 0; i < 20; ++i) {
        const Scene scene = randomTriangles(1, random);
        const DistanceMap map(scene, 0.07, bounds, {.maxDistance = 0.5});
        const auto& t = scene.triangles[0].corners;
        std::uniform_real_distribution<float> unit(0.F, 1.F);
        for (int k = 0; k < 200; ++k) {
            const float a = unit(random);
            const float b = unit(random) * (1.F - a);
            const Eigen::Vector3f p = t[0] + a * (t[1] - t[0]) + b * (t[2] - t[0]);
            // Of the eight centres around p, its own cell is an obstacle and no other is far.
            EXPECT_LE(map.clearance(p.cast<double>()), 0.07);
        }
    }
}

TEST(DistanceMap, TriangleWithoutAreaIsStillAnObstacle) {
    Scene scene;
    scene.triangles = {triangle({0., 0., 0.}, {0.5, 0.5, 0.5}, {1., 1., 1.})};
    const AlignedBox3d bounds(Vector3d::Constant(-1.), Vector3d::Constant(2.));
    const DistanceMap map(scene, 0.1, bounds, {.maxDistance = 0.5});
    EXPECT_LT(map.clearance(Vector3d(0.5, 0.5, 0.5)), 0.1);
    EXPECT_EQ(map.clearance(Vector3d(-0.9, 1.9, 0.)), 0.5);
}

TEST(DistanceMap, FloorIsNeverTooFarAndHardlyTooNear) {
    Scene scene;
    scene.triangles = {triangle({-5., -5., 0.}, {5., -5., 0.}, {5., 5., 0.}),
                       triangle({-5., -5., 0.}, {5., 5., 0.}, {-5., 5., 0.})};
    const AlignedBox3d bounds(Vector3d(-4., -4., -1.), Vector3d(4., 4., 3.));
    const DistanceMap map(scene, 0.05, bounds, {.maxDistance = 1.});
    for (double z = 0.; z < 3.; z += 0.013) {
        const double expected = std::min(z - 0.025, 1.);
        const double clearance = map.clearance(Vector3d(0.31, -2.77, z));
        EXPECT_LE(clearance, expected + 1e-5);
        EXPECT_GE(clearance, expected - 0.37 * 0.05 - (z > 0.97 && z < 1.1 ? 0.02 : 0.));
    }
    EXPECT_LT(map.clearance(Vector3d(0.3, 0.3, 0.)), 0.);
}

/// Far from all their surfaces.
TEST(DistanceMap, BoxesAndWallsAreFullInside) {
    const AlignedBox3d bounds(Vector3d(-5., -5., 0.), Vector3d(5., 5., 4.));
    const auto clearance = [&](const Scene& scene, const Vector3d& p_w) {
        return DistanceMap(scene, 0.1, bounds, {}).clearance(p_w);
    };
    Scene box;
    addTexture(box, uniformTexture(0.5));
    addBox(box, {-2., -2., 0.}, {2., 2., 4.}, 0);
    EXPECT_LT(clearance(box, {0., 0., 2.}), 0.);
    EXPECT_LT(clearance(box, {1.9, -1.9, 3.9}), 0.);
    EXPECT_GT(clearance(box, {3., 0., 2.}), 0.8);
    Scene room;
    addTexture(room, uniformTexture(0.5));
    addBox(room, {-4., -4., 0.}, {4., 4., 4.}, 0, BoxInside::hollow);
    EXPECT_EQ(clearance(room, {0., 0., 2.}), 1.);
    Scene wall;
    addTexture(wall, uniformTexture(0.5));
    addWall(wall, {.footprint = {{-3., -3.}, {0., 0.}, {3., -3.}}, .height = 4., .thickness = 2.},
            0);
    EXPECT_LT(clearance(wall, {-1.5, -1.5, 2.}), 0.);
    EXPECT_LT(clearance(wall, {0., 0., 2.}), 0.);
    EXPECT_GT(clearance(wall, {0., -4., 2.}), 0.9);
}

TEST(DistanceMap, ObstaclesOutsideTheBoundsCount) {
    Scene wall;
    addTexture(wall, uniformTexture(0.5));
    wall.triangles = {triangle({1.5, -9., -9.}, {1.5, 9., -9.}, {1.5, 0., 9.})};
    const AlignedBox3d bounds(Vector3d::Zero(), Vector3d::Ones());
    const DistanceMap map(wall, 0.1, bounds, {.maxDistance = 1.});
    EXPECT_NEAR(map.clearance(Vector3d(1., 0.5, 0.5)), 0.43, 0.02);
    EXPECT_NEAR(map.clearance(Vector3d(1.4, 0.5, 0.5)), 0.33, 0.02);  // the last cell's value
    EXPECT_EQ(map.clearance(Vector3d(-100., 0.5, 0.5)), 1.);
    const DistanceMap far(wall, 0.1, bounds, {.maxDistance = 0.3});
    EXPECT_FLOAT_EQ(far.clearance(Vector3d(1., 0.5, 0.5)), 0.3);
}

/// Random boxes in a room whose upper part nobody has seen; the same cells in both kinds of map.
struct RandomRoom {
    static constexpr double kResolution = 0.1;
    TexturedOcTree map{kResolution};
    octomap::OcTree plain{kResolution};

    explicit RandomRoom(std::mt19937& random) {
        std::bernoulli_distribution obstacle(0.004);
        for (int x = -16; x < 16; ++x) {
            for (int y = -16; y < 16; ++y) {
                for (int z = -8; z < 8; ++z) {
                    const octomap::OcTreeKey key(32768 + x, 32768 + y, 32768 + z);
                    const bool occupied = obstacle(random);
                    map.updateNode(key, occupied);
                    plain.updateNode(key, occupied);
                }
            }
        }
    }
};

TEST(DistanceMap, MatchesDynamicEdtAtCellCentres) {
    std::mt19937 random(4);
    RandomRoom room(random);
    const double half = 0.5 * RandomRoom::kResolution;
    const AlignedBox3d bounds(Vector3d(-1.45, -1.45, -0.65), Vector3d(1.45, 1.45, 1.75));
    for (const auto unknown : {UnknownPolicy::free, UnknownPolicy::occupied}) {
        const DistanceMap map(room.map, bounds, {.maxDistance = 0.6, .unknown = unknown});
        // The reference counts cells outside its box as free, so it gets a larger one.
        DynamicEDTOctomap reference(2.F, &room.plain, octomap::point3d(-3, -3, -3),
                                    octomap::point3d(3, 3, 3), unknown == UnknownPolicy::occupied);
        reference.update();
        const double kCorner = 0.366 * RandomRoom::kResolution;
        int below = 0;
        for (double x = -1.45; x < 1.5; x += 0.1) {
            for (double y = -1.45; y < 1.5; y += 0.1) {
                for (double z = -0.65; z < 1.8; z += 0.1) {
                    const octomap::point3d p(static_cast<float>(x), static_cast<float>(y),
                                             static_cast<float>(z));
                    const double expected =
                        std::min<double>(reference.getDistance(p) - half, map.maxDistance());
                    // a face or a corner may point here
                    const double clearance = map.clearance(Vector3d(x, y, z));
                    ASSERT_LE(clearance, expected + 1e-5) << x << ' ' << y << ' ' << z;
                    ASSERT_GE(clearance, expected - kCorner - 1e-5) << x << ' ' << y << ' ' << z;
                    below += expected < map.maxDistance() ? 1 : 0;
                }
            }
        }
        EXPECT_GT(below, 1000);
    }
}

/// Against the cubes themselves: at centres never too large, elsewhere by less than half a cell.
TEST(DistanceMap, NeverOverestimatesClearance) {
    std::mt19937 random(8);
    std::uniform_int_distribution<int> cell(-12, 12);
    const AlignedBox3d bounds(Vector3d::Constant(-1.3), Vector3d::Constant(1.3));
    double mostAtCentres = -1.;
    double most = -1.;
    for (int round = 0; round < 20; ++round) {
        TexturedOcTree map(0.1);
        std::vector<AlignedBox3d> cubes;
        for (int i = 0; i < 1 + 2 * round; ++i) {
            const Eigen::Array3d corner(cell(random), cell(random), cell(random));
            cubes.emplace_back(Vector3d(0.1 * corner), Vector3d(0.1 * (corner + 1.)));
            const Vector3d centre = cubes.back().center();
            map.updateNode(centre.x(), centre.y(), centre.z(), true);
        }
        const DistanceMap distance(map, bounds,
                                   {.maxDistance = 1., .unknown = UnknownPolicy::free});
        for (int i = 0; i < 2000; ++i) {
            Vector3d p = randomInside(bounds, random);
            const bool atCentre = i % 2 == 0;
            if (atCentre) p = 0.1 * ((p.array() * 10.).floor() + 0.5).matrix();
            double truth = 1.;
            for (const auto& cube : cubes) truth = std::min(truth, cube.exteriorDistance(p));
            const double excess = (distance.clearance(p) - truth) / 0.1;
            EXPECT_GE(excess, -0.67) << p.transpose();
            (atCentre ? mostAtCentres : most) = std::max(atCentre ? mostAtCentres : most, excess);
        }
    }
    EXPECT_LT(mostAtCentres, 1e-4);
    EXPECT_GT(mostAtCentres, -1e-4);
    EXPECT_LT(most, 0.5);
}

TEST(DistanceMap, MergedCellsCountInFull) {
    TexturedOcTree map(0.1);
    for (unsigned i = 0; i < 512; ++i) {
        map.updateNode(octomap::OcTreeKey(32768 + i % 8, 32768 + i / 8 % 8, 32768 + i / 64), true);
    }
    map.prune();
    ASSERT_LT(map.getNumLeafNodes(), 512U);
    const AlignedBox3d bounds(Vector3d(-1., 0., 0.), Vector3d(2., 0.8, 0.8));
    const DistanceMap distance(map, bounds, {.unknown = UnknownPolicy::free});
    EXPECT_NEAR(distance.clearance(Vector3d(-0.45, 0.45, 0.75)), 0.43, 0.02);
    EXPECT_NEAR(distance.clearance(Vector3d(1.25, 0.45, 0.05)), 0.43, 0.02);
    EXPECT_LT(distance.clearance(Vector3d(0.4, 0.4, 0.4)), 0.);
}

TEST(DistanceMap, UnvisitedMapFollowsThePolicy) {
    const TexturedOcTree map(0.1);
    const AlignedBox3d bounds(Vector3d::Zero(), Vector3d::Ones());
    const Vector3d centre = Vector3d::Constant(0.5);
    EXPECT_LT(DistanceMap(map, bounds, {.unknown = UnknownPolicy::occupied}).clearance(centre), 0.);
    EXPECT_EQ(DistanceMap(map, bounds, {.unknown = UnknownPolicy::free}).clearance(centre), 1.);
}

/// Sets random cells, or all cells of a random box, free or occupied.
MapChange editCells(TexturedOcTree& map, std::mt19937& random, int reach) {
    const auto within = [&](int n) { return static_cast<int>(random() % n); };
    MapChange change;
    change.resolution = map.getResolution();
    const auto set = [&](const Eigen::Array3i& cell, bool occupied) {
        const Eigen::Array3i key = cell + kKeyOfZero;
        map.setNodeValue(octomap::OcTreeKey(key.x(), key.y(), key.z()), occupied ? 1.F : -1.F);
        change.occupancy.push_back(cell.unaryExpr([](int i) { return i >> 2; }));
    };
    const Eigen::Array3i at =
        Eigen::Array3i(within(2 * reach), within(2 * reach), within(2 * reach)) - reach;
    if (random() % 3 == 0) {
        const Eigen::Array3i size(1 + within(12), 1 + within(12), 1 + within(6));
        const bool occupied = random() % 3 == 0;
        for (int i = 0; i < size.prod(); ++i) {
            set(at + Eigen::Array3i(i % size.x(), i / size.x() % size.y(), i / size.x() / size.y()),
                occupied);
        }
    } else {
        for (int i = 0; i < 4; ++i) {
            set(at + Eigen::Array3i(within(5), within(5), within(5)), random() % 2 == 0);
        }
    }
    change.normalize();
    return change;
}

/// A single obstacle that comes and goes: its influence ends at maxDistance, not before.
TEST(DistanceMap, UpdatesReachAsFarAsTheDistance) {
    const AlignedBox3d bounds(Vector3d::Constant(-1.), Vector3d::Constant(1.));
    const DistanceMap::Options options{.maxDistance = 0.6, .unknown = UnknownPolicy::free};
    TexturedOcTree map(0.05);
    DistanceMap updated(map, bounds, options);
    for (const int at : {0, -9, 13, 4}) {
        for (const bool isOccupied : {true, false}) {
            const Eigen::Array3i cell(at, at / 2, -at), key = cell + kKeyOfZero;
            map.setNodeValue(octomap::OcTreeKey(key.x(), key.y(), key.z()),
                             isOccupied ? 1.F : -1.F);
            MapChange change{.resolution = 0.05};
            change.occupancy.push_back(cell.unaryExpr([](int i) { return i >> 2; }));
            updated.update(map, change);
            const DistanceMap fresh(map, bounds, options);
            for (int i = 0; i < 40 * 40 * 40; ++i) {
                const Eigen::Array3d index(i % 40, i / 40 % 40, i / 1600);
                const Vector3d p = ((index - 20. + 0.5) * 0.05).matrix();
                ASSERT_EQ(updated.clearance(p), fresh.clearance(p)) << p.transpose();
            }
        }
    }
}

TEST(DistanceMap, UpdatesEqualMapsMadeAnewToTheBit) {
    const AlignedBox3d bounds(Vector3d(-1.13, -0.71, -0.4), Vector3d(1.6, 0.9, 0.52));
    const auto value = [](double range, std::mt19937& random) {
        return std::uniform_real_distribution<double>(-range, range)(random);
    };
    for (unsigned seed = 0; seed < 8; ++seed) {
        std::mt19937 random(seed);
        const DistanceMap::Options options{
            .maxDistance = seed % 4 < 2 ? 0.35 : 0.8,
            .unknown = seed % 2 == 0 ? UnknownPolicy::occupied : UnknownPolicy::free};
        TexturedOcTree map(0.05);
        for (unsigned i = 0; i < seed; ++i) editCells(map, random, 30);
        DistanceMap updated(map, bounds, options);
        int different = 0;
        for (int step = 0; step < 30; ++step) {
            MapChange change;  // reach 60 cells: also far outside of the bounds
            for (unsigned i = 0; i <= random() % 4; ++i) {
                change.join(editCells(map, random, step % 5 == 0 ? 60 : 25));
            }
            const DistanceMap before = updated;
            updated.update(map, change);
            const DistanceMap fresh(map, bounds, options);
            for (int i = 0; i < 3000; ++i) {
                const Vector3d p(value(2., random), value(1., random), value(0.6, random));
                ASSERT_EQ(updated.clearance(p), fresh.clearance(p)) << seed << ' ' << step;
                different += static_cast<int>(before.clearance(p) != fresh.clearance(p));
            }
        }
        EXPECT_GT(different, 20);
    }
}

TEST(DistanceMap, FollowsOnlyTheMapItWasMadeFrom) {
    const AlignedBox3d bounds(Vector3d::Zero(), Vector3d::Ones());
    const TexturedOcTree map(0.1);
    MapChange change;
    change.resolution = 0.2;
    change.occupancy.emplace_back(0, 0, 0);
    DistanceMap ofMap(map, bounds, {});
    EXPECT_THROW(ofMap.update(map, change), std::invalid_argument);
    EXPECT_NO_THROW(ofMap.update(map, {}));
    EXPECT_THROW(DistanceMap(Scene{}, 0.1, bounds, {}).update(map, change), std::invalid_argument);
}

TEST(DistanceMap, RejectsWhatCannotWork) {
    const AlignedBox3d box(Vector3d::Zero(), Vector3d::Ones());
    const auto build = [](double resolution, const AlignedBox3d& bounds, double maxDistance) {
        return DistanceMap(Scene{}, resolution, bounds, {.maxDistance = maxDistance});
    };
    EXPECT_THROW(build(0., box, 1.), std::invalid_argument);
    EXPECT_THROW(build(0.1, AlignedBox3d(), 1.), std::invalid_argument);
    EXPECT_THROW(build(0.1, box, 0.), std::invalid_argument);
    EXPECT_THROW(build(0.001, box, 1.), std::invalid_argument);  // 1000 cells of reach
    try {
        build(0.01, AlignedBox3d(Vector3d::Zero(), Vector3d::Constant(100.)), 1.);
        FAIL() << "4 TB were not refused";
    } catch (const std::invalid_argument& error) {
        EXPECT_NE(std::string(error.what()).find("would fit"), std::string::npos) << error.what();
    }
}

}  // namespace
}  // namespace photonav
