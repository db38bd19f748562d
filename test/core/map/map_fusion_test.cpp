// SPDX-License-Identifier: BSD-3-Clause
#include "map/map_fusion.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <random>
#include <set>
#include <tuple>

#include "core/photometry/synthetic_floor.hpp"

namespace photonav {
namespace {

using Eigen::Array3i;
using test::floorView;
using test::kDown;
using test::lookDown;

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
    EXPECT_GT(quiet, 3 * reports);
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
