// SPDX-License-Identifier: BSD-3-Clause
// Headings along a path: fixed, and along the motion.
#include "planners/path_headings.hpp"

#include <gtest/gtest.h>

#include "planning/fixture.hpp"

namespace photonav::test {
namespace {

using Eigen::Vector3d;

class PathHeadings : public testing::Test {
  protected:
    PathHeadings() {
        problem.kind = StateKind::positionYaw;
        problem.bounds = box({0, 0, 1}, {10, 10, 3});
        si = problem.spaceInformation();
        for (const auto& [p, yaw] : std::vector<std::pair<Vector3d, double>>{{{1., 1., 2.}, 0.3},
                                                                             {{4., 1., 2.}, 2.},
                                                                             {{4., 1., 2.5}, -1.},
                                                                             {{4., 3., 2.5}, 1.}}) {
            problem.space().setState(path.emplace_back(si->allocState()), p, yaw);
        }
    }
    ~PathHeadings() override { si->freeStates(path); }

    std::vector<std::shared_ptr<ob::State>> with(Headings headings) {
        return replaceHeadings(si, problem.space(), {path.begin(), path.end()}, headings);
    }
    double yaw(const std::shared_ptr<ob::State>& state) {
        return yawOf(problem.space().bodyPose(state.get()));
    }

    Problem problem;
    ob::SpaceInformationPtr si;
    std::vector<ob::State*> path;
};

TEST_F(PathHeadings, StayAsTheyAreAtTheStart) {
    const auto states = with(Headings::fixed);
    ASSERT_EQ(states.size(), path.size());
    for (std::size_t i = 0; i < path.size(); ++i) {
        EXPECT_EQ(problem.space().position(states[i].get()), problem.space().position(path[i]));
        EXPECT_NEAR(yaw(states[i]), 0.3, 1e-12);
    }
}

TEST_F(PathHeadings, LieAlongTheMotionAfterATurnOnTheSpot) {
    const auto states = with(Headings::forward);
    const double left = std::numbers::pi / 2;
    const std::vector<std::pair<Vector3d, double>> expected{
        {{1., 1., 2.}, 0.3}, {{1., 1., 2.}, 0.},    {{4., 1., 2.}, 0.},
        {{4., 1., 2.5}, 0.}, {{4., 1., 2.5}, left}, {{4., 3., 2.5}, left}};
    ASSERT_EQ(states.size(), expected.size());
    for (std::size_t i = 0; i < expected.size(); ++i) {
        EXPECT_EQ(problem.space().position(states[i].get()), expected[i].first) << i;
        EXPECT_NEAR(yaw(states[i]), expected[i].second, 1e-12) << i;
    }
}

/// A robot that flies beside its plan goes back to it by a few centimetres, whatever its heading.
TEST_F(PathHeadings, AreNotThoseOfAFewCentimetres) {
    problem.space().setState(path[0], {4.05, 1.02, 2.}, 0.3);
    const auto states = with(Headings::forward);
    EXPECT_NEAR(yaw(states[1]), 0.3, 1e-12);
    EXPECT_NEAR(yaw(states.back()), std::numbers::pi / 2, 1e-12);
}

TEST_F(PathHeadings, NeedASpaceThatHasThem) {
    const Problem flat;
    EXPECT_THROW(replaceHeadings(flat.spaceInformation(), flat.space(), {path.begin(), path.end()},
                                 Headings::fixed),
                 std::invalid_argument);
}

}  // namespace
}  // namespace photonav::test
