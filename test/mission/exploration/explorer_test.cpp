// SPDX-License-Identifier: BSD-3-Clause
#include "exploration/explorer.hpp"

#include <gtest/gtest.h>

#include "geometry/constants.hpp"
#include "mission/exploration/room_to_explore.hpp"
#include "mission/obedient_robot.hpp"
#include "problem/world.hpp"
#include "render/voxel_grid.hpp"

namespace photonav {
namespace {

/// Explored without the simulation: only this test knows where the robot is.
class ExplorerTest : public ::testing::Test {
  protected:
    ExplorerTest() {
        config.planner = "rrt_star";
        config.goal.position.x() = 3.;
        config.explore.vertices = 100;
    }

    test::ObedientRobot robotIn(const World& world) const {
        return {world.sharedViews(), config.camera.camera(), config.camera.T_b_c(),
                config.start.position, 0.2};
    }

    ExplorationOutcome explored(test::ObedientRobot& robot, const OnFlightStep& onStep = {}) const {
        ExplorerOptions options = explorerOptions(config);
        options.timeStep = 0.05;
        options.pilot.route.responseTime = 0.;  // of an obedient robot
        return explore(robot, options, config.planner, 1, kNotInterrupted, {}, onStep);
    }

    Config config = test::flightThroughRoom();
};

TEST_F(ExplorerTest, ExploresWithAnyRobot) {
    config.goal.position.x() = 7.;
    const World world(test::roomToExplore(), config);
    test::ObedientRobot robot = robotIn(world);
    double leastClearance = kInfinity;
    const auto onStep = [&](const Observation&, const std::vector<TrackedFrame>&) {
        leastClearance = std::min(leastClearance, world.clearance(robot.T_w_b.translation()));
        return true;
    };
    const ExplorationOutcome outcome = explored(robot, onStep);
    ASSERT_EQ(nameOf(outcome.end), "arrived") << outcome.reason;
    EXPECT_LT((robot.T_w_b.translation() - config.goal.position).norm(), 0.3);
    EXPECT_GT(leastClearance, 0.125);
    EXPECT_GT(outcome.arrival->probability, 0.5);
    EXPECT_GT(outcome.map->size(), 1000U);
    EXPECT_GT(outcome.keyframes, 5);
    EXPECT_GT(outcome.duration, 6.);
}

/// A map that is too large for views ends the flight, not the program.
TEST_F(ExplorerTest, EndsWhenItsMapIsTooLarge) {
    const World world(test::roomToExplore(), config);
    test::ObedientRobot robot = robotIn(world);
    int steps = 0;
    const ExplorationOutcome outcome =
        explored(robot, [&](const Observation&, const auto&) -> bool {
            if (++steps == 5) throw MapTooLarge("too many cells");
            return true;
        });
    EXPECT_EQ(nameOf(outcome.end), "no way");
    EXPECT_EQ(outcome.reason, "too many cells; cells of 0.035 m");
}

/// Near the goal the robot is pushed, by as much as its odometry says, where nothing has texture:
/// it is at its goal, by far less certain than planned, and no image will tell.
TEST_F(ExplorerTest, EndsAsCertainAsItIsWhereItCannotSettleAtItsGoal) {
    config.explore.keyframeDistance = 10.;  // no other plan on the way
    config.explore.keyframeNew = 1.;
    config.explore.goalTolerance = 0.3;
    const World world(test::greyRoom(), config);
    for (const double confidence : {0.01, 0.9}) {
        config.explore.goalConfidence = confidence;
        test::ObedientRobot robot = robotIn(world);
        const Matrix6 calm = robot.odometryCovariance;
        bool isPushed = false;
        double atGoalSince = kInfinity;
        const auto onStep = [&](const Observation& observation, const auto&) {
            const Eigen::Vector3d p_w = robot.T_w_b.translation();
            const double left = (p_w - config.goal.position).norm();
            robot.odometryCovariance = calm;
            if (left < 0.4 && !std::exchange(isPushed, true)) {
                robot.odometryCovariance.diagonal().head<3>().setConstant(0.3 * 0.3);
            }
            if (left < 0.1) atGoalSince = std::min(atGoalSince, observation.time);
            return true;
        };
        const ExplorationOutcome outcome = explored(robot, onStep);
        EXPECT_EQ(nameOf(outcome.end), confidence < 0.5 ? "arrived" : "uncertain arrival")
            << outcome.reason;
        EXPECT_TRUE(isPushed);
        EXPECT_GT(outcome.duration, atGoalSince + 25.);
        EXPECT_LT(outcome.duration, atGoalSince + 40.);
        EXPECT_GT(outcome.arrival->probability, 0.05);
        EXPECT_LT(outcome.arrival->probability, 0.7);
    }
}

TEST_F(ExplorerTest, TheCallerMayEndIt) {
    const World world(test::roomToExplore(), config);
    test::ObedientRobot robot = robotIn(world);
    const ExplorationOutcome outcome = explored(
        robot, [](const Observation& observation, const auto&) { return observation.time < 0.45; });
    EXPECT_EQ(nameOf(outcome.end), "stopped");
    EXPECT_NEAR(outcome.duration, 0.5, 1e-9);
    EXPECT_EQ(outcome.keyframes, 1);
}

TEST_F(ExplorerTest, RefusesARobotWithAnotherCamera) {
    const World world(test::roomToExplore(), config);
    test::ObedientRobot turned(world.sharedViews(), config.camera.camera(), cameraMount(0.1),
                               config.start.position);
    EXPECT_THROW(explored(turned), std::invalid_argument);
    Camera large = config.camera.camera();
    large.width *= 2;
    test::ObedientRobot wide(world.sharedViews(), large, config.camera.T_b_c(),
                             config.start.position);
    EXPECT_THROW(explored(wide), std::invalid_argument);
}

}  // namespace
}  // namespace photonav
