// SPDX-License-Identifier: BSD-3-Clause
#include "exploration/explorations.hpp"

#include <gtest/gtest.h>

#include <map>

#include "flight/flight_statistics.hpp"
#include "io/error.hpp"
#include "mission/exploration/changing_views.hpp"
#include "mission/exploration/room_to_explore.hpp"

namespace photonav {
namespace {

class RoomToExplore : public ::testing::Test {
  protected:
    ExplorationResult flown(Scene scene, std::uint32_t seed = 1) {
        const World world(std::move(scene), config);
        const PlanningProblem problem(config, world);
        return explore(setUpExploration(problem), config.planner, seed, kNotInterrupted);
    }

    /// A flight in a world that changes once the robot is beyond x [m].
    ExplorationResult flownWhereItChanges(const World& before, const World& after, double x,
                                          std::uint32_t seed) {
        const PlanningProblem problem(config, before);
        bool hasChanged = false;
        ExplorationSetup setup = setUpExploration(problem);
        setup.truth.truth = std::make_shared<test::ChangingViews>(before, after, hasChanged);
        setup.truth.clearance = [&](const Eigen::Vector3d& p_w) {
            return (hasChanged ? after : before).clearance(p_w);
        };
        const auto onExposure = [&](const Exposed& exposed) {
            const Pose T_w_b = (setup.truth.T_b_c * exposed.T_c_w).inverse();
            hasChanged = hasChanged || T_w_b.translation().x() > x;
        };
        ExplorationResult flight =
            explore(setup, "rrt_star/forward", seed, kNotInterrupted, {.exposure = onExposure});
        EXPECT_TRUE(hasChanged);
        return flight;
    }

    Config config = test::flightThroughRoom();
};

TEST_F(RoomToExplore, ArrivesAroundABoxFoundOnTheWay) {
    const ExplorationResult flight = flown(test::roomToExplore());
    ASSERT_EQ(nameOf(flight.end), "arrived") << flight.reason;
    EXPECT_LT(flight.goalError, 0.25);
    EXPECT_GT(flight.leastClearance, 0.125);
    // Nothing was in the way at first; the plan then became longer where the box came into view.
    EXPECT_LT(flight.updates.front().length, 6.3);
    EXPECT_GT(flight.flown, 6.2);
    std::size_t invalidated = 0;
    for (const PlanUpdate& update : flight.updates) invalidated += update.counts.edgesInvalidated;
    EXPECT_GT(invalidated, 0U);
    EXPECT_GT(flight.map->size(), 1000U);
    EXPECT_LT(neesPerDof(flight), 6.);
    EXPECT_EQ(flight.keyframes, static_cast<int>(flight.updates.size()));
}

TEST_F(RoomToExplore, StereoMapsItAsWell) {
    config.goal.position.x() = 3.5;
    config.explore.sensor = ExploreSensor::stereo;
    int arrived = 0, keyframes = 0;
    for (const std::uint32_t seed : {1U, 2U, 3U, 4U, 5U, 6U}) {
        const ExplorationResult flight = flown(test::roomToExplore(), seed);
        arrived += flight.end == FlightEnd::arrived ? 1 : 0;
        keyframes += flight.keyframes;
        EXPECT_GT(flight.map->size(), 500U);
        EXPECT_GT(flight.leastClearance, 0.125);
    }
    EXPECT_GE(arrived, 5);
    EXPECT_GT(keyframes, 12);
}

/// Without a projector a second camera does not see blank walls. The robot does not fly toward what
/// it does not see.
TEST_F(RoomToExplore, StereoTakesNoBlindSteps) {
    config.explore.sensor = ExploreSensor::stereo;
    config.explore.projector = 0.;
    const ExplorationResult flight = flown(test::greyRoom());
    EXPECT_EQ(flight.end, FlightEnd::noWay);
    EXPECT_EQ(flight.blindSteps, 0);
}

/// A single camera measures depth by its motion, and of what is right ahead it measures little. It
/// does not fly on into what it has not measured.
TEST_F(RoomToExplore, ASingleCameraEndsItsFlightBeforeWhatItHasNotMeasured) {
    config.explore.sensor = ExploreSensor::monocular;
    for (const std::uint32_t seed : {1U, 2U, 3U}) {
        const ExplorationResult flight = flown(test::roomToExplore(), seed);
        EXPECT_TRUE(flight.end == FlightEnd::arrived || flight.end == FlightEnd::noWay) << seed;
        EXPECT_GT(flight.leastClearance, 0.125);
        EXPECT_GT(flight.blindSteps, 1);
        EXPECT_LE(flight.blindSteps, 6);
        EXPECT_GT(flight.map->size(), 500U);
    }
}

/// Views whose first part interrupts the flight.
class InterruptingViews : public ViewSource {
  public:
    explicit InterruptingViews(std::shared_ptr<const ViewSource> views)
        : views_(std::move(views)) {}
    void render(const Camera& camera, const Pose& T_c_w, View& view) const override {
        ++parts;
        interrupted = true;
        views_->render(camera, T_c_w, view);
    }
    mutable std::atomic<bool> interrupted{false};
    mutable int parts = 0;

