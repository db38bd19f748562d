// SPDX-License-Identifier: BSD-3-Clause
// Explorations in real time. Nothing here depends on how fast the machine is.
#include <gtest/gtest.h>

#include <stdexcept>
#include <thread>

#include "exploration/explorer.hpp"
#include "exploration/real_time_json.hpp"
#include "mission/exploration/changing_views.hpp"
#include "mission/exploration/room_to_explore.hpp"
#include "mission/obedient_robot.hpp"

namespace photonav {
namespace {

void waitUntil(const std::function<bool()>& holds) {
    while (!holds()) std::this_thread::sleep_for(std::chrono::milliseconds(1));
}

class RealTimeExploration : public ::testing::Test {
  protected:
    RealTimeExploration() {
        config.planner = "rrt_star";
        config.goal.position.x() = 3.;
        config.explore.vertices = 100;
    }

    test::ObedientRobot robotIn(std::shared_ptr<const ViewSource> views) const {
        return {std::move(views), config.camera.camera(), config.camera.T_b_c(),
                config.start.position, 0.2};
    }

    ExplorationOutcome explored(test::ObedientRobot& flown, Timing timing,
                                const OnExplorer& on = {}, const OnFlightStep& onStep = {}) const {
        ExplorerOptions options = explorerOptions(config);
        options.timeStep = 0.05;
        options.pilot.route.responseTime = 0.;  // of an obedient robot
        options.timing = timing;
        return explore(flown, options, config.planner, 1, interrupted, on, onStep);
    }

