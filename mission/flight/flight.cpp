// SPDX-License-Identifier: BSD-3-Clause
#include "flight/flight.hpp"

#include <algorithm>
#include <stdexcept>
#include <utility>

#include "flight/flight_loop.hpp"
#include "geometry/constants.hpp"
#include "geometry/gaussian.hpp"
#include "geometry/se3.hpp"

namespace photonav {
namespace {

void check(const std::vector<PlannedView>& plan, const FlightWorld& world) {
    if (plan.size() < 2) throw std::invalid_argument("flight: a plan has at least two views");
    const auto require = [](bool isGiven, const char* what) {
        if (!isGiven) throw std::invalid_argument(std::string("flight: the world has no ") + what);
    };
    require(world.truth != nullptr, "true views");
    require(world.map != nullptr, "map");
    require(world.clearance != nullptr, "clearance");
}

ImageNoise noiseOf(const FlightWorld& world, const FlightOptions& options) {
    return world.noise ? world.noise : assumedNoise(options.tracker.map.photometric);
}

UncertainPose beliefAtStart(const std::vector<PlannedView>& plan, const FlightWorld& world,
                            const FlightOptions& options) {
    return {(plan.front().T_w_b * world.T_b_c).inverse(), options.initialCovariance};
}

/// A flight of a plan, and its end.
class PlannedFlight {
  public:
    PlannedFlight(const FlightWorld& world, const FlightOptions& options, const PlannedView& goal,
                  const SimulatedRobot& robot)
        : options_(options),
          robot_(robot),
          goal_w_(goal.T_w_b.translation()),
          timeLimit_(60. + options.timePerMetre * goal.distance),
          evaluator_(world, robot, goal_w_) {}

    void onStep(const std::vector<TrackedFrame>& tracked, const Tracker& tracker,
                const Pilot& pilot);
    /// Whether the flight has ended, and how.
    bool hasEnded(const Tracker& tracker, const Pilot& pilot);
    FlightResult finish(const Tracker& tracker) {
        evaluator_.finish(tracker);
        return std::move(evaluator_.result());
    }

  private:
    bool endAs(FlightEnd end) {
        evaluator_.result().end = end;
        return true;
    }

    const FlightOptions& options_;
    const SimulatedRobot& robot_;
    Eigen::Vector3d goal_w_;
    double timeLimit_;
    FlightEvaluator evaluator_;
    Corrections corrections_;
};

void PlannedFlight::onStep(const std::vector<TrackedFrame>& tracked, const Tracker& tracker,
                           const Pilot& pilot) {
    evaluator_.onStep(tracked, tracker, pilot.route().distance());
    for (const TrackedFrame& frame : tracked) corrections_.add(frame);
    if (pilot.route().isAtGoal()) evaluator_.measureSpeed();
    FlightResult& result = evaluator_.result();
    if (pilot.hasServoedOnImage() && !std::exchange(result.photometric, true)) {
        result.goalErrorBefore = evaluator_.goalError();
    }
}

bool PlannedFlight::hasEnded(const Tracker& tracker, const Pilot& pilot) {
    const double time = robot_.time();
    if (evaluator_.result().leastClearance < options_.bodyRadius) return endAs(FlightEnd::collided);
    if (pilot.hasGivenUp(tracker, time)) return endAs(FlightEnd::lost);
    if (time > timeLimit_) return endAs(FlightEnd::outOfTime);
    if (!pilot.hasArrived(tracker, time)) return false;
    const double tolerance = options_.arrivalTolerance;
    const BelievedArrival arrival =
        believedArrival(tracker.belief(), robot_.T_b_c(), corrections_, goal_w_, tolerance);
    return endAs(evaluator_.endAtGoal(arrival, tolerance));
}

}  // namespace

Pose drawStart(const UncertainPose& start, const Pose& T_b_c, std::uint64_t seed) {
    std::mt19937_64 random(seedFor(seed, 0));
    const Pose T_c_w = expSE3(draw(rootOf(start.covariance), random)) * start.mean;
    return (T_b_c * T_c_w).inverse();
}

FlightEvaluator::FlightEvaluator(const FlightWorld& world, const SimulatedRobot& robot,
                                 const Eigen::Vector3d& goal_w)
    : world_(world), robot_(robot), goal_w_(goal_w), before_w_(robot.T_w_b().translation()) {
    result_.leastClearance = kInfinity;
}

void FlightEvaluator::onStep(const std::vector<TrackedFrame>& tracked, const Tracker& tracker,
                             double distance) {
    const Eigen::Vector3d p_w = robot_.T_w_b().translation();
    result_.flown += (p_w - std::exchange(before_w_, p_w)).norm();
    result_.leastClearance = std::min(result_.leastClearance, world_.clearance(p_w));
    if (robot_.exposed()) {
        result_.samples.push_back({robot_.time(), distance, robot_.T_c_w(), tracker.belief()});
    }
    for (const TrackedFrame& frame : tracked) {
        ++result_.images;
        result_.rejectedImages += frame.rejected;
        const auto sample =
            std::find_if(result_.samples.rbegin(), result_.samples.rend(),
                         [&](const FlightSample& s) { return s.time == frame.time; });
        sample->belief = frame.T_c_w;
        sample->image = frame.rejected ? ImageUse::rejected : ImageUse::used;
        if (!frame.rejected) sample->exposure = frame.alignment.exposure;
    }
}

FlightEnd FlightEvaluator::endAtGoal(const BelievedArrival& arrival, double tolerance,
                                     double confidence) {
    result_.believedGoal = arrival.position;
    result_.arrivalProbability = arrival.probability;
    if (arrival.probability < confidence) return FlightEnd::uncertain;
    return goalError() <= tolerance ? FlightEnd::arrived : FlightEnd::astray;
}

void FlightEvaluator::measureSpeed() {
    const double time = robot_.time();
    if (!result_.meanSpeed && time > 0.) result_.meanSpeed = result_.flown / time;
}

void FlightEvaluator::finish(const Tracker& tracker) {
    measureSpeed();
    result_.duration = robot_.time();
    result_.lostTime = tracker.loss().lostTime(robot_.time());
    result_.timesLost = tracker.loss().timesLost();
    result_.goalError = goalError();
}

FlightResult fly(const std::vector<PlannedView>& plan, const FlightWorld& world,
                 const FlightOptions& options, const IsStopped& isStopped,
                 const OnExposure& onExposure) {
    check(plan, world);
    const UncertainPose start = beliefAtStart(plan, world, options);
    SimulatedRobot robot(world.truth, world.camera, world.T_b_c,
                         drawStart(start, world.T_b_c, options.seed), noiseOf(world, options),
                         options.robot, options.seed);
    Tracker tracker = trackerOf(robot, world.map, start, options.tracker);
    Pilot pilot = pilotOf(robot, plan, world.map, options.pilot);
    PlannedFlight flight(world, options, plan.back(), robot);
    const auto onStep = [&](const Observation&, const std::vector<TrackedFrame>& tracked) {
        flight.onStep(tracked, tracker, pilot);
        if (onExposure && robot.exposed()) onExposure(*robot.exposed());
        const bool isAborted = isStopped && isStopped();
        return !isAborted && !flight.hasEnded(tracker, pilot);
    };
    flyLoop(robot, tracker, pilot, options.timeStep, onStep);
    return flight.finish(tracker);
}

}  // namespace photonav
