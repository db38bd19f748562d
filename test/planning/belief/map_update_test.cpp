// SPDX-License-Identifier: BSD-3-Clause
// Information that follows a map: entries that a change of the map can have touched are renewed,
// and no others.
#include <gtest/gtest.h>

#include <cstdio>
#include <random>

#include "geometry/se3.hpp"
#include "planning/belief/fields.hpp"
#include "planning/fixture.hpp"
#include "planning/planners/changing_world.hpp"
#include "render/voxel_renderer.hpp"

namespace photonav::test {
namespace {

using Eigen::Array3i;
using Eigen::Vector3d;

constexpr double kCell = 0.05;
const Array3i kSize(80, 64, 36);  // cells of the room

/// A room with a wall across its middle, clutter, and parts that are unknown, changed at random.
class ChangingRoom {
  public:
    explicit ChangingRoom(unsigned seed) : map(kCell), random_(seed) {
        for (int z = 0; z < kSize.z(); ++z) {
            for (int y = 0; y < kSize.y(); ++y) {
                for (int x = 0; x < kSize.x(); ++x) {
                    const Array3i cell(x, y, z);
                    const bool outside = (cell == 0).any() || (cell == kSize - 1).any();
                    const bool wall = x == 40 && y < 44;
                    if (outside || wall || dice() < 0.0003) {
                        set(cell, true);
                    } else if (dice() < 0.9995) {
                        set(cell, false);
                    }
                }
            }
        }
        map.updateInnerOccupancy();
    }

    /// Changes a box of at most 6 cells: everything occupied, everything free, or new grey values.
    MapChange change() {
        Array3i low, high;
        for (int i = 0; i < 3; ++i) {
            low[i] = static_cast<int>(dice() * (kSize[i] - 1));
            high[i] = std::min(kSize[i] - 1, low[i] + static_cast<int>(dice() * 6.));
        }
        const int kind = static_cast<int>(3. * dice());
        MapChange change;
        change.resolution = kCell;
        for (int z = low.z(); z <= high.z(); ++z) {
            for (int y = low.y(); y <= high.y(); ++y) {
                for (int x = low.x(); x <= high.x(); ++x) {
                    const Array3i brick(x / 4, y / 4, z / 4);
                    if (kind < 2 && isOccupied({x, y, z}) != (kind == 0)) {
                        set({x, y, z}, kind == 0);
                        change.occupancy.push_back(brick);
                    } else if (kind == 2 && isOccupied({x, y, z})) {
                        set({x, y, z}, true);
                        change.texture.push_back(brick);
                    }
                }
            }
        }
        map.updateInnerOccupancy();
        change.normalize();
        return change;
    }

    /// A body pose in a free cell.
    Pose freePose() {
        Array3i cell;
        do {
            for (int i = 0; i < 3; ++i) cell[i] = static_cast<int>(dice() * kSize[i]);
        } while (isOccupied(cell));
        return levelPose(kCell * (cell.cast<double>().matrix() + Vector3d::Constant(0.5)),
                         6.28 * dice());
    }

    TexturedOcTree map;

  private:
    static octomap::OcTreeKey key(const Array3i& cell) {
        const Array3i k = cell + kKeyOfZero;
        return {static_cast<octomap::key_type>(k.x()), static_cast<octomap::key_type>(k.y()),
                static_cast<octomap::key_type>(k.z())};
    }
    double dice() { return std::uniform_real_distribution<>(0., 1.)(random_); }
    bool isOccupied(const Array3i& cell) const {
        const auto* node = map.search(key(cell));
        return node != nullptr && map.isNodeOccupied(node);
    }
    void set(const Array3i& cell, bool occupied) {
        auto* node = map.setNodeValue(key(cell), occupied ? 1.F : -1.F, true);
        if (!occupied) return;
        for (FaceTexture& face : node->faces) face = {static_cast<float>(dice()), 1.F};
    }

