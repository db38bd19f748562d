// SPDX-License-Identifier: BSD-3-Clause
#include "map/map_fusion.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <map>
#include <random>
#include <set>
#include <tuple>

#include "core/map/carpet_map.hpp"

namespace photonav {
namespace {

using Eigen::Array3i;
using test::floorView;
using test::kDown;
using test::kTop;
using test::lookDown;

struct Look {
    Camera camera;
    Pose T_c_w;
    View view;
};

/// Straight down on the carpet, which lies in the cells from z = 0 to 0.05.
Look overCarpet(double x, double height) {
    const Camera camera = makeCamera(160, 120, 1.2);
    const Pose T_c_w = lookDown(x, 0.01, height, kDown);
    return {camera, T_c_w, floorView(camera, T_c_w, test::carpet, 0.02)};
}

TEST(MapFusion, SeparatesFreeOccupiedAndUnknownCells) {
    const auto [camera, T_c_w, view] = overCarpet(0.01, 1.52);
    TexturedOcTree map(0.05);
    fuse(map, view, camera, T_c_w);
    for (double z = 0.075; z < 1.5; z += 0.05) {
        const auto* free = map.search(0.01, 0.01, z);
        ASSERT_NE(free, nullptr) << z;
        EXPECT_FALSE(map.isNodeOccupied(free)) << z;
    }
    const auto* surface = map.search(0.01, 0.01, 0.025);
    ASSERT_NE(surface, nullptr);
    EXPECT_TRUE(map.isNodeOccupied(surface));
    EXPECT_EQ(map.search(0.01, 0.01, -0.025), nullptr) << "behind the surface";
    EXPECT_EQ(map.search(2.01, 0.01, 0.025), nullptr) << "outside the image";
    EXPECT_EQ(map.search(0.01, 0.01, 1.60), nullptr) << "behind the camera";
}

TEST(MapFusion, FreesSpaceUpToTheRangeAndNoneWhereDepthIsMissing) {
    auto [camera, T_c_w, view] = overCarpet(0.01, 3.02);
    TexturedOcTree map(0.05);
    fuse(map, view, camera, T_c_w, {.maxRange = 2.});
    EXPECT_FALSE(map.isNodeOccupied(map.search(0.01, 0.01, 1.1)));
    EXPECT_EQ(map.search(0.01, 0.01, 0.9), nullptr);
    EXPECT_EQ(map.search(0.01, 0.01, 0.025), nullptr);

    for (const float depth : {0.F, -1.F, std::nanf(""), 0.1F}) {
        view.depth = depth;
        TexturedOcTree untouched(0.05);
        fuse(untouched, view, camera, T_c_w);
        EXPECT_EQ(untouched.size(), 0U) << depth;
    }
}

/// Fusing it takes seconds: it can be stopped between bricks as well.
TEST(MapFusion, AnImageInManyBricksCanBeFusedInPart) {
    const auto [camera, T_c_w, view] = overCarpet(0.01, 1.52);
    int asked = 0, most = std::numeric_limits<int>::max();
    FusionOptions options;
    options.isStopped = [&] { return ++asked >= most; };
    TexturedOcTree whole(0.005), plain(0.005), part(0.005);
    fuse(whole, view, camera, T_c_w, options);
    fuse(plain, view, camera, T_c_w);
    EXPECT_EQ(whole.size(), plain.size());
    most = asked;
    asked = 0;
    EXPECT_THROW(fuse(part, view, camera, T_c_w, options), Interrupted);
    EXPECT_GT(part.size(), 0U);
    EXPECT_LT(part.size(), whole.size());
}

TEST(MapFusion, AnImageInFewBricksIsFusedWholeOrNotAtAll) {
    const auto [camera, T_c_w, view] = overCarpet(0.01, 1.52);
    int asked = 0;
    FusionOptions options;
    options.isStopped = [&] { return ++asked == 100; };
    TexturedOcTree map(0.05);
    EXPECT_THROW(fuse(map, view, camera, T_c_w, options), Interrupted);
    EXPECT_EQ(asked, 100);
    EXPECT_EQ(map.size(), 0U);
    fuse(map, view, camera, T_c_w, options);  // it is not stopped any more
    TexturedOcTree whole(0.05);
    fuse(whole, view, camera, T_c_w);
    EXPECT_EQ(map.size(), whole.size());
}

TEST(MapFusion, FacesTowardTheCameraTakeTheMeanGrey) {
    const Camera camera = makeCamera(160, 120, 1.2);
    TexturedOcTree map(0.05);
    for (const auto& [grey, height] : {std::pair{0.3, 1.52}, {0.5, 1.52}}) {
        const Pose T_c_w = lookDown(0.31, 0.01, height, kDown);
        fuse(map,
             floorView(
                 camera, T_c_w, [g = grey](double, double) { return g; }, 0.02),
             camera, T_c_w);
    }
    const auto* cell = map.search(0.01, 0.01, 0.025);
    EXPECT_NEAR(cell->faces[kTop].mean, 0.4, 1e-6);
    // The camera stands toward +x, but the next floor cell covers that face; below is never seen.
    for (unsigned f = 0; f < 5; ++f) EXPECT_FALSE(cell->faces[f].observed()) << f;

    // A cell on its own shows its side as well, with the smaller weight of a slanted look.
    auto [sameCamera, T_c_w, view] = overCarpet(0.31, 1.52);
    TexturedOcTree lone(0.05);
    for (unsigned v = 0; v < camera.height; ++v) {
        for (unsigned u = 0; u < camera.width; ++u) {
            const Eigen::Vector3d p = test::pointOf(view, camera, T_c_w, u, v);
            if (p.x() < 0. || p.x() >= 0.05 || p.y() < 0. || p.y() >= 0.05) view.depth[v][u] = 0.F;
        }
    }
    fuse(lone, view, camera, T_c_w);
    const auto* slanted = lone.search(0.01, 0.01, 0.025);
    ASSERT_NE(slanted, nullptr);
    EXPECT_NEAR(slanted->faces[1].weight / slanted->faces[kTop].weight, 0.285 / 1.495, 1e-3);
    EXPECT_NEAR(slanted->faces[1].mean, slanted->faces[kTop].mean, 1e-6);
    EXPECT_FALSE(slanted->faces[0].observed());
    EXPECT_FALSE(slanted->faces[2].observed() || slanted->faces[3].observed());
}

TEST(MapFusion, ConstantFloorsStayConstantToTheBit) {
    const Camera camera = makeCamera(160, 120, 1.2);
    TexturedOcTree map(0.05);
    for (const double yaw : {0., 0.4, 0.8}) {
        const Pose T_c_w = lookDown(0.2 * yaw, 0.01, 1.52, 1.1, yaw);
        View view = floorView(
            camera, T_c_w, [](double, double) { return 0.; }, 0.02);
        view.intensity = 0.7F;
        fuse(map, view, camera, T_c_w);
    }
    for (auto leaf = map.begin_leafs(); leaf != map.end_leafs(); ++leaf) {
        for (const FaceTexture& face : leaf->faces) {
            ASSERT_TRUE(!face.observed() || face.mean == 0.7F) << face.mean;
        }
    }
}

TEST(MapFusion, DropsPixelsAtDepthEdges) {
    const Look look = overCarpet(0.01, 1.52);
    View view = look.view;
    for (unsigned v = 0; v < look.camera.height; ++v) {
        for (unsigned u = 0; u < 80; ++u) view.depth[v][u] = 1.F;
        view.depth[v][80] = 1.17F;  // smeared between the box at 1 m and the floor
    }
    const auto smeared = [&](double depthJump) {
        TexturedOcTree map(0.05);
        fuse(map, view, look.camera, look.T_c_w, {.depthJump = depthJump});
        int count = 0;
        for (auto leaf = map.begin_leafs(); leaf != map.end_leafs(); ++leaf) {
            const bool between = leaf.getZ() > 0.1 && leaf.getZ() < 0.45;
            count += static_cast<int>(between && map.isNodeOccupied(*leaf));
        }
        return count;
    };
    EXPECT_GT(smeared(1e9), 0);
    EXPECT_EQ(smeared(0.05), 0);
}

/// Share of the columns of cells in a square around the origin in which views show a surface at a
/// height.
double floorKept(const TexturedOcTree& map, double reach, double height) {
    int kept = 0, all = 0;
    const double cell = map.getResolution();
    for (double x = -reach; x < reach; x += cell) {
        for (double y = -reach; y < reach; y += cell, ++all) {
            const auto shows = [&](double z) {
                const auto* leaf = map.search(x + 0.3 * cell, y + 0.3 * cell, z);
                return leaf != nullptr && map.isNodeOccupied(leaf) &&
                       !leaf->surfaces.shown().empty();
            };
            kept += shows(height - 0.2 * cell) || shows(height + 0.2 * cell) ? 1 : 0;
        }
    }
    return double(kept) / all;
}

/// Here pixels are farther apart than cells, rows as far as five. From one half of the square to
/// the other, images see it at a grazing angle. Where the floor is on the border between two layers
/// of cells, noise moves its depth from one to the other.
TEST(MapFusion, AFineMapKeepsItsFloor) {
    const Camera camera = makeCamera(94, 60, 1.2);
    std::mt19937 random(4);
    std::normal_distribution<float> normal(0.F, 1.5e-3F);
    for (const double height : {0.005, 0.01}) {
        TexturedOcTree map(0.01);
        double first = 0.;
        for (int i = 0; i < 6; ++i) {
            const double yaw = 2. * EIGEN_PI * i / 6;
            const Pose T_c_w = lookDown(-1.2 * std::cos(yaw), -1.2 * std::sin(yaw), 0.8, 0.6, yaw);
            View view = floorView(camera, T_c_w, test::carpet, height);
            for (unsigned p = 0; p < view.depth.getSize(); ++p) {
                float& z = view.depth.bitmap[p];
                z += normal(random) * z * z;
            }
            fuse(map, view, camera, T_c_w, {.maxRange = 2.5});
            if (i == 0) first = floorKept(map, 0.3, height);
        }
        EXPECT_GT(first, 0.97) << height;
        EXPECT_GT(floorKept(map, 0.3, height), 0.99) << height;
    }
}

TEST(MapFusion, RefusesInputThatDoesNotFit) {
    const Camera camera = makeCamera(16, 12, 1.2);
    TexturedOcTree map(0.05);
    View view = floorView(camera, lookDown(0., 0., 1., kDown), test::carpet);
    EXPECT_THROW(fuse(map, view, makeCamera(17, 12, 1.2), Pose::Identity()), std::invalid_argument);
    Pose broken = Pose::Identity();
    broken.translation().x() = std::nan("");
    EXPECT_THROW(fuse(map, view, camera, broken), std::invalid_argument);
    Pose far = Pose::Identity();
    far.translation().x() = 1e5;
    EXPECT_THROW(fuse(map, view, camera, far), std::invalid_argument);
    view.depth = 1e9F;
    EXPECT_THROW(fuse(map, view, camera, Pose::Identity(), {.maxRange = 1e9}),
                 std::invalid_argument);
    EXPECT_EQ(map.size(), 0U);
}

using Key = std::tuple<int, int, int>;  // z, y, x

/// What a query says about a cell.
struct Cell {
    bool known = false, occupied = false;
    std::optional<ShownGreys> greys;
    ShownSurfaces surfaces{};
};

using Cells = std::map<Key, Cell>;

Cells cellsOf(const TexturedOcTree& map) {
    Cells cells;
    for (auto leaf = map.begin_leafs(); leaf != map.end_leafs(); ++leaf) {
        const int edge = static_cast<int>(std::lround(leaf.getSize() / map.getResolution()));
        const octomap::OcTreeKey first = leaf.getIndexKey();  // the leaf's first cell
        const bool occupied = map.isNodeOccupied(*leaf);
        for (int i = 0; i < edge * edge * edge; ++i) {
            const Array3i at = Array3i(first[0], first[1], first[2]) - kKeyOfZero +
                               Array3i(i % edge, i / edge % edge, i / edge / edge);
            cells[{at.z(), at.y(), at.x()}] = {true, occupied,
                                               occupied ? leaf->shownGreys() : std::nullopt,
                                               leaf->surfaces.shown()};
        }
    }
    return cells;
}

Key brickOf(const Key& cell) {
    const auto [z, y, x] = cell;
    return {z >> 2, y >> 2, x >> 2};
}

struct Expected {
    std::set<Key> occupancy, anyTexture;
};

/// The plain comparison of all cells; fusion never makes one unknown.
Expected compare(const Cells& before, const Cells& after) {
    Expected expected;
    for (const auto& [key, cell] : after) {
        const auto old = before.find(key);
        if (old == before.end() || old->second.occupied != cell.occupied) {
            expected.occupancy.insert(brickOf(key));
        } else if (old->second.greys != cell.greys || old->second.surfaces != cell.surfaces) {
            expected.anyTexture.insert(brickOf(key));
        }
    }
    return expected;
}

std::vector<Key> keysOf(const std::vector<Array3i>& bricks) {
    std::vector<Key> keys;
    for (const auto& brick : bricks) keys.emplace_back(brick.z(), brick.y(), brick.x());
    return keys;
}

std::vector<Key> listOf(const std::set<Key>& keys) { return {keys.begin(), keys.end()}; }

/// A noisy view of a carpet from a random place; every third one shows a box on it.
View randomView(std::mt19937& random, const Camera& camera, Pose& T_c_w) {
    std::uniform_real_distribution<double> uniform(-1., 1.);
    T_c_w = lookDown(0.4 * uniform(random), 0.4 * uniform(random), 1.2 + 0.2 * uniform(random),
                     kDown - 0.3 + 0.3 * uniform(random), 3. * uniform(random));
    View view = floorView(camera, T_c_w, test::carpet, 0.02);
    test::addNoise(view.intensity, 0.02, random());
    if (random() % 3 != 0) return view;
    for (unsigned v = 10; v < 25; ++v) {
        for (unsigned u = 20; u < 40; ++u) view.depth[v][u] *= 0.8F;
    }
    return view;
}

TEST(MapFusion, ReportsExactlyTheBricksThatChanged) {
    const Camera camera = makeCamera(64, 48, 1.1);
    std::mt19937 random(5);
    TexturedOcTree map(0.05);
    Cells before;
    std::size_t flips = 0, textures = 0;
    for (int i = 0; i < 25; ++i) {
        Pose T_c_w;
        const View view = randomView(random, camera, T_c_w);
        const MapChange change = fuse(map, view, camera, T_c_w);
        const Cells after = cellsOf(map);
        const Expected expected = compare(before, after);
        EXPECT_EQ(change.resolution, 0.05);
        ASSERT_EQ(keysOf(change.occupancy), listOf(expected.occupancy)) << i;
        ASSERT_EQ(keysOf(change.anyTexture), listOf(expected.anyTexture)) << i;
        EXPECT_LE(change.texture.size(), change.anyTexture.size());
        before = after;
        if (i == 0) continue;
        flips += change.occupancy.size();
        textures += change.anyTexture.size();
    }
    EXPECT_GT(flips, 100U);
    EXPECT_GT(textures, 1000U);
}

TEST(MapFusion, WithoutToleranceEveryChangedTextureCounts) {
    const Camera camera = makeCamera(64, 48, 1.1);
    std::mt19937 random(6);
    TexturedOcTree map(0.05);
    for (int i = 0; i < 5; ++i) {
        Pose T_c_w;
        const View view = randomView(random, camera, T_c_w);
        const MapChange change = fuse(map, view, camera, T_c_w, {.greyTolerance = 0.});
        EXPECT_EQ(keysOf(change.texture), keysOf(change.anyTexture)) << i;
    }
}

/// The largest difference to what a brick showed when it was reported last; updates `reported`.
int mostUnreported(const Cells& now, const MapChange& change, Cells& reported) {
    const auto isIn = [](const std::vector<Key>& keys, const Key& key) {
        return std::binary_search(keys.begin(), keys.end(), key);
    };
    const auto textures = keysOf(change.texture), occupancies = keysOf(change.occupancy);
    int most = 0;
    for (const auto& [key, cell] : now) {
        if (isIn(textures, brickOf(key)) || isIn(occupancies, brickOf(key))) reported[key] = cell;
        const Cell& old = reported[key];
        EXPECT_EQ(old.greys.has_value(), cell.greys.has_value());
        for (unsigned f = 0; f < 6 && old.greys && cell.greys; ++f) {
            most = std::max(most, std::abs((*old.greys)[f] - (*cell.greys)[f]));
        }
    }
    return most;
}

TEST(MapFusion, SmallStepsOfATextureAddUpUntilTheyAreReported) {
    const Camera camera = makeCamera(64, 48, 1.1);
    const Pose T_c_w = lookDown(0., 0., 1.2, kDown);
    TexturedOcTree map(0.05);
    Cells reported;
    std::size_t quiet = 0, reports = 0;
    for (int i = 0; i < 60; ++i) {  // the floor darkens slowly: 0.0015 in every view
        const auto fading = [&](double x, double y) {
            return 0.9 * test::carpet(x, y) - 0.002 * i;
        };
        const MapChange change = fuse(map, floorView(camera, T_c_w, fading, 0.02), camera, T_c_w);
        EXPECT_LE(mostUnreported(cellsOf(map), change, reported), 0.01 * 65535. + 1.) << i;
        quiet += change.anyTexture.size() - change.texture.size();
        if (i > 0) reports += change.texture.size();
    }
    EXPECT_GT(reports, 0U);
    EXPECT_GT(quiet, 2 * reports);  // most reports: of weights, which double
}

TEST(MapFusion, ASurfaceThatWasPaintedAnewIsLearnedAnew) {
    const Camera camera = makeCamera(64, 48, 0.5);
    const Pose T_c_w = lookDown(0., 0., 1.2, kDown);
    TexturedOcTree map(0.05);
    const auto look = [&](double grey, int times) {
        const View view = floorView(
            camera, T_c_w, [grey](double, double) { return grey; }, 0.02);
        for (int i = 0; i < times; ++i) fuse(map, view, camera, T_c_w);
        return map.search(0.01, 0.01, 0.025)->faces[5];
    };
    EXPECT_NEAR(look(0.2, 1000).mean, 0.2, 1e-4);
    const FaceTexture anew = look(0.8, 50);
    EXPECT_GT(anew.mean, 0.7F);
    EXPECT_EQ(anew.weight, static_cast<float>(FusionOptions{}.maxFaceWeight));
}

}  // namespace
}  // namespace photonav
