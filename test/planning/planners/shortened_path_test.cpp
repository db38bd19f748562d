// SPDX-License-Identifier: BSD-3-Clause
// Paths of RRT*, smoothed.
#include "planners/shortened_path.hpp"

#include <gtest/gtest.h>

#include "planning/fixture.hpp"

namespace photonav::test {
namespace {

using Eigen::Vector3d;

class ShortenedPath : public testing::Test {
  protected:
    ShortenedPath() {
        problem.bounds = box({0, 0, 2}, {10, 10, 2});
        // a wall from the lower side, at x = 5, up to y = 4
        problem.clearance = [](const Vector3d& p) {
            return std::hypot(p.x() - 5., std::max(0., p.y() - 4.));
        };
        si = problem.spaceInformation();
        for (const Vector3d& p : {Vector3d(1., 1., 2.), Vector3d(2., 6., 2.), Vector3d(3., 7., 2.),
                                  Vector3d(6., 8., 2.), Vector3d(9., 1., 2.)}) {
            problem.space().setState(path.emplace_back(si->allocState()), p, 0.);
        }
    }
    ~ShortenedPath() override { si->freeStates(path); }

    ompl::geometric::PathGeometric with(unsigned changes) {
        return shortenPath(si, problem.space(), path, changes,
                           ob::plannerNonTerminatingCondition());
    }

    Problem problem;
    ob::SpaceInformationPtr si;
    std::vector<ob::State*> path;
};

TEST_F(ShortenedPath, IsNearlyTheShortestWayAroundTheWall) {
    auto shortest = with(1000);
    EXPECT_TRUE(shortest.check());
    EXPECT_TRUE(si->equalStates(shortest.getStates().front(), path.front()));
    EXPECT_TRUE(si->equalStates(shortest.getStates().back(), path.back()));
    // Around a circle of the robot's radius at the end of the wall; at least straight to it.
    const double straight = 2. * std::hypot(4., 3.);
    EXPECT_GT(shortest.length(), straight);
    EXPECT_LT(shortest.length(), straight + 2.5 * 0.2);
}

TEST_F(ShortenedPath, IsTheSameEveryTimeAndStaysWithoutChanges) {
    EXPECT_EQ(with(200).length(), with(200).length());
    EXPECT_EQ(with(0).getStateCount(), path.size());
}

}  // namespace
}  // namespace photonav::test
