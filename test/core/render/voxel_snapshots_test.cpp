// SPDX-License-Identifier: BSD-3-Clause
#include "render/voxel_snapshots.hpp"

#include <gtest/gtest.h>

#include <numbers>
#include <random>
#include <thread>

#include "map/map_fusion.hpp"

namespace photonav {
namespace {

using Eigen::Array3i;

constexpr double kCellSize = 0.05;

/// A map that is edited cell by cell, and what the edits changed.
struct EditedMap {
    TexturedOcTree map{kCellSize};
    MapChange change;

    /// Faces observed with an odd number have surfaces inside the cell.
    void set(const Array3i& cell, bool occupied, float grey, unsigned observedFaces) {
        const Array3i key = cell + kKeyOfZero;
        auto* node =
            map.setNodeValue(octomap::OcTreeKey(key.x(), key.y(), key.z()), occupied ? 1.F : -1.F);
        node->faces = {};
        node->surfaces.clear();
        for (unsigned f = 0; f < 6; ++f) {
            if ((observedFaces >> f & 1U) == 0) continue;
            node->faces[f].observe(grey, 1.F);
            if (observedFaces % 2 == 0) continue;
            Eigen::Vector3f normal(grey - 0.5F, 0.3F, 0.4F - grey);
            normal[f / 2] = f % 2 == 1 ? 1.F : -1.F;
            node->surfaces.obtain(f).observe({0.2F - grey / 3.F, 0.F, grey / 2.F},
                                             normal.normalized(), 1.F, 1.F);
        }
        node->surfaces.refreshShown();
        change.resolution = kCellSize;
        const Array3i brick = cell.unaryExpr([](int i) { return i >> 2; });
        change.occupancy.push_back(brick);
        change.anyTexture.push_back(brick);
    }

