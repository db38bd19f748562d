// SPDX-License-Identifier: BSD-3-Clause
#include "flight/flight_loop.hpp"

#include <gtest/gtest.h>

#include "estimation/calibration.hpp"
#include "geometry/constants.hpp"
#include "mission/obedient_robot.hpp"
#include "tracking/rooms.hpp"

namespace photonav {
namespace {

using test::kDown;

std::vector<PlannedView> straightTo(double x) {
    std::vector<PlannedView> plan(2);
    for (PlannedView& view : plan) {
        view.T_w_b.translation().z() = 2.;
        view.isWaypoint = true;
    }
    plan.back().T_w_b.translation().x() = x;
    plan.back().distance = std::abs(x);
    return plan;
}

class FlightLoop : public ::testing::Test {
  protected:
    FlightLoop() {
        UncertainPose start{(straightTo(1.).front().T_w_b * robot.T_b_c()).inverse()};
        start.covariance = 1e-3 * Matrix6::Identity();
        tracker.emplace(trackerOf(robot, floor, start));
        flown.route.responseTime = 0.;  // of an obedient robot
        pilot.emplace(pilotOf(robot, straightTo(1.), floor, flown));
    }

    /// @return duration of the flight [s]
    double flyToGoal() {
        double time = 0.;
        flyLoop(robot, *tracker, *pilot, 0.1, [&](const Observation& observation, const auto&) {
            time = observation.time;
            return !pilot->hasArrived(*tracker, time) && time < 60.;
        });
        return time;
    }

    std::shared_ptr<const ViewSource> floor =
        std::make_shared<MeshRenderer>(test::floorOf(valueNoise({.size = {20., 20.}, .seed = 3})));
    test::ObedientRobot robot{floor, makeCamera(47, 30, 1.2), cameraMount(kDown), {0.05, 0.02, 2.}};
    PilotOptions flown;
    std::optional<Tracker> tracker;
    std::optional<Pilot> pilot;
};

TEST_F(FlightLoop, FliesAnyRobot) {
    EXPECT_LT(flyToGoal(), 30.);
    EXPECT_LT((robot.T_w_b.translation() - Eigen::Vector3d(1., 0., 2.)).norm(), 0.05);
}

/// Notes what the loop asks of it, and shows a black image before each good one.
class StrictRobot : public Robot {
  public:
    explicit StrictRobot(Robot& robot) : robot_(robot) {}
    Observation fly(const BodyVelocity& command, double seconds) override {
        commands.push_back(command);
        steps.push_back(seconds);
        Observation observation = robot_.fly(command, seconds);
        CameraFrame black = observation.frames.front();
        black.view.intensity = 0.F;
        black.time -= 0.5 * seconds;
        if (seconds > 0.) observation.frames.insert(observation.frames.begin(), black);
        return observation;
    }
    const Camera& camera() const override { return robot_.camera(); }
    const Pose& T_b_c() const override { return robot_.T_b_c(); }
    double blur() const override { return robot_.blur(); }

    std::vector<BodyVelocity> commands;
    std::vector<double> steps;

