// SPDX-License-Identifier: BSD-3-Clause
#include "replanning/flyable_part.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "geometry/se3.hpp"

namespace photonav {
namespace {

using Eigen::Vector3d;

/// A straight path of 4 m along x.
std::vector<PlannedView> straightPath(double yaw) {
    std::vector<PlannedView> path;
    for (int i = 0; i <= 8; ++i) {
        PlannedView point;
        point.T_w_b = levelPose({0.5 * i, 0., 1.}, yaw);
        point.distance = 0.5 * i;
        path.push_back(point);
    }
    return path;
}

SpaceAhead openSpace() {
    return {.clearance = [](const Vector3d&) { return 1.; },
            .isSeen = [](const Vector3d&) { return true; },
            .radius = 0.3,
            .hidden = 0.3,
            .canLook = true};
}

double endOf(const FlyablePart& way) { return way.plan.back().T_w_b.translation().x(); }

TEST(FlyablePart, IsThePathWhereAllOfItWasSeenAndIsFree) {
    const FlyablePart way = flyablePart(straightPath(0.), openSpace());
    EXPECT_TRUE(way.isWhole);
    EXPECT_EQ(endOf(way), 4.);
}

TEST(FlyablePart, EndsBeforeWhatWasNotSeen) {
    SpaceAhead space = openSpace();
    space.isSeen = [](const Vector3d& p_w) { return p_w.x() < 2.; };
    const FlyablePart way = flyablePart(straightPath(0.), space);
    EXPECT_FALSE(way.isWhole || way.isBlind);
    EXPECT_NEAR(endOf(way), 1.7, 0.06);
    EXPECT_TRUE(way.plan.back().isWaypoint);
    EXPECT_NEAR(way.plan.back().distance, endOf(way), 1e-9);
    EXPECT_EQ(way.plan.size(), 5U);  // at 0, 0.5, 1 and 1.5 m, and at the end
}

/// A robot is as wide as twice its radius.
TEST(FlyablePart, BothSidesMustHaveBeenSeen) {
    for (const double side : {-1., 1.}) {
        SpaceAhead space = openSpace();
        space.isSeen = [&](const Vector3d& p_w) { return p_w.x() < 2. || side * p_w.y() < 0.2; };
        EXPECT_NEAR(endOf(flyablePart(straightPath(0.), space)), 1.7, 0.06) << side;
        space.isSeen = [&](const Vector3d& p_w) { return side * p_w.y() < 0.25; };
        EXPECT_TRUE(flyablePart(straightPath(0.), space).isWhole) << side;
    }
}

/// A tilted camera does not see the places beside and behind the robot: where it can be turned, it
/// is, and else a robot could not fly there.
TEST(FlyablePart, NeedNotBeSeenRightAroundARobotThatCannotLook) {
    SpaceAhead space = openSpace();
    space.isSeen = [](const Vector3d& p_w) { return p_w.norm() > 1.15; };  // 0.57 m around it
    const FlyablePart look = flyablePart(straightPath(2.), space);
    EXPECT_EQ(endOf(look), 0.);
    EXPECT_TRUE(look.isLook);
    EXPECT_NEAR(yawOf(look.plan.back().T_w_b), -std::atan2(0.24, 0.18), 0.02);
    space.canLook = false;
    EXPECT_TRUE(flyablePart(straightPath(0.), space).isWhole);
    space.hidden = 0.2;
    EXPECT_FALSE(flyablePart(straightPath(0.), space).isWhole);
}

TEST(FlyablePart, TurnsToLookFirst) {
    SpaceAhead space = openSpace();
    space.isSeen = [](const Vector3d& p_w) { return p_w.x() < 0.4; };
    const FlyablePart way = flyablePart(straightPath(2.), space);
    EXPECT_EQ(endOf(way), 0.);
    EXPECT_NEAR(yawOf(way.plan.back().T_w_b), 0., 1e-9);
    EXPECT_TRUE(way.isLook);
    EXPECT_FALSE(way.isBlind);
    EXPECT_FALSE(flyablePart(straightPath(0.), space).isLook);
    // Where it looks there already, or cannot, it takes a short step.
    EXPECT_NEAR(endOf(flyablePart(straightPath(0.), space)), 0.12, 0.02);
    space.canLook = false;
    EXPECT_NEAR(endOf(flyablePart(straightPath(2.), space)), 0.3, 0.06);
}

/// A robot that flew up to the end of what it has seen with its back to it would stop there to
/// turn.
TEST(FlyablePart, TurnsOnTheWayToHaveInViewWhatWasNotSeen) {
    SpaceAhead space = openSpace();
    space.isSeen = [](const Vector3d& p_w) { return p_w.x() < 3.3; };
    space.inView = 0.5;
    space.turnPerMetre = 1.;
    const FlyablePart way = flyablePart(straightPath(2.), space);
    EXPECT_NEAR(endOf(way), 3., 0.06);
    for (const PlannedView& view : way.plan) {
        const double rest = endOf(way) - view.T_w_b.translation().x();
        EXPECT_NEAR(yawOf(view.T_w_b), std::min(2., 0.5 + rest), 0.05) << rest;
    }
    space.canLook = false;
    EXPECT_NEAR(yawOf(flyablePart(straightPath(2.), space).plan.back().T_w_b), 2., 1e-9);
}

/// Planned headings that pass the direction away from the place do not turn the robot to and fro.
TEST(FlyablePart, TurnsOnTheWayByOneSide) {
    SpaceAhead space = openSpace();
    space.isSeen = [](const Vector3d& p_w) { return p_w.x() < 3.3; };
    space.inView = 0.5;
    space.turnPerMetre = 1.;
    std::vector<PlannedView> plan = straightPath(0.);
    for (std::size_t i = 0; i < plan.size(); ++i) {
        plan[i].T_w_b = levelPose({plan[i].distance, 0., 1.}, 2.6 + 0.2 * static_cast<double>(i));
    }
    plan.insert(plan.begin(), plan.front());  // plans begin with two views at the robot's pose
    const FlyablePart way = flyablePart(plan, space);
    EXPECT_EQ(yawOf(way.plan[1].T_w_b), yawOf(way.plan[0].T_w_b)) << "it begins as it is turned";
    for (std::size_t i = 2; i < way.plan.size(); ++i) {
        EXPECT_LE(yawOf(way.plan[i].T_w_b), yawOf(way.plan[i - 1].T_w_b) + 0.21);
        EXPECT_GT(yawOf(way.plan[i].T_w_b), 0.45);
    }
    EXPECT_NEAR(yawOf(way.plan.back().T_w_b), 0.5, 0.05);
}

/// It keeps its heading before an obstacle, which it has seen.
TEST(FlyablePart, DoesNotTurnToAnObstacle) {
    SpaceAhead space = openSpace();
    space.clearance = [](const Vector3d& p_w) { return 3. - p_w.x(); };
    const FlyablePart way = flyablePart(straightPath(2.), space);
    EXPECT_LT(endOf(way), 3.);
    EXPECT_NEAR(yawOf(way.plan.back().T_w_b), 2., 1e-9);
}

/// A camera that looks along the path does not see what is right beside its begin.
TEST(FlyablePart, LooksAtThePlaceThatWasNotSeen) {
    SpaceAhead space = openSpace();
    for (const double side : {-1., 1.}) {
        space.isSeen = [&](const Vector3d& p_w) { return side * p_w.y() < 0.2 || p_w.x() > 0.4; };
        const FlyablePart way = flyablePart(straightPath(0.), space);
        EXPECT_TRUE(way.isLook);
        EXPECT_NEAR(yawOf(way.plan.back().T_w_b), side * std::atan2(0.24, 0.2), 0.1);
        EXPECT_TRUE(flyablePart(straightPath(side * 0.9), space).isBlind);
    }
}

TEST(FlyablePart, DoesNotLookBeyondAnObstacle) {
    SpaceAhead space = openSpace();
    space.isSeen = [](const Vector3d& p_w) { return p_w.x() < 0.6; };
    EXPECT_EQ(endOf(flyablePart(straightPath(2.), space)), 0.);
    space.clearance = [](const Vector3d& p_w) { return 0.76 - p_w.x(); };
    const FlyablePart way = flyablePart(straightPath(2.), space);
    EXPECT_NEAR(endOf(way), 0.2, 1e-9);
    EXPECT_NEAR(yawOf(way.plan.back().T_w_b), 2., 1e-9);
}

TEST(FlyablePart, IsABlindStepWhereNothingIsSeenAndNothingCanBe) {
    SpaceAhead space = openSpace();
    space.isSeen = [](const Vector3d&) { return false; };
    space.hidden = 0.;
    space.canLook = false;
    const FlyablePart way = flyablePart(straightPath(0.), space);
    EXPECT_TRUE(way.isBlind);
    EXPECT_NEAR(endOf(way), 0.15, 1e-9);
    // But not nearer to an obstacle than the robot's radius.
    space.clearance = [](const Vector3d& p_w) { return 0.66 - p_w.x(); };
    const FlyablePart shorter = flyablePart(straightPath(0.), space);
    EXPECT_TRUE(shorter.isBlind);
    EXPECT_NEAR(endOf(shorter), 0.11, 0.01);
}

TEST(FlyablePart, NeverLeadsIntoAnObstacle) {
    SpaceAhead space = openSpace();
    space.clearance = [](const Vector3d& p_w) { return 2.5 - p_w.x(); };
    const FlyablePart way = flyablePart(straightPath(0.), space);
    EXPECT_FALSE(way.isWhole || way.isStopped);
    EXPECT_NEAR(endOf(way), 1.95, 0.06);
    space.clearance = [](const Vector3d& p_w) { return 0.35 - p_w.x(); };
    EXPECT_EQ(endOf(flyablePart(straightPath(0.), space)), 0.);
    EXPECT_TRUE(flyablePart(straightPath(0.), space).isStopped);
    // A robot that is too near may fly away, but not nearer.
    space.clearance = [](const Vector3d& p_w) { return 0.2 + p_w.x(); };
    EXPECT_TRUE(flyablePart(straightPath(0.), space).isWhole);
    space.clearance = [](const Vector3d& p_w) { return 0.2 - p_w.x(); };
    EXPECT_EQ(endOf(flyablePart(straightPath(0.), space)), 0.);
}

/// Of a plan of 4 m along x for a robot that is now half a metre along it and somewhat beside it.
TEST(ContinuedFrom, LeadsToTheNearestPlaceAndOn) {
    Pose here = Pose::Identity();
    here.translation() << 0.7, 0.1, 1.;
    const std::vector<PlannedView> rest = continuedFrom(here, straightPath(0.));
    ASSERT_EQ(rest.size(), 9U);  // here, beside here, and at 1, 1.5, ... 4 m
    EXPECT_TRUE(rest.front().T_w_b.isApprox(here));
    EXPECT_EQ(rest.front().distance, 0.);
    EXPECT_TRUE(rest[1].T_w_b.translation().isApprox(Vector3d(0.7, 0., 1.), 1e-9));
    EXPECT_NEAR(rest[1].distance, 0.1, 1e-9);
    EXPECT_NEAR(rest[2].distance, 0.4, 1e-9);
    EXPECT_NEAR(rest.back().distance, 3.4, 1e-9);
    EXPECT_TRUE(rest.back().isWaypoint == straightPath(0.).back().isWaypoint);
}

/// A plan may come back to where it began: what lies in between is not left out.
TEST(ContinuedFrom, LeavesOutNoMoreThanWasFlown) {
    std::vector<PlannedView> plan = straightPath(0.);
    for (int i = 7; i >= 0; --i) {
        PlannedView back = plan[static_cast<std::size_t>(i)];
        back.distance = 8. - back.distance;
        plan.push_back(back);
    }
    Pose here = Pose::Identity();
    here.translation() << 0.3, 0., 1.;
    EXPECT_NEAR(continuedFrom(here, plan).back().distance, 7.7, 1e-9);
}

TEST(ContinuedFrom, TurnsWhereTheRobotIs) {
    const PlannedView begin = straightPath(0.).front(), end = straightPath(2.).front();
    Pose here = Pose::Identity();
    here.translation() << 0.4, 0.2, 1.;
    const std::vector<PlannedView> turn = continuedFrom(here, {begin, end});
    ASSERT_EQ(turn.size(), 2U);
    EXPECT_EQ(turn.back().T_w_b.translation(), here.translation());
    EXPECT_NEAR(yawOf(turn.back().T_w_b), 2., 1e-9);
    EXPECT_EQ(turn.back().distance, 0.);
}

TEST(ContinuedFrom, IsThePlanWhereTheRobotHasNotMoved) {
    const std::vector<PlannedView> plan = straightPath(0.5);
    const std::vector<PlannedView> rest = continuedFrom(plan.front().T_w_b, plan);
    ASSERT_EQ(rest.size(), plan.size());
    for (std::size_t i = 0; i < plan.size(); ++i) {
        EXPECT_EQ(rest[i].T_w_b.matrix(), plan[i].T_w_b.matrix());
    }
}

}  // namespace
}  // namespace photonav