  private:
    std::shared_ptr<const ViewSource> views_;
};

TEST_F(RoomToExplore, IsInterruptedInsideALargeImage) {
    config.camera.width = 2000;
    config.camera.height = 1100;
    const World world(test::roomToExplore(), config);
    const PlanningProblem problem(config, world);
    ExplorationSetup setup = setUpExploration(problem);
    const auto views = std::make_shared<InterruptingViews>(setup.truth.truth);
    setup.truth.truth = views;
    const ExplorationResult flight = explore(setup, config.planner, 1, views->interrupted);
    EXPECT_EQ(nameOf(flight.end), "stopped");
    EXPECT_EQ(views->parts, 1);
}

TEST_F(RoomToExplore, IsTheSameForTheSameSeed) {
    config.goal.position.x() = 3.;
    const ExplorationResult a = flown(test::roomToExplore()), b = flown(test::roomToExplore()),
                            other = flown(test::roomToExplore(), 2);
    ASSERT_EQ(a.samples.size(), b.samples.size());
    EXPECT_EQ(a.samples.back().T_c_w.matrix(), b.samples.back().T_c_w.matrix());
    EXPECT_EQ(a.samples.back().belief.covariance, b.samples.back().belief.covariance);
    EXPECT_NE(a.samples.back().T_c_w.matrix(), other.samples.back().T_c_w.matrix());
}

TEST_F(RoomToExplore, SaysThatTheGoalIsInAnObstacle) {
    Scene scene = test::roomToExplore();
    const auto crate = addTexture(scene, valueNoise({.size = {1., 1.}, .seed = 3}));
    addBox(scene, {6.8, 1.8, 0.}, {7.2, 2.2, 1.2}, crate);
    const ExplorationResult flight = flown(std::move(scene));
    EXPECT_EQ(nameOf(flight.end), "no way");
    EXPECT_NE(flight.reason.find("goal is in collision"), std::string::npos) << flight.reason;
    EXPECT_GT(flight.leastClearance, 0.125);
}

/// A crate around the goal that was an error of depths measured from far away.
TEST_F(RoomToExplore, LooksFromNearbyWhetherTheGoalIsInAnObstacle) {
    Scene crate = test::roomToExplore();
    addBox(crate, {6.8, 1.8, 0.}, {7.2, 2.2, 1.2}, addTexture(crate, valueNoise({.seed = 3})));
    const World seenFromAfar(crate, config), truth(test::roomToExplore(), config);
    for (const std::uint32_t seed : {1U, 2U, 3U}) {
        const ExplorationResult flight = flownWhereItChanges(seenFromAfar, truth, 5., seed);
        EXPECT_EQ(nameOf(flight.end), "arrived") << flight.reason;
        EXPECT_LT(flight.goalError, 0.3);
    }
}

/// What was not seen is an obstacle to this robot, whose camera sees the way ahead.
TEST_F(RoomToExplore, AnticipatesObstaclesWhereItHasNotSeen) {
    config.explore.unknown = UnknownSpace::pessimistic;
    config.camera.mount = "forward";
    config.goal.position.x() = 3.5;
    const ExplorationResult flight = flown(test::roomToExplore());
    EXPECT_EQ(nameOf(flight.end), "arrived") << flight.reason;
    EXPECT_GT(flight.leastClearance, 0.125);
    config.camera.mount = "front45";  // sees only what is lower
    const ExplorationResult lower = flown(test::roomToExplore());
    EXPECT_EQ(nameOf(lower.end), "no way");
    EXPECT_NE(lower.reason.find("seen to be free"), std::string::npos) << lower.reason;
}

/// RRT* plans random headings: a robot that keeps them has to stop and turn to see its way.
/// Headings along the motion have it in view.
TEST_F(RoomToExplore, LooksWhileItFliesIfItsHeadingsAreFree) {
    const auto duration = [&](const std::string& planner, LookAhead look) {
        config.planner = planner;
        config.explore.look = look;
        const ExplorationResult flight = flown(test::roomToExplore(), 3);
        EXPECT_EQ(nameOf(flight.end), "arrived") << flight.reason;
        EXPECT_GT(flight.leastClearance, 0.125);
        return flight.duration;
    };
    EXPECT_NE(duration("rrt_star", LookAhead::flying), duration("rrt_star", LookAhead::stopped));
    EXPECT_EQ(duration("rrt_star/forward", LookAhead::flying),
              duration("rrt_star/forward", LookAhead::stopped));
}

/// A wall across the whole room: right and left are as good as each other, at every update anew.
TEST_F(RoomToExplore, DoesNotLookToAndFroForEver) {
    Scene split = test::greyRoom();
    addBox(split, {5., 0., 0.}, {5.2, 4., 3.}, addTexture(split, valueNoise({.seed = 3})));
    const World world(std::move(split), config);
    const PlanningProblem problem(config, world);
    const ExplorationResult flight =
        explore(setUpExploration(problem), "pa_rrt_star/forward", 1, kNotInterrupted);
    EXPECT_EQ(nameOf(flight.end), "no way");
    EXPECT_LT(flight.duration, 60.);
}

/// A depth sensor that measures nothing: the robot does not fly into what it cannot see.
TEST_F(RoomToExplore, SaysThatItSeesNothingOfTheWay) {
    config.explore.depthMissing = 1.;
    const ExplorationResult flight = flown(test::roomToExplore());
    EXPECT_EQ(nameOf(flight.end), "no way");
    EXPECT_NE(flight.reason.find("sensor cannot observe"), std::string::npos) << flight.reason;
    EXPECT_LT(flight.flown, 0.5);
}

/// Without texture odometry is all there is. The arrival is claimed if it is more likely than not,
/// with its probability.
TEST_F(RoomToExplore, ArrivesByOdometryWhereNothingHasTexture) {
    config.goal.position.x() = 5.;
    config.belief.motionNoise.diagonal() << 2e-3, 2e-3, 2e-3, 2e-5, 2e-5, 1e-3;
    const ExplorationResult flight = flown(test::greyRoom());
    ASSERT_EQ(nameOf(flight.end), "arrived") << flight.reason;
    EXPECT_LT(flight.goalError, 0.3);
    EXPECT_GT(flight.arrivalProbability, 0.5);
    EXPECT_LT(flight.arrivalProbability, 0.995);
    EXPECT_LT(neesPerDof(flight), 3.);
    config.explore.goalConfidence = 0.995;
    EXPECT_EQ(nameOf(flown(test::greyRoom()).end), "uncertain arrival");
}

/// A box comes down on the way, in space that the map has free, when the robot is 1.4 m before it.
TEST_F(RoomToExplore, FliesAroundABoxThatAppearsInFrontOfIt) {
    Scene boxed = test::roomToExplore();
    addBox(boxed, {3.2, 1.3, 0.}, {3.6, 2.7, 3.}, addTexture(boxed, valueNoise({.seed = 5})));
    const World before(test::roomToExplore(), config), after(boxed, config);
    for (const std::uint32_t seed : {1U, 2U, 3U, 4U}) {
        const ExplorationResult flight = flownWhereItChanges(before, after, 1.8, seed);
        EXPECT_EQ(nameOf(flight.end), "arrived") << flight.reason << ", seed " << seed;
        EXPECT_GT(flight.leastClearance, 0.15);
        EXPECT_LT(flight.goalError, 0.3);
    }
}

/// Images that are black or missing for a while, and depth that is missing for most pixels.
TEST_F(RoomToExplore, ArrivesThroughABlackoutWithFewDepths) {
    config.fly.blackout = {3., 4.};
    config.fly.drop = 0.2;
    config.explore.depthMissing = 0.5;
    // Single free cells in walls, of which half the depths are missing, ended them below the robot
    // (27), and walls of which three cells had been seen were none (7).
    for (const std::uint32_t seed : {2U, 7U, 27U}) {
        const ExplorationResult flight = flown(test::roomToExplore(), seed);
        EXPECT_EQ(nameOf(flight.end), "arrived") << flight.reason << ", seed " << seed;
        EXPECT_GT(flight.rejectedImages, 10);
        EXPECT_GT(flight.leastClearance, 0.125);
    }
}

TEST_F(RoomToExplore, SaysThatTheGoalIsWalledOff) {
    Scene scene = test::roomToExplore();
    addBox(scene, {5.8, 0., 0.}, {6., 4., 3.}, addTexture(scene, valueNoise({.seed = 5})));
    const ExplorationResult flight = flown(std::move(scene));
    EXPECT_EQ(nameOf(flight.end), "no way");
    EXPECT_NE(flight.reason.find("no way to the goal"), std::string::npos) << flight.reason;
    EXPECT_GT(flight.leastClearance, 0.125);
    EXPECT_GT(flight.map->size(), 1000U);
}

TEST_F(RoomToExplore, RefusesAStartInCollision) {
    config.start.position = {4.7, 2., 1.1};
    try {
        flown(test::roomToExplore());
        FAIL();
    } catch (const InputError& error) {
        EXPECT_NE(std::string(error.what()).find("start: in collision"), std::string::npos);
    }
}

TEST_F(RoomToExplore, TheRobotHasTheSensorsOfTheConfig) {
    config.explore.gyroscopeNoise = 2e-3;
    config.explore.verticalSigma = 0.02;
    const World world(test::roomToExplore(), config);
    const SimulatedRobotOptions robot =
        setUpExploration(PlanningProblem(config, world)).flight.robot;
    EXPECT_EQ(robot.body.gyroscopeNoise, 2e-3);
    EXPECT_EQ(robot.camera.verticalSigma, 0.02);
}

TEST_F(RoomToExplore, ManyFlightsAreTheSameOnAnyNumberOfThreads) {
    config.goal.position.x() = 2.;
    const World world(test::roomToExplore(), config);
    const PlanningProblem problem(config, world);
    const ExplorationSetup setup = setUpExploration(problem);
    const std::vector<TrialItem> items{
        {"rrt_star", 1}, {"rrt_star", 2}, {"belief_rrt_star", 1}, {"belief_rrt_star", 2}};
    const auto fly = [&](unsigned jobs) {
        std::map<TrialItem, ExplorationResult> flights;
        exploreMany(setup, items, jobs, kNotInterrupted, {[&](ExplorationResult flight) {
                        flights.emplace(itemOf(flight), std::move(flight));
                    }});
        return flights;
    };
    auto one = fly(1), two = fly(2);
    ASSERT_EQ(one.size(), 4U);
    ASSERT_EQ(two.size(), 4U);
    std::vector<ExplorationResult> flights;
    for (const TrialItem& item : items) {
        EXPECT_EQ(one.at(item).goalError, two.at(item).goalError);
        flights.push_back(one.at(item));
    }
    const ExplorationSummary s = summarise(flights, 1.);
    EXPECT_EQ(s.flights, 4U);
    EXPECT_GT(s.updateMedian, 0.);
}

}  // namespace
}  // namespace photonav
