// SPDX-License-Identifier: BSD-3-Clause
// Samples in the parts of a space that an update concerns.
#include "planners/updated_space.hpp"

#include <gtest/gtest.h>

#include "planning/fixture.hpp"

namespace photonav::test {
namespace {

using Eigen::Vector3d;

class UpdatedSpaceTest : public testing::Test {
  protected:
    UpdatedSpaceTest() : space(problem.space()), updated(problem.spaceInformation(), space) {
        rng.setLocalSeed(3);
    }

    /// Positions of 200 samples; where none is drawn in a part, it is left out.
    std::vector<Vector3d> draw(const SampleShares& shares) {
        ob::ScopedState<> state(space.space());
        std::vector<Vector3d> positions;
        for (int i = 0; i < 200; ++i) {
            if (updated.sample(state.get(), shares, 0.5, *sampler, rng)) {
                positions.push_back(space.position(state.get()));
            }
        }
        return positions;
    }

    void remove(const Vector3d& p_w) {
        ob::ScopedState<> state(space.space());
        space.setState(state.get(), p_w, 0.);
        updated.addRemoved(state.get());
    }

    static MapChange changeAt(int x, int y) {
        MapChange change{.resolution = 0.1};
        change.occupancy.emplace_back(x, y, 4);  // z from 1.6 to 2.0
        change.occupancy.emplace_back(x, y, 5);
        return change;
    }

    Problem problem;
    FlightSpace space;
    UpdatedSpace updated;
    ob::StateSamplerPtr sampler = space.sampler(5);
    ompl::RNG rng;
};

TEST_F(UpdatedSpaceTest, DrawsEverywhereAsLongAsNothingHasChanged) {
    EXPECT_TRUE(draw({.removed = 0.6, .changed = 0.4}).empty());
}

TEST_F(UpdatedSpaceTest, DrawsNearTheVerticesThatWereRemoved) {
    remove({2., 2., 2.});
    remove({7., 5., 2.});
    const auto samples = draw({.removed = 1.});
    EXPECT_EQ(samples.size(), 200U);
    int first = 0;
    for (const Vector3d& p : samples) {
        const double toFirst = (p - Vector3d(2., 2., 2.)).norm();
        EXPECT_LE(std::min(toFirst, (p - Vector3d(7., 5., 2.)).norm()), 0.8);
        first += toFirst < 1. ? 1 : 0;
    }
    EXPECT_NEAR(first, 100, 30);
    updated.clear();
    EXPECT_TRUE(draw({.removed = 1.}).empty());
}

TEST_F(UpdatedSpaceTest, DrawsWhereTheMapChangedIfTheRobotCanBeThere) {
    updated.addChange(changeAt(5, 5));
    updated.addChange(changeAt(500, 5));  // out of bounds
    for (const Vector3d& p : draw({.changed = 1.})) {
        EXPECT_TRUE(box({2., 2., 2.}, {2.4, 2.4, 2.}).contains(p)) << p.transpose();
    }
    EXPECT_EQ(draw({.changed = 1.}).size(), 200U);
    const auto some = draw({.removed = 0.5, .changed = 0.25});
    EXPECT_NEAR(double(some.size()), 50., 25.);  // nothing was removed: its share is everywhere

    problem.clearance = [](const Vector3d& p) { return p.x() < 3. ? 0. : 1.; };
    UpdatedSpace blocked(problem.spaceInformation(), space);
    blocked.addChange(changeAt(5, 5));
    ob::ScopedState<> state(space.space());
    EXPECT_FALSE(blocked.sample(state.get(), {.changed = 1.}, 0.5, *sampler, rng));
}

TEST_F(UpdatedSpaceTest, KeepsTheLatestOfManyRemovedVertices) {
    for (int i = 0; i < 30000; ++i) remove({i < 20000 ? 2. : 8., 2., 2.});
    int old = 0;
    for (const Vector3d& p : draw({.removed = 1.})) old += p.x() < 5. ? 1 : 0;
    EXPECT_NEAR(old, 100, 30);
}

}  // namespace
}  // namespace photonav::test