  private:
    Robot& robot_;
};

TEST_F(FlightLoop, LooksFirstAndFliesWhatThePilotCommands) {
    StrictRobot strict(robot);
    std::size_t calls = 0;
    flyLoop(strict, *tracker, *pilot, 0.1,
            [&](const Observation& observation, const std::vector<TrackedFrame>& tracked) {
                EXPECT_EQ(++calls, strict.steps.size());
                EXPECT_EQ(tracked.size(), observation.frames.size());
                EXPECT_EQ(tracked.back().time, observation.time);
                return !pilot->hasServoedOnImage() && observation.time < 30.;
            });
    EXPECT_TRUE(pilot->hasServoedOnImage()) << "on the good images";
    EXPECT_EQ(strict.steps.front(), 0.);
    EXPECT_EQ(strict.commands.front().linear.norm(), 0.);
    EXPECT_EQ(strict.steps[1], 0.1);
    // From standstill, as the limit of acceleration allows in one step.
    EXPECT_GT(strict.commands[1].linear.norm(), 0.);
    EXPECT_LE(strict.commands[1].linear.norm(), RouteOptions().limits.maxAcceleration * 0.1 + 1e-9);
}

/// Without the goal's image the robot has arrived after it was there for 1.5 s, by its own clock.
TEST_F(FlightLoop, TimeIsThatOfTheRobot) {
    PilotOptions options;
    options.photometricGoal = false;
    options.route.responseTime = 0.;
    pilot.emplace(straightTo(1.), floor, robot.camera(), robot.T_b_c(), options);
    std::optional<double> atGoalSince;
    double time = 0.;
    flyLoop(robot, *tracker, *pilot, 0.1, [&](const Observation& observation, const auto&) {
        time = observation.time;
        if (!atGoalSince && pilot->route().isAtGoal()) atGoalSince = time;
        return !pilot->hasArrived(*tracker, time) && time < 60.;
    });
    ASSERT_TRUE(atGoalSince);
    EXPECT_NEAR(time - *atGoalSince, 1.5, 0.15);
}

TEST_F(FlightLoop, GoesOnWithAnotherPlanAndMap) {
    flyToGoal();
    pilot->setPlan(straightTo(-0.5));
    const auto map =
        std::make_shared<MeshRenderer>(test::floorOf(valueNoise({.size = {20., 20.}, .seed = 3})));
    pilot->setMap(map);
    tracker->setMap(map);
    EXPECT_FALSE(pilot->hasServoedOnImage());
    EXPECT_LT(flyToGoal(), 60.);
    EXPECT_LT((robot.T_w_b.translation() - Eigen::Vector3d(-0.5, 0., 2.)).norm(), 0.05);
}

/// As an exploration does.
TEST_F(FlightLoop, ANewPlanOnTheWayDoesNotStopIt) {
    constexpr double kStep = 0.1;  // [s]
    pilot->setPlan(straightTo(3.));
    int plans = 0;
    double slowest = kInfinity;
    BodyVelocity before;
    flyLoop(robot, *tracker, *pilot, kStep, [&](const Observation& observation, const auto&) {
        const BodyVelocity& now = robot.lastCommand;
        EXPECT_LT((now.linear - before.linear).norm(), 2. * kStep + 1e-9);
        EXPECT_LT(robot.T_w_b.translation().x(), 3.8);
        if (plans > 0 && robot.T_w_b.translation().x() < 2.5) {
            slowest = std::min(slowest, now.linear.norm());
        }
        before = now;
        const double time = observation.time;
        if (plans < 5 && robot.T_w_b.translation().x() > 1. + 0.2 * plans) {
            std::vector<PlannedView> plan = straightTo(3.7);
            plan.front().T_w_b = (robot.T_b_c() * tracker->belief().mean).inverse();
            plan.back().T_w_b.translation().y() = 0.1 * plans;
            plan.back().distance = 2.7 - 0.2 * plans;
            pilot->setPlan(std::move(plan));
            ++plans;
        }
        return !pilot->hasArrived(*tracker, time) && time < 30.;
    });
    EXPECT_EQ(plans, 5);
    EXPECT_GT(slowest, 0.9);
    EXPECT_NEAR(robot.T_w_b.translation().x(), 3.7, 0.05);
}

/// Images fail before a corner and come again where the last one was. The straight line back would
/// lead across the corner, 0.3 m off the way.
TEST_F(FlightLoop, FliesBackOnTheWayItCameAndOnAlongThePlan) {
    std::vector<PlannedView> plan = straightTo(1.5);
    plan.push_back(plan.back());
    plan.back().T_w_b.translation().y() = 1.;
    plan.back().distance = 2.5;
    pilot->setPlan(plan);
    const auto offPlan = [](const Eigen::Vector3d& p_w) {
        const Eigen::Vector3d onFirst(std::clamp(p_w.x(), 0., 1.5), 0., 2.);
        const Eigen::Vector3d onSecond(1.5, std::clamp(p_w.y(), 0., 1.), 2.);
        return std::min((p_w - onFirst).norm(), (p_w - onSecond).norm());
    };
    double farthestOff = 0., time = 0.;
    bool isBack = false;
    flyLoop(robot, *tracker, *pilot, 0.1, [&](const Observation& observation, const auto&) {
        time = observation.time;
        const Eigen::Vector3d p_w = robot.T_w_b.translation();
        const double way = p_w.x() + p_w.y();
        isBack = isBack || (tracker->loss().isLost() && way < 1.1);
        robot.isBlind = way > 1.05 && !isBack;
        farthestOff = std::max(farthestOff, offPlan(p_w));
        EXPECT_FALSE(pilot->hasGivenUp(*tracker, time));
        return time < 60. && !pilot->hasArrived(*tracker, time);
    });
    EXPECT_TRUE(isBack);
    EXPECT_LT(time, 40.);
    EXPECT_LT(farthestOff, 0.15);
    EXPECT_EQ(tracker->loss().timesLost(), 1);
    EXPECT_LT((robot.T_w_b.translation() - Eigen::Vector3d(1.5, 1., 2.)).norm(), 0.05);
}

/// Images fail before the goal, and tracking is lost at the goal: the way back is no arrival.
TEST_F(FlightLoop, FliesToItsGoalAgainAfterALossThere) {
    flown.photometricGoal = false;
    pilot.emplace(pilotOf(robot, straightTo(1.6), floor, flown));
    bool wasAtGoal = false, isBack = false;
    double time = 0.;
    flyLoop(robot, *tracker, *pilot, 0.1, [&](const Observation& observation, const auto&) {
        time = observation.time;
        const double x = robot.T_w_b.translation().x();
        wasAtGoal = wasAtGoal || (tracker->loss().isLost() && x > 1.5);
        isBack = isBack || (tracker->loss().isLost() && x < 1.1);
        robot.isBlind = x > 1. && !isBack;
        return time < 60. && !pilot->hasArrived(*tracker, time);
    });
    EXPECT_TRUE(wasAtGoal);
    EXPECT_TRUE(isBack);
    EXPECT_LT(time, 40.);
    EXPECT_NEAR(robot.T_w_b.translation().x(), 1.6, 0.05);
}

/// Images fail 3 m before a gap of 60 cm and come again after 10 s. By then the body may touch the
/// sides of the gap, by the errors of odometry.
TEST_F(FlightLoop, ALostRobotHoversBeforeAGapThatItMayMiss) {
    std::vector<PlannedView> plan;
    for (int i = 0; i <= 20; ++i) plan.push_back(straightTo(0.3 * i).back());
    robot.odometryCovariance.topLeftCorner<3, 3>() = 3e-4 * Eigen::Matrix3d::Identity();
    robot.odometryCovariance.bottomRightCorner<3, 3>() *= 0.01;
    double farthestBlind = 0.;
    const auto flyBlindFrom1m = [&](const Observation& observation, const auto&) {
        const double x = robot.T_w_b.translation().x();
        robot.isBlind = x > 1. && observation.time < 10.;
        if (robot.isBlind) farthestBlind = std::max(farthestBlind, x);
        return !pilot->hasArrived(*tracker, observation.time) && observation.time < 60.;
    };
    flown.clearance = [](const Eigen::Vector3d& p_w) {
        const Eigen::Array2d toSides(4. - p_w.x(), 0.3 - std::abs(p_w.y()));
        return toSides.maxCoeff() > 0. ? toSides.max(0.).matrix().norm() : 0.;
    };
    pilot.emplace(pilotOf(robot, plan, floor, flown));
    flyLoop(robot, *tracker, *pilot, 0.1, flyBlindFrom1m);
    EXPECT_GT(farthestBlind, 3.) << "nothing is near there";
    EXPECT_LT(farthestBlind, 4.);
    EXPECT_NEAR(robot.T_w_b.translation().x(), 6., 0.05);
}

/// A robot half a metre from where it believes to be does not see the carpet that it expects, and
/// searches for it, toward a wall. When its images fail, the wall is within three standard
/// deviations.
TEST_F(FlightLoop, ALostRobotDoesNotSearchWhereItMayTouchAWall) {
    const auto carpet = std::make_shared<MeshRenderer>(test::carpetOnWhite());
    std::vector<PlannedView> plan;
    for (int i = 0; i <= 20; ++i) {
        plan.push_back(straightTo(std::min(1., 0.1 * i)).back());
        plan.back().T_w_b.translation().y() = -1. - std::max(0., 0.1 * i - 1.);
        plan.back().distance = 0.1 * i;
        plan.back().covariance = (i < 10 ? 1. : 1e-4) * Matrix6::Identity();
    }
    Vector6 variances;
    variances << 1e-4, 0.25, 1e-4, 1e-5, 1e-5, 1e-5;
    UncertainPose start{(plan.front().T_w_b * robot.T_b_c()).inverse()};
    start.covariance = inOtherFrame(Matrix6(variances.asDiagonal()), robot.T_b_c().inverse());
    const auto highestY = [&](double wallY) {
        test::ObedientRobot searching{carpet, robot.camera(), robot.T_b_c(), {0., -1.5, 2.}};
        flown.clearance = [=](const Eigen::Vector3d& p_w) { return wallY - p_w.y(); };
        Tracker seeing = trackerOf(searching, carpet, start);
        Pilot flying = pilotOf(searching, plan, carpet, flown);
        double highest = -kInfinity;
        flyLoop(searching, seeing, flying, 0.1, [&](const Observation& observation, const auto&) {
            const double y = searching.T_w_b.translation().y();
            highest = std::max(highest, y);
            searching.isBlind = searching.T_w_b.translation().x() > 0.9;
            return observation.time < 12.;
        });
        return highest;
    };
    EXPECT_GT(highestY(5.), -0.9) << "nothing is near";
    EXPECT_LT(highestY(0.9), -1.);
}

/// Options of photographs would take its rendered images for sharper than they are.
TEST_F(FlightLoop, TheRobotStatesMountAndSharpnessOfItsImages) {
    UncertainPose start{(straightTo(1.).front().T_w_b * robot.T_b_c()).inverse()};
    start.covariance = 1e-3 * Matrix6::Identity();
    TrackerOptions options{.map = photographOptions()};
    const Observation image = robot.fly({}, 0.);
    const Observation moved = robot.fly({.linear = {0.5, 0., 0.}}, 0.2);
    const auto beliefOf = [&](Tracker used) {
        used.update(image);
        used.update(moved);
        return used.beliefAtLastImage();
    };
    const UncertainPose belief = beliefOf(trackerOf(robot, floor, start, options));
    options.T_b_c = robot.T_b_c();
    const UncertainPose blurry = beliefOf({floor, robot.camera(), start, options});
    options.map.blur = kRenderedBlur;
    const UncertainPose expected = beliefOf({floor, robot.camera(), start, options});
    EXPECT_EQ(belief.mean.matrix(), expected.mean.matrix());
    EXPECT_EQ(belief.covariance, expected.covariance);
    EXPECT_NE(blurry.covariance, expected.covariance);
}

TEST_F(FlightLoop, TimeMustPass) {
    EXPECT_THROW(
        flyLoop(robot, *tracker, *pilot, 0., [](const auto&, const auto&) { return false; }),
        std::invalid_argument);
}

}  // namespace
}  // namespace photonav