    Config config = test::flightThroughRoom();
    const World world{test::roomToExplore(), config};
    test::ObedientRobot robot = robotIn(world.sharedViews());
    std::atomic<bool> interrupted = false;
};

TEST_F(RealTimeExploration, FliesByTheClockWhileASecondThreadPlans) {
    const auto loop = std::this_thread::get_id();
    std::size_t steps = 0, images = 0;
    std::atomic<std::size_t> moments = 0;
    OnExplorer on;
    on.update = [&](const ExplorationRecord& soFar) {
        EXPECT_EQ(std::this_thread::get_id(), loop);
        EXPECT_EQ(moments, soFar.updates.size() - 1);  // each before the next update
    };
    on.moment = [&](const ExplorerMoment& moment) {
        EXPECT_NE(std::this_thread::get_id(), loop);
        EXPECT_GT(moment.map.cells()->size(), 0U);
        EXPECT_GT(moment.image.depth.getSize(), 0U);
        ++moments;
    };
    const auto onStep = [&](const Observation&, const std::vector<TrackedFrame>& tracked) {
        ++steps;
        images += tracked.size();
        return true;
    };
    const Stopwatch watch;
    const ExplorationOutcome outcome = explored(robot, Timing::simulatedRealTime, on, onStep);
    EXPECT_GE(watch.seconds(), outcome.duration);
    ASSERT_EQ(nameOf(outcome.end), "arrived") << outcome.reason;
    EXPECT_LT((robot.T_w_b.translation() - config.goal.position).norm(), 0.3);
    EXPECT_EQ(moments, outcome.updates.size());
    EXPECT_GT(outcome.updates.front().time, 0.);  // the robot did not wait for its first plan
    ASSERT_TRUE(outcome.realTime);
    const RealTimeSummary& s = *outcome.realTime;
    EXPECT_EQ(s.lateness.count, steps);
    EXPECT_LE(s.lateSteps, steps);
    EXPECT_EQ(s.exposureToAnswer.count, images);
    EXPECT_EQ(s.arrivalToAnswer.count, images);
    EXPECT_EQ(s.planAge.count, outcome.updates.size());
    EXPECT_GT(s.planAge.median, 0.);
    EXPECT_GE(s.planAge.worst, s.planAge.quantile95);
    EXPECT_LE(s.joined, s.waited);
    EXPECT_LE(s.endedByClock, s.planAge.count);
}

TEST_F(RealTimeExploration, WithoutItNothingIsMeasured) {
    const ExplorationOutcome outcome = explored(robot, Timing::byWork);
    EXPECT_FALSE(outcome.realTime);
    EXPECT_EQ(outcome.updates.front().time, 0.);
}

/// A robot whose fly() takes its time must not be waited for: this one takes none.
TEST_F(RealTimeExploration, ARobotWithItsOwnClockIsNotPaced) {
    robot.isBlind = true;
    const Stopwatch watch;
    const ExplorationOutcome outcome = explored(robot, Timing::realTime);
    EXPECT_EQ(nameOf(outcome.end), "lost");  // without any image
    EXPECT_LT(watch.seconds(), 0.5 * outcome.duration);
    EXPECT_EQ(outcome.realTime->exposureToAnswer.count, 0U);
}

TEST_F(RealTimeExploration, AnExceptionOfTheSecondThreadReachesTheCaller) {
    const auto fail = [](const ExplorerMoment&) { throw std::range_error("on the second thread"); };
    EXPECT_THROW(explored(robot, Timing::realTime, {.moment = fail}), std::range_error);
}

/// The second thread is busy when the flight ends otherwise, and is waited for.
TEST_F(RealTimeExploration, AnExceptionOfTheLoopEndsTheSecondThread) {
    std::atomic<bool> isBusy = false, isLeft = false;
    const auto moment = [&](const ExplorerMoment&) {
        isBusy = true;
        std::this_thread::sleep_for(std::chrono::milliseconds(20));
        isLeft = true;
    };
    const auto onStep = [&](const Observation&, const auto&) -> bool {
        if (isBusy) throw std::range_error("in the loop");
        return true;
    };
    EXPECT_THROW(explored(robot, Timing::realTime, {.moment = moment}, onStep), std::range_error);
    EXPECT_TRUE(isLeft);
}

TEST_F(RealTimeExploration, TheLoopGoesOnWhileTheSecondThreadIsBusyAndEndsWhenInterrupted) {
    config.goal.position.x() = 7.;  // farther than the first plan leads
    std::atomic<int> busySteps = 0;
    std::atomic<bool> isBusy = false;
    const auto moment = [&](const ExplorerMoment&) {
        isBusy = true;
        waitUntil([&] { return interrupted.load(); });
    };
    const auto onStep = [&](const Observation&, const auto&) {
        EXPECT_FALSE(interrupted);
        if (isBusy && ++busySteps == 40) interrupted = true;
        return true;
    };
    const ExplorationOutcome outcome =
        explored(robot, Timing::realTime, {.moment = moment}, onStep);
    EXPECT_EQ(nameOf(outcome.end), "stopped");
    EXPECT_EQ(busySteps, 40);
    EXPECT_EQ(outcome.updates.size(), 1U);
    EXPECT_GT(outcome.realTime->waited, 0U);
}

/// The second thread never ends its update, and then a box comes down on the way.
TEST_F(RealTimeExploration, StopsBeforeAnObstacleWithoutAnotherPlan) {
    Scene boxed = test::roomToExplore();
    addBox(boxed, {3.2, 1.3, 0.}, {3.6, 2.7, 3.}, addTexture(boxed, valueNoise({.seed = 5})));
    const World after(boxed, config);
    bool hasChanged = false;
    std::atomic<bool> isNear = false, isStuck = false, isDone = false;
    config.goal.position.x() = 7.;
    test::ObedientRobot surprised =
        robotIn(std::make_shared<test::ChangingViews>(world, after, hasChanged));
    const auto moment = [&](const ExplorerMoment&) {
        if (!isNear) return;
        isStuck = true;
        waitUntil([&] { return isDone.load(); });
    };
    double changedAt = 0., leastClearance = kInfinity;
    const auto onStep = [&](const Observation& observation, const auto&) {
        const Eigen::Vector3d p_w = surprised.T_w_b.translation();
        isNear = p_w.x() > 1.3;
        if (isStuck && !hasChanged) {
            hasChanged = true;
            changedAt = observation.time;
        }
        if (hasChanged) leastClearance = std::min(leastClearance, after.clearance(p_w));
        isDone = hasChanged && observation.time > changedAt + 4.;
        return !isDone;
    };
    const ExplorationOutcome outcome =
        explored(surprised, Timing::simulatedRealTime, {.moment = moment}, onStep);
    EXPECT_EQ(nameOf(outcome.end), "stopped") << outcome.reason;
    EXPECT_TRUE(hasChanged);
    EXPECT_GT(leastClearance, 0.125);
    EXPECT_LT(surprised.lastCommand.linear.norm(), 0.02);
}

/// Requests made of one image of the room.
class BackgroundReplannerTest : public RealTimeExploration {
  protected:
    Replanner replanner() {
        return {config, nullptr, explorePlanner(config.planner), 1, config.robotRadius};
    }
    ReplanRequest request(double time) const {
        const UncertainPose belief = beliefAtTakeOff(config);
        MapInput input;
        input.T_c_w = belief;
        world.views().render(config.camera.camera(), belief.mean, input.image);
        input.shown = input.image;
        input.keyframe = MapInput::Keyframe{input.image, belief.mean, 0};
        return {{input}, {}, belief, time};
    }
    /// A point of the surface in the middle of the first image.
    Eigen::Vector3d seen() const {
        const Camera camera = config.camera.camera();
        View view;
        world.views().render(camera, beliefAtTakeOff(config).mean, view);
        const unsigned u = camera.width / 2, v = camera.height / 2;
        return beliefAtTakeOff(config).mean.inverse() * camera.unproject(u, v, view.depth[v][u]);
    }
    static Replanned resultOf(BackgroundReplanner& background) {
        std::optional<Replanned> result;
        waitUntil([&] {
            result = background.poll();
            return result.has_value();
        });
        return std::move(*result);
    }
};

TEST_F(BackgroundReplannerTest, JoinsWhatComesWhileItIsBusy) {
    Replanner replanner = this->replanner();
    BackgroundReplanner background(replanner, kInfinity);
    EXPECT_FALSE(background.poll() || background.isBusy());
    background.add(request(1.));
    EXPECT_EQ(background.waited(), 0U);
    background.goOn(beliefAtTakeOff(config));
    background.add(request(2.));
    background.add(request(3.));
    EXPECT_EQ(background.waited(), 2U);
    EXPECT_EQ(background.joined(), 1U);
    const Replanned first = resultOf(background);
    EXPECT_EQ(first.request.images.size(), 1U);
    EXPECT_EQ(first.request.imageTime, 1.);
    EXPECT_TRUE(first.hasMapGrown && first.way && first.views);
    EXPECT_FALSE(first.cells.empty());
    UncertainPose moved = beliefAtTakeOff(config);
    moved.covariance *= 2.;
    EXPECT_FALSE(background.poll());
    background.goOn(moved);
    const Replanned second = resultOf(background);
    EXPECT_EQ(second.request.images.size(), 2U);
    EXPECT_EQ(second.request.imageTime, 3.);
    EXPECT_EQ(second.request.T_c_w.covariance, moved.covariance);
    EXPECT_FALSE(background.isBusy());
}

/// It would go on for hours: the planner is to have more vertices than it can find.
TEST_F(BackgroundReplannerTest, StopEndsAPlanInProgressAndDropsWhatWaits) {
    config.explore.vertices = 100000000;
    config.belief.kappa = 1.;  // given: to find it takes a planner as well
    Replanner replanner = this->replanner();
    BackgroundReplanner background(replanner, kInfinity);
    const Eigen::Vector3d wall = seen();
    const double unknown = replanner.clearanceBeside(wall);
    background.add(request(1.));
    background.goOn(beliefAtTakeOff(config));
    background.add(request(2.));
    waitUntil([&] { return replanner.clearanceBeside(wall) != unknown; });  // planning is next
    background.stop();
    EXPECT_FALSE(background.isBusy() || background.poll());
}

TEST_F(BackgroundReplannerTest, PollThrowsWhatItsThreadHasThrown) {
    Replanner replanner = this->replanner();
    BackgroundReplanner background(replanner, kInfinity);
    background.run([] { throw std::range_error("a task"); });
    EXPECT_THROW(resultOf(background), std::range_error);
    EXPECT_FALSE(background.isBusy());
}

/// The step that arrives with the least delay is in time; what sleeps is late at least by that.
TEST(RealTimeMonitorTest, MeasuresAgainstTheEarliestStep) {
    RealTimeMonitor monitor;
    monitor.onArrival(100.);
    std::this_thread::sleep_for(std::chrono::milliseconds(30));
    monitor.onArrival(100.01);
    monitor.onAnswer(99.96);
    monitor.onPlan(99., true);
    const RealTimeSummary s = monitor.summary();
    EXPECT_EQ(s.lateness.count, 2U);
    EXPECT_EQ(s.lateSteps, 1U);
    EXPECT_GE(s.lateness.worst, 0.02);
    EXPECT_GE(s.exposureToAnswer.median, 0.07);
    EXPECT_LE(s.arrivalToAnswer.median, s.exposureToAnswer.median);
    EXPECT_GE(s.planAge.median, 1.03);
    EXPECT_EQ(s.endedByClock, 1U);
    monitor.onArrival(200.);  // a clock that runs ahead is never late
    EXPECT_EQ(monitor.summary().lateSteps, 1U);
}

TEST(RealTimeMonitorTest, SummarisesDurations) {
    std::vector<double> durations;
    for (int i = 100; i > 0; --i) durations.push_back(i);
    const Durations d = summaryOf(durations);
    EXPECT_EQ(d.count, 100U);
    EXPECT_EQ(d.median, 51.);
    EXPECT_EQ(d.quantile95, 95.);
    EXPECT_EQ(d.worst, 100.);
    EXPECT_EQ(summaryOf({}).count, 0U);
}

TEST(RealTimeJson, IsReadAsWritten) {
    const RealTimeSummary summary{.lateness = {5, 0.1, 0.2, 0.3},
                                  .lateSteps = 2,
                                  .exposureToAnswer = {3, 0.01, 0.02, 0.03},
                                  .arrivalToAnswer = {3, 0.001, 0.002, 0.003},
                                  .planAge = {4, 1., 2., 3.},
                                  .waited = 7,
                                  .joined = 6,
                                  .endedByClock = 1};
    nlohmann::json json = realTimeJson(summary);
    EXPECT_EQ(realTimeJson(realTimeFrom(json)), json);
    EXPECT_EQ(json["plan_age"]["95_percent_s"], 2.);
    EXPECT_EQ(json["updates_joined"], 6);
    json.erase("late_steps");
    EXPECT_ANY_THROW(realTimeFrom(json));
}

}  // namespace
}  // namespace photonav
