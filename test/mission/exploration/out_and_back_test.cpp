// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "exploration/explorer.hpp"
#include "flight/flight.hpp"
#include "flight/flight_statistics.hpp"
#include "mission/exploration/room_to_explore.hpp"
#include "onlinemap/mapper.hpp"
#include "problem/planning_problem.hpp"
#include "render/voxel_renderer.hpp"

namespace photonav {
namespace {

Scene corridor() {
    Scene scene;
    const auto walls = addTexture(scene, valueNoise({.size = {8., 3.}, .seed = 2}));
    const auto floor = addTexture(scene, valueNoise({.size = {8., 4.}, .seed = 1}));
    addBox(scene, {0., 0., 0.}, {8., 4., 3.}, walls, BoxInside::hollow);
    addPlane(scene, {0., 0., 0.01}, {8., 0., 0.}, {0., 4., 0.}, floor);
    return scene;
}

/// A robot that maps on its way along a corridor and back, and never turns: on the way back it sees
/// again what it mapped on the way out.
class OutAndBack {
  public:
    OutAndBack(const FlightWorld& world, const FlightOptions& options, const Config& config,
               std::uint64_t seed)
        : robot_(world.truth, world.camera, world.T_b_c,
                 drawStart(beliefAtTakeOff(config), world.T_b_c, seed), world.noise, options.robot,
                 seed),
          evaluator_(world, robot_, config.start.position),
          map_(config),
          mapper_(config),
          tracker_(trackerOf(robot_, views(), beliefAtTakeOff(config), trackerFor(options))),
          pilot_(pilotOf(robot_, plan(config), views(), pilotFor(options))),
          timeStep_(options.timeStep) {}

    /// @return believed and true poses at the images
    std::vector<FlightSample> fly() {
        bool hasLeft = false;
        flyLoop(robot_, tracker_, pilot_, timeStep_, [&](const Observation& seen, const auto& all) {
            for (std::size_t i = 0; i < all.size(); ++i) add(all[i], seen.frames[i].view);
            evaluator_.onStep(all, tracker_, 0.);
            hasLeft = hasLeft || robot_.T_w_b().translation().x() > 3.;
            return seen.time < 60. && !(hasLeft && pilot_.hasArrived(tracker_, seen.time));
        });
        return evaluator_.result().samples;
    }

  private:
    TrackerOptions trackerFor(const FlightOptions& options) const {
        TrackerOptions tracker = options.tracker;
        tracker.mapErrors = mapper_.errors();
        return tracker;
    }
    static PilotOptions pilotFor(const FlightOptions& options) {
        PilotOptions pilot = options.pilot;
        pilot.photometricGoal = false;
        pilot.clearance = [](const Eigen::Vector3d&) { return 1.; };
        return pilot;
    }
    static std::vector<PlannedView> plan(const Config& config) {
        const Pose there = levelPose(config.goal.position, 0.);
        const Pose here = levelPose(config.start.position, 0.);
        const double length = (there.translation() - here.translation()).norm();
        return {{.T_w_b = here, .covariance = Matrix6::Identity()},
                {.T_w_b = there, .covariance = Matrix6::Identity(), .distance = length},
                {.T_w_b = here, .covariance = Matrix6::Identity(), .distance = 2. * length}};
    }
    std::shared_ptr<const ViewSource> views() const {
        return std::make_shared<VoxelRenderer>(*map_.cells(), UnknownPolicy::free);
    }
    void add(const TrackedFrame& tracked, const View& image) {
        View shown;
        views()->render(robot_.camera(), tracked.T_c_w.mean, shown);
        const auto input = mapper_.choose(tracked, image, shown, false);
        if (!input) return;
        map_.add(*input, robot_.camera());
        mapper_.setFused(*input);
        tracker_.setMap(views());
        pilot_.setMap(views());
    }

    SimulatedRobot robot_;
    FlightEvaluator evaluator_;
    OnlineMap map_;
    Mapper mapper_;
    Tracker tracker_;
    Pilot pilot_;
    double timeStep_;
};

/// Standard deviation of the believed position [m].
double sigma(const FlightSample& sample) {
    return std::sqrt(sample.belief.covariance.topLeftCorner<3, 3>().trace());
}

TEST(OutAndBackTest, TheBeliefGrowsOnTheWayOutAndFallsWhereTheStartIsSeenAgain) {
    Config config = test::flightThroughRoom();
    config.goal.position.x() = 6.;
    const World world(corridor(), config);
    const PlanningProblem problem(config, world);
    const ExplorationSetup setup = setUpExploration(problem);
    const auto x = [&](const FlightSample& at) {
        return (setup.truth.T_b_c * at.T_c_w).inverse().translation().x();
    };
    double nees = 0.;
    constexpr int kFlights = 4;
    for (int seed = 1; seed <= kFlights; ++seed) {
        const auto samples = OutAndBack(setup.truth, setup.flight, config, seed).fly();
        const FlightSample& start = samples.at(2);
        const FlightSample& there = *std::ranges::max_element(samples, {}, x);
        const FlightSample& back = samples.back();
        EXPECT_GT(x(there), 5.8);
        EXPECT_LT(x(back), 1.2);
        EXPECT_GT(sigma(there), 2. * sigma(start));
        EXPECT_LT(sigma(back), 0.7 * sigma(there));
        for (const FlightSample& at : {there, back}) {
            nees += neesPerDof(at).value() / (2. * kFlights);
        }
    }
    EXPECT_LT(nees, 2.);
}

}  // namespace
}  // namespace photonav
