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

void check(const FlightWorld& world) {
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

/// Body pose drawn from the belief.
Pose drawStart(const UncertainPose& start, const Pose& T_b_c, std::uint64_t seed) {
    std::mt19937_64 random(seedFor(seed, 0));
    const Pose T_c_w = expSE3(draw(rootOf(start.covariance), random)) * start.mean;
    return T_c_w.inverse() * T_b_c.inverse();
}

TrackerOptions trackerOptions(const FlightWorld& world, const FlightOptions& options) {
    TrackerOptions tracker = options.tracker;
    tracker.T_b_c = world.T_b_c;
    return tracker;
}

/// Compares a flight with the truth as it goes on.
class FlightEvaluator {
  public:
    FlightEvaluator(const FlightWorld& world, const FlightOptions& options, const PlannedView& goal,
                    const SimulatedRobot& robot)
        : world_(world),
          options_(options),
          goal_(goal),
          robot_(robot),
          timeLimit_(60. + options.timePerMetre * goal.distance),
          before_w_(robot.T_w_b().translation()) {
        result_.leastClearance = kInfinity;
    }

    void onStep(const std::vector<TrackedFrame>& tracked, const Tracker& tracker,
                const Pilot& pilot);
    /// Whether the flight has ended, and how.
    bool hasEnded(const Tracker& tracker, const Pilot& pilot);
    FlightResult finish(const Tracker& tracker);

  private:
    double goalError() const {
        return (robot_.T_w_b().translation() - goal_.T_w_b.translation()).norm();
    }
    bool endAs(FlightEnd end) {
        result_.end = end;
        return true;
    }

    const FlightWorld& world_;
    const FlightOptions& options_;
    PlannedView goal_;
    const SimulatedRobot& robot_;
    double timeLimit_;
    Eigen::Vector3d before_w_;
    FlightResult result_;
};

void FlightEvaluator::onStep(const std::vector<TrackedFrame>& tracked, const Tracker& tracker,
                             const Pilot& pilot) {
    const Eigen::Vector3d p_w = robot_.T_w_b().translation();
    result_.way += (p_w - std::exchange(before_w_, p_w)).norm();
    result_.leastClearance = std::min(result_.leastClearance, world_.clearance(p_w));
    if (robot_.exposed()) {
        const UncertainPose belief = tracker.belief();
        result_.samples.push_back(
            {robot_.time(), pilot.route().progress(belief.mean), robot_.T_c_w(), belief});
    }
    for (const TrackedFrame& frame : tracked) {
        ++result_.images;
        result_.rejectedImages += frame.lost;
        const auto sample =
            std::find_if(result_.samples.rbegin(), result_.samples.rend(),
                         [&](const FlightSample& s) { return s.time == frame.time; });
        sample->belief = frame.T_c_w;
        sample->distance = pilot.route().progress(frame.T_c_w.mean);
    }
    if (pilot.hasServoedOnImage() && !std::exchange(result_.photometric, true)) {
        result_.goalErrorBefore = goalError();
    }
}

bool FlightEvaluator::hasEnded(const Tracker& tracker, const Pilot& pilot) {
    const double time = robot_.time();
    if (result_.leastClearance < options_.bodyRadius) return endAs(FlightEnd::collided);
    if (pilot.hasGivenUp(tracker, time)) return endAs(FlightEnd::lost);
    if (time > timeLimit_) return endAs(FlightEnd::outOfTime);
    if (!pilot.hasArrived(tracker, time)) return false;
    return endAs(goalError() <= options_.arrivalTolerance ? FlightEnd::arrived : FlightEnd::astray);
}

FlightResult FlightEvaluator::finish(const Tracker& tracker) {
    result_.duration = robot_.time();
    result_.lost = tracker.loss().lostTime(robot_.time());
    result_.timesLost = tracker.loss().timesLost();
    result_.goalError = goalError();
    return std::move(result_);
}

}  // namespace

std::string nameOf(FlightEnd end) {
    switch (end) {
        case FlightEnd::arrived:
            return "arrived";
        case FlightEnd::astray:
            return "astray";
        case FlightEnd::collided:
            return "collided";
        case FlightEnd::lost:
            return "lost";
        case FlightEnd::outOfTime:
            return "out of time";
        case FlightEnd::stopped:
            break;
    }
    return "stopped";
}

FlightResult fly(const std::vector<PlannedView>& plan, const FlightWorld& world,
                 const FlightOptions& options, const std::function<bool()>& isStopped,
                 const OnExposure& onExposure) {
    check(world);
    Pilot pilot(plan, world.map, world.camera, world.T_b_c, options.pilot);
    const UncertainPose start = beliefAtStart(plan, world, options);
    SimulatedRobot robot(world.truth, world.camera, world.T_b_c,
                         drawStart(start, world.T_b_c, options.seed), noiseOf(world, options),
                         options.robot, options.seed);
    Tracker tracker(world.map, robot.camera(), start, trackerOptions(world, options));
    FlightEvaluator evaluator(world, options, plan.back(), robot);
    flyLoop(robot, tracker, pilot, options.timeStep, [&](const std::vector<TrackedFrame>& tracked) {
        evaluator.onStep(tracked, tracker, pilot);
        if (onExposure && robot.exposed()) onExposure(*robot.exposed());
        const bool isAborted = isStopped && isStopped();
        return !isAborted && !evaluator.hasEnded(tracker, pilot);
    });
    return evaluator.finish(tracker);
}

}  // namespace photonav