    std::mt19937 random_;
};

struct Marks {
    std::size_t stale = 0;     ///< entries that an update marked
    std::size_t needless = 0;  ///< of them, those that are as before
    std::size_t entries = 0;   ///< entries that were not stale, over all updates
};

/// Follows random changes; entries that are not stale have to equal fresh ones.
void follow(UnknownPolicy unknown, double belowHorizon, Marks& marks) {
    ChangingRoom room(7);
    std::vector<Pose> poses;
    for (int i = 0; i < 60; ++i) poses.push_back(room.freePose());
    const auto field = fieldOf(std::make_shared<VoxelRenderer>(room.map, unknown), belowHorizon);
    const Entries entries = entriesAt(poses, *field);
    for (int round = 0; round < 30; ++round) {
        MapChange change = room.change();
        if (round % 3 == 0) change.join(room.change());
        marks.entries += field->size() - field->stale();
        const auto views = std::make_shared<VoxelRenderer>(room.map, unknown);
        const std::size_t before = field->marked() - field->stale();
        field->update(views, change);
        EXPECT_EQ(field->marked() - field->stale(), before);
        const auto fresh = fieldOf(views, belowHorizon);
        for (std::size_t i = 0; i < poses.size(); ++i) {
            const bool isSame = entries[i]->information == fresh->at(poses[i]).information;
            if (!entries[i]->isStale) {
                ASSERT_TRUE(isSame) << "round " << round << ", entry " << i;
            }
            marks.stale += entries[i]->isStale ? 1 : 0;
            marks.needless += entries[i]->isStale && isSame ? 1 : 0;
        }
        for (std::size_t i = 0; i < poses.size(); ++i) {
            const auto& again =
                i % 2 == 0 ? field->at(poses[i]) : field->current(*entries[i]);  // in place
            ASSERT_EQ(&again, entries[i]);
            ASSERT_FALSE(again.isStale);
            ASSERT_EQ(again.information, fresh->at(poses[i]).information);
        }
    }
}

class FieldOverAMap : public testing::TestWithParam<UnknownPolicy> {};
INSTANTIATE_TEST_SUITE_P(Unknown, FieldOverAMap,
                         testing::Values(UnknownPolicy::free, UnknownPolicy::occupied));

TEST_P(FieldOverAMap, EntriesThatAreNotStaleEqualFreshOnes) {
    Marks marks;
    for (const double belowHorizon : {0., std::numbers::pi / 4, std::numbers::pi / 2}) {
        follow(GetParam(), belowHorizon, marks);
    }
    const double share = double(marks.stale) / double(marks.entries);
    const double needless = double(marks.needless) / double(marks.stale);
    std::printf("marked stale: %.1f %% of the entries, %.1f %% of them without need\n",
                100. * share, 100. * needless);
    EXPECT_LT(share, 0.15);
    EXPECT_LT(needless, 0.6);  // bricks are as large as a change here, and grow by two cells
}

/// A motion that was given up, and one that was flown the other way before, see the map as it is.
TEST(FieldUpdate, MotionsThatAreFlownAgainSeeTheMapAsItIs) {
    for (const bool wasGivenUp : {false, true}) {
        test::ChangingWorld world(test::problemIn(test::SceneKind::flat).bounds);
        std::mt19937 random(3);
        std::uniform_real_distribution<float> grey(0.F, 1.F);
        world.paintFloor(test::kFloor, [&] { return grey(random); });
        const FlightSpace space(StateKind::position, test::box({0, 0, 2}, {8, 8, 2}));
        const auto field = fieldOf(world.freshViews(), std::numbers::pi / 2);
        BeliefModel model(space, field, test::Problem::defaultBelief());
        ompl::base::ScopedState<> a(space.space()), b(space.space());
        space.setState(a.get(), {1., 1., 2.}, 0.);
        space.setState(b.get(), {5., 1., 2.}, 0.);
        const Belief root = model.root(a.get());
        Motion other = model.motion(a.get(), b.get()), motion = other;
        const double limit = (1. - 1e-6) * model.propagate(root, other).cost;
        EXPECT_NE(model.propagateWithin(wasGivenUp ? limit : kInfinity, root, motion).has_value(),
                  wasGivenUp);
        const MapChange change = world.paintFloor(test::kFloor, [&] { return grey(random); });
        field->update(world.freshViews(), change);
        for (const bool backward : {false, true}) {
            const auto freshField = fieldOf(world.freshViews(), std::numbers::pi / 2);
            BeliefModel freshModel(space, freshField, test::Problem::defaultBelief());
            Motion fresh = freshModel.motion(a.get(), b.get());
            EXPECT_EQ(model.propagate(root, motion, backward).cost,
                      freshModel.propagate(root, fresh, backward).cost);
        }
    }
}

/// Each update renders a share of what changed; after as many as there are turns all is as new.
TEST(FieldUpdate, EntriesThatTakeTurnsAreAllRenewed) {
    constexpr unsigned kTurns = 3;
    ChangingRoom room(7);
    const Camera camera = makeCamera(94, 60, 1.2);
    const auto field = [&](const std::shared_ptr<const ViewSource>& views, unsigned turns) {
        return InformationField(views, camera, photometricModel(camera, {}), cameraMount(0.8),
                                {.positionPitch = 1e-3, .updatesUntilStale = turns});
    };
    const auto viewsNow = [&] {
        return std::make_shared<VoxelRenderer>(room.map, UnknownPolicy::free);
    };
    InformationField inTurns = field(viewsNow(), kTurns), atOnce = field(viewsNow(), 1);
    std::vector<Pose> poses;
    for (int i = 0; i < 90; ++i) poses.push_back(room.freePose());
    for (const Pose& pose : poses) {
        inTurns.at(pose);
        atOnce.at(pose);
    }
    MapChange change;
    for (int i = 0; i < 10; ++i) change.join(room.change());
    const auto views = viewsNow();
    atOnce.update(views, change);
    std::size_t renewed = 0;
    for (unsigned turn = 0; turn < kTurns; ++turn) {
        inTurns.update(views, turn == 0 ? change : MapChange{});
        EXPECT_LT(inTurns.stale(), atOnce.stale());
        renewed += inTurns.stale();
        for (const Pose& pose : poses) inTurns.at(pose);
    }
    EXPECT_GT(renewed, 2 * kTurns);
    EXPECT_EQ(renewed, atOnce.stale());
    EXPECT_EQ(inTurns.marked(), atOnce.marked());
    for (const Pose& pose : poses) {
        EXPECT_EQ(inTurns.at(pose).information, atOnce.at(pose).information);
    }
}

TEST(FieldUpdate, AnObstacleWhereNoSurfaceWasMakesAViewStale) {
    TexturedOcTree map(0.1);
    const auto set = [&](int x, int y, int z, float grey) {
        const auto key = [](int i) { return static_cast<octomap::key_type>(kKeyOfZero + i); };
        auto* node = map.setNodeValue(octomap::OcTreeKey(key(x), key(y), key(z)), 1.F, true);
        for (FaceTexture& face : node->faces) face = {grey, 1.F};
    };
    set(-20, 0, 0, 0.5F);  // behind the camera
    map.updateInnerOccupancy();
    const auto field = fieldOf(std::make_shared<VoxelRenderer>(map, UnknownPolicy::free), 0.);
    const InformationField::Entry& entry = field->at(Pose::Identity());
    EXPECT_TRUE(entry.isZero);
    MapChange change;
    change.resolution = 0.1;
    for (int z = -8; z < 8; ++z) {
        for (int y = -8; y < 8; ++y) set(20, y, z, (y + z) % 2 == 0 ? 0.2F : 0.8F);
    }
    map.updateInnerOccupancy();
    for (int z = -2; z < 2; ++z) {
        for (int y = -2; y < 2; ++y) change.occupancy.emplace_back(5, y, z);
    }
    field->update(std::make_shared<VoxelRenderer>(map, UnknownPolicy::free), change);
    EXPECT_TRUE(entry.isStale);
    EXPECT_FALSE(field->current(entry).isZero);
}

TEST(FieldUpdate, GreyValuesJustOutsideTheImageCount) {
    // At the image's border grey values are interpolated with those of cells that no ray meets.
    TexturedOcTree map(kCell);
    const auto set = [&](int y, int z, float grey) {
        const auto key = [](int i) { return static_cast<octomap::key_type>(kKeyOfZero + i); };
        auto* node = map.setNodeValue(octomap::OcTreeKey(key(20), key(y), key(z)), 1.F, true);
        for (FaceTexture& face : node->faces) face = {grey, 1.F};
    };
    const int reach = 48;  // a wall across the camera's axis
    for (int z = -reach; z < reach; ++z) {
        for (int y = -reach; y < reach; ++y) set(y, z, (y * 7 + z * 3) % 5 < 2 ? 0.2F : 0.7F);
    }
    map.updateInnerOccupancy();
    const auto views = [&] { return std::make_shared<VoxelRenderer>(map, UnknownPolicy::free); };
    std::vector<Pose> poses(8, Pose::Identity());
    for (int i = 0; i < 8; ++i) poses[i].translation().y() = kCell * i / 2.;
    int touched = 0;
    for (int brick = -reach / 4; brick < reach / 4; ++brick) {  // a column of bricks at a time
        const auto field = fieldOf(views(), 0.);
        const Entries entries = entriesAt(poses, *field);
        MapChange change;
        change.resolution = kCell;
        for (int z = -reach; z < reach; ++z) {
            for (int i = 0; i < 4; ++i) set(4 * brick + i, z, (z + brick) % 2 == 0 ? 0.1F : 0.9F);
            change.texture.emplace_back(5, brick, z >> 2);
        }
        map.updateInnerOccupancy();
        change.normalize();
        field->update(views(), change);
        const auto fresh = fieldOf(views(), 0.);
        for (std::size_t i = 0; i < poses.size(); ++i) {
            const bool isSame = entries[i]->information == fresh->at(poses[i]).information;
            EXPECT_TRUE(isSame || entries[i]->isStale) << "bricks " << brick << ", pose " << i;
            touched += isSame ? 0 : 1;
        }
    }
    EXPECT_GT(touched, 20);
}

TEST(FieldUpdate, MotionsTakeUpWhatTheMapHasBecome) {
    // Grey values on the floor appear: a motion propagated before informs as a new one does.
    TexturedOcTree map(0.1);
    const auto setFloor = [&](float contrast) {
        for (int y = 0; y < 40; ++y) {
            for (int x = 0; x < 40; ++x) {
                const octomap::OcTreeKey key(kKeyOfZero + x, kKeyOfZero + y, kKeyOfZero);
                auto* node = map.setNodeValue(key, 1.F, true);
                const float grey = 0.5F + contrast * static_cast<float>((5 * x + 3 * y) % 7 - 3);
                for (FaceTexture& face : node->faces) face = {grey, 1.F};
            }
        }
        map.updateInnerOccupancy();
    };
    setFloor(0.F);
    const Camera camera = makeCamera(94, 60, 1.2);
    const auto views = [&] { return std::make_shared<VoxelRenderer>(map, UnknownPolicy::free); };
    Problem problem;
    const auto field = std::make_shared<InformationField>(
        views(), camera, photometricModel(camera, {}), problem.mount, InformationField::Options{});
    BeliefModel model(problem.space(), field, problem.belief);
    ob::ScopedState<> from(problem.space().space());
    ob::ScopedState<> to(problem.space().space());
    problem.space().setState(from.get(), {1., 2., 2.}, 0.);
    problem.space().setState(to.get(), {3., 2., 2.}, 0.);
    Motion motion = model.motion(from.get(), to.get());
    const Belief root = model.root(from.get());
    const Belief before = model.propagate(root, motion);

    setFloor(0.05F);
    MapChange change;
    change.resolution = 0.1;
    for (int y = 0; y < 10; ++y) {
        for (int x = 0; x < 10; ++x) change.texture.push_back({x, y, 0});
    }
    change.normalize();
    field->update(views(), change);
    EXPECT_EQ(field->stale(), field->size());
    const Belief after = model.propagate(root, motion);
    EXPECT_LT(after.covariance.trace(), 0.1 * before.covariance.trace());
    Motion fresh = model.motion(from.get(), to.get());
    EXPECT_EQ(model.propagate(root, fresh).covariance, after.covariance);
    EXPECT_EQ(motion.epoch, field->epoch());
    EXPECT_EQ(motion.views.back()->epoch, field->epoch());
}

TEST(FieldUpdate, LeavesFormulasAlone) {
    InformationField field(stripesThenTexture, cameraMount(0.), {});
    Pose T_w_b = Pose::Identity();
    const auto& entry = field.at(T_w_b);
    MapChange change;
    change.resolution = 1.;
    change.occupancy.emplace_back(0, 0, 0);
    field.update(nullptr, change);
    EXPECT_FALSE(entry.isStale);
}

}  // namespace
}  // namespace photonav::test