    MapChange takeChange() {
        change.normalize();
        return std::exchange(change, {});
    }
};

/// Walls, holes, free and unknown cells in a box.
void editBox(EditedMap& edited, std::mt19937& random, const Array3i& low, const Array3i& high) {
    std::uniform_real_distribution<float> uniform(0.F, 1.F);
    for (int z = low.z(); z < high.z(); ++z) {
        for (int y = low.y(); y < high.y(); ++y) {
            for (int x = low.x(); x < high.x(); ++x) {
                const bool wall = x == low.x() || y == high.y() - 1 || z == low.z();
                const float dice = uniform(random);
                if (wall ? dice < 0.8F : dice < 0.03F) {
                    edited.set({x, y, z}, true, uniform(random), dice < 0.01F ? 0U : random());
                } else if (dice < 0.9F) {
                    edited.set({x, y, z}, false, 0.F, 0);
                }
            }
        }
    }
}

/// A random edit: single cells, or a box that may lie outside of all that was known.
void edit(EditedMap& edited, std::mt19937& random, int reach) {
    const auto within = [&](int n) { return static_cast<int>(random() % n); };
    const Array3i at = Array3i(within(2 * reach), within(2 * reach), within(reach)) -
                       Array3i(reach, reach, reach / 2);
    if (random() % 3 == 0) {
        editBox(edited, random, at, at + 2 + Array3i(within(9), within(9), within(9)));
        return;
    }
    for (int i = 0; i < 5; ++i) {
        edited.set(at + Array3i(within(4), within(4), within(4)), random() % 2 == 0,
                   static_cast<float>(within(100)) / 100.F, random());
    }
}

Pose randomPose(std::mt19937& random) {
    std::uniform_real_distribution<double> uniform(-1., 1.);
    const Eigen::Vector3d axis(uniform(random), uniform(random), uniform(random));
    Pose T_w_c = Pose::Identity();
    T_w_c.linear() = Eigen::AngleAxisd(3. * uniform(random), axis.normalized()).toRotationMatrix();
    T_w_c.translation() = Eigen::Vector3d(uniform(random), uniform(random), uniform(random));
    return T_w_c.inverse();
}

View viewOf(const ViewSource& source, const Pose& T_c_w) {
    View view;
    source.render(makeCamera(80, 60, 1.4), T_c_w, view);
    return view;
}

bool areEqual(const View& a, const View& b) {
    const auto same = [](const ImageF& i, const ImageF& j) {
        return std::equal(i.bitmap, i.bitmap + i.getSize(), j.bitmap, j.bitmap + j.getSize());
    };
    return same(a.intensity, b.intensity) && same(a.depth, b.depth);
}

/// @returns whether some pixel has depth
bool expectEqualViews(const ViewSource& updated, const ViewSource& fresh, std::mt19937& random) {
    bool hasDepth = false;
    for (int i = 0; i < 6; ++i) {
        const Pose T_c_w = randomPose(random);
        const View view = viewOf(updated, T_c_w), expected = viewOf(fresh, T_c_w);
        EXPECT_TRUE(areEqual(view, expected)) << "view " << i;
        hasDepth = hasDepth || view.depth.getMaxValue() > 0.F;
    }
    return hasDepth;
}

class VoxelSnapshotsAs : public testing::TestWithParam<UnknownPolicy> {};

TEST_P(VoxelSnapshotsAs, EqualFreshOnesToTheBitAfterAnyChanges) {
    for (unsigned seed = 0; seed < 6; ++seed) {
        std::mt19937 random(seed);
        EditedMap edited;
        if (seed % 2 == 0) editBox(edited, random, {-12, -9, -3}, {12, 11, 13});
        edited.takeChange();
        VoxelSnapshots snapshots(edited.map, GetParam());
        int withDepth = 0;
        for (int step = 0; step < 25; ++step) {
            for (unsigned i = 0; i <= random() % 3; ++i) edit(edited, random, 8 + 2 * step);
            const auto updated = snapshots.update(edited.map, edited.takeChange());
            EXPECT_EQ(updated, snapshots.current());
            const VoxelRenderer fresh(edited.map, GetParam());
            withDepth += static_cast<int>(expectEqualViews(*updated, fresh, random));
            ASSERT_FALSE(HasFailure()) << "seed " << seed << ", step " << step;
        }
        EXPECT_GT(withDepth, 3);
    }
}

INSTANTIATE_TEST_SUITE_P(UnknownCells, VoxelSnapshotsAs,
                         testing::Values(UnknownPolicy::free, UnknownPolicy::occupied));

TEST(VoxelSnapshots, NeverChangeWhileTheyAreHeld) {
    std::mt19937 random(3);
    EditedMap edited;
    editBox(edited, random, {-12, -9, -3}, {12, 11, 13});
    edited.takeChange();
    VoxelSnapshots snapshots(edited.map, UnknownPolicy::free);
    Pose T_c_w;
    do {
        T_c_w = randomPose(random);
    } while (viewOf(*snapshots.current(), T_c_w).depth.getMaxValue() == 0.F);
    std::vector<std::shared_ptr<const VoxelRenderer>> held;
    std::vector<std::shared_ptr<const View>> views;
    for (int step = 0; step < 20; ++step) {
        held.push_back(snapshots.current());
        views.push_back(std::make_shared<View>(viewOf(*held.back(), T_c_w)));
        for (int i = 0; i < 4; ++i) edit(edited, random, 12 + step);
        snapshots.update(edited.map, edited.takeChange());
        if (step % 4 == 3) {  // some are given back and used again
            held.erase(held.begin() + 1);
            views.erase(views.begin() + 1);
        }
        for (std::size_t i = 0; i < held.size(); ++i) {
            ASSERT_TRUE(areEqual(viewOf(*held[i], T_c_w), *views[i])) << step << ' ' << i;
        }
    }
    EXPECT_FALSE(areEqual(*views.front(), *views.back()));
    expectEqualViews(*snapshots.current(), VoxelRenderer(edited.map, UnknownPolicy::free), random);
}

/// A renderer that was held during several updates misses all of them when it is used again.
TEST(VoxelSnapshots, CatchUpWithAllUpdatesTheyMissed) {
    for (const int missed : {1, 2, 3, 7, 12}) {
        EditedMap edited;
        for (int y = -40; y < 40; ++y) {
            for (int x = -40; x < 40; ++x) edited.set({x, y, 0}, true, 0.5F, 63U);
        }
        edited.takeChange();
        VoxelSnapshots snapshots(edited.map, UnknownPolicy::free);
        const auto paint = [&](int square) {  // squares of 4 x 4 cells, one after the other
            for (int i = 0; i < 16; ++i) {
                edited.set({4 * square - 20 + i % 4, i / 4, 0}, true, 0.9F, 63U);
            }
            // Far out, so that the grid moves.
            edited.set({45 + 30 * square, -45 - 20 * square, 0}, true, 0.2F, 63U);
            snapshots.update(edited.map, edited.takeChange());
        };
        auto held = snapshots.current();
        for (int square = 0; square < missed; ++square) paint(square);
        held.reset();
        paint(missed);  // in the renderer that was held
        Pose T_w_c = cameraMount(std::numbers::pi / 2);
        T_w_c.translation() = Eigen::Vector3d(0.2, 0.1, 2.);
        const View expected =
            viewOf(VoxelRenderer(edited.map, UnknownPolicy::free), T_w_c.inverse());
        EXPECT_GT(expected.intensity.getMaxValue(), 0.8F);
        EXPECT_TRUE(areEqual(viewOf(*snapshots.current(), T_w_c.inverse()), expected)) << missed;
    }
}

TEST(VoxelSnapshots, OutliveTheirMaker) {
    std::mt19937 random(4);
    EditedMap edited;
    editBox(edited, random, {-12, -9, -3}, {12, 11, 13});
    auto snapshots = std::make_unique<VoxelSnapshots>(edited.map, UnknownPolicy::free);
    const auto kept = snapshots->current();
    const Pose T_c_w = randomPose(random);
    const View view = viewOf(*kept, T_c_w);
    snapshots.reset();
    EXPECT_TRUE(areEqual(viewOf(*kept, T_c_w), view));
}

TEST(VoxelSnapshots, MayBeUsedAndLeftByOtherThreads) {
    std::mt19937 random(5);
    EditedMap edited;
    editBox(edited, random, {-12, -9, -3}, {12, 11, 13});
    edited.takeChange();
    VoxelSnapshots snapshots(edited.map, UnknownPolicy::free);
    const Pose T_c_w = randomPose(random);
    for (int step = 0; step < 20; ++step) {
        std::thread viewer([held = snapshots.current(), &T_c_w]() mutable {
            const View view = viewOf(*held, T_c_w);
            EXPECT_TRUE(areEqual(viewOf(*held, T_c_w), view));
            held.reset();
        });
        edit(edited, random, 12);
        snapshots.update(edited.map, edited.takeChange());
        viewer.join();
    }
}

TEST(VoxelSnapshots, FollowFusion) {
    std::mt19937 random(6);
    EditedMap edited;
    editBox(edited, random, {-12, -9, -3}, {12, 11, 13});
    const VoxelRenderer world(edited.map, UnknownPolicy::free);
    const Camera camera = makeCamera(80, 60, 1.4);
    TexturedOcTree map(kCellSize);
    VoxelSnapshots snapshots(map, UnknownPolicy::occupied);
    for (int i = 0; i < 20; ++i) {
        const Pose T_c_w = randomPose(random);
        const MapChange change = fuse(map, viewOf(world, T_c_w), camera, T_c_w, {.minRange = 0.02});
        snapshots.update(map, change);
        const VoxelRenderer fresh(map, UnknownPolicy::occupied);
        expectEqualViews(*snapshots.current(), fresh, random);
        ASSERT_FALSE(HasFailure()) << i;
    }
}

TEST(VoxelSnapshots, RefuseChangesOfAnotherResolution) {
    const TexturedOcTree map(kCellSize);
    VoxelSnapshots snapshots(map, UnknownPolicy::free);
    MapChange change;
    change.resolution = 0.1;
    change.occupancy.emplace_back(0, 0, 0);
    EXPECT_THROW(snapshots.update(map, change), std::invalid_argument);
    EXPECT_EQ(snapshots.update(map, {}), snapshots.current());
}

}  // namespace
}  // namespace photonav
