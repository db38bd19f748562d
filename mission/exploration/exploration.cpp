// SPDX-License-Identifier: BSD-3-Clause
#include "exploration/exploration.hpp"

#include <fmt/format.h>

#include "exploration/homotopy.hpp"
#include "io/stopwatch.hpp"
#include "render/interruptible_views.hpp"

namespace photonav {
namespace {

/// An explorer with a simulated robot, and the comparison with the truth.
class Exploration {
  public:
    Exploration(const ExplorationSetup& setup, const std::string& planner, std::uint32_t seed,
                const std::atomic<bool>& interrupted, const OnExploration& on);
    ExplorationResult run();

  private:
    bool onStep(const Observation& observation, const std::vector<TrackedFrame>& tracked);
    bool hasCollided() const {
        return evaluator_.result().leastClearance < setup_.flight.bodyRadius;
    }
    void enterEnd();
    const ExplorationResult& resultSoFar();
    OnExplorer onExplorer();
    IsStopped isStopped() const {
        return [&flag = interrupted_] { return flag.load(); };
    }
    std::shared_ptr<const ViewSource> truth() const {
        return std::make_shared<InterruptibleViews>(setup_.truth.truth, isStopped());
    }
    SimulatedRobotOptions robotOptions() const {
        SimulatedRobotOptions options = setup_.flight.robot;
        options.camera.isStopped = isStopped();
        return options;
    }

    const ExplorationSetup& setup_;
    const std::atomic<bool>& interrupted_;
    const OnExploration& on_;
    SimulatedRobot robot_;
    FlightEvaluator evaluator_;
    ExplorationResult result_;
    ExplorationResult atUpdate_;  // in real time: result_ at the last update, for on_.moment
    Explorer explorer_;           // last: its second thread ends first
};

Exploration::Exploration(const ExplorationSetup& setup, const std::string& planner,
                         std::uint32_t seed, const std::atomic<bool>& interrupted,
                         const OnExploration& on)
    : setup_(setup),
      interrupted_(interrupted),
      on_(on),
      robot_(truth(), setup.truth.camera, setup.truth.T_b_c,
             drawStart(beliefAtTakeOff(setup.config), setup.truth.T_b_c, seed), setup.truth.noise,
             robotOptions(), seed),
      evaluator_(setup.truth, robot_, setup.config.goal.position),
      explorer_(explorerOptions(setup), robot_, planner, seed, interrupted, onExplorer()) {}

ExplorationResult Exploration::run() {
    const bool isDone = explorer_.fly(robot_, setup_.flight.timeStep,
                                      [this](const auto& observation, const auto& tracked) {
                                          return onStep(observation, tracked);
                                      });
    evaluator_.finish(explorer_.tracker());
    resultSoFar();
    if (isDone) {
        enterEnd();
    } else {
        result_.reason = "interrupted";
    }
    return std::move(result_);
}

bool Exploration::onStep(const Observation& observation, const std::vector<TrackedFrame>& tracked) {
    if (on_.exposure && robot_.exposed()) on_.exposure(*robot_.exposed());
    evaluator_.onStep(tracked, explorer_.tracker(), evaluator_.result().flown);
    return explorer_.onStep(observation, tracked) && !hasCollided();
}

/// Compares the end of the flight with the ground truth, which the robot does not know.
void Exploration::enterEnd() {
    if (hasCollided()) {
        result_.end = FlightEnd::collided;
        result_.reason = fmt::format("an obstacle {:.2f} m away", result_.leastClearance);
        return;
    }
    result_.end = explorer_.end().value();
    if (!explorer_.arrival()) return;
    result_.believedGoal = explorer_.arrival()->position;
    result_.arrivalProbability = explorer_.arrival()->probability;
    if (result_.end != FlightEnd::arrived) return;
    if (evaluator_.goalError() <= setup_.config.explore.goalTolerance) {
        const HomotopyClasses classes(setup_.truth.clearance, setup_.config.robotRadius,
                                      setup_.config.bounds);
        result_.decidedAfter = flownUntilDecided(result_, setup_.truth.T_b_c, classes);
        return;
    }
    result_.end = FlightEnd::astray;
    result_.reason = fmt::format("the pose was {:.2f} m wrong at the goal", result_.goalError);
}

const ExplorationResult& Exploration::resultSoFar() {
    static_cast<FlightResult&>(result_) = evaluator_.result();
    static_cast<ExplorationRecord&>(result_) = explorer_.record();
    return result_;
}

/// A moment may be shown by another thread while this one flies on and changes the result.
OnExplorer Exploration::onExplorer() {
    OnExplorer on;
    const bool isShownBeside = on_.moment && setup_.config.explore.realtime;
    on.update = [this, isShownBeside](const auto&) {
        const ExplorationResult& soFar = resultSoFar();
        if (on_.update) on_.update(soFar);
        if (isShownBeside) atUpdate_ = soFar;
    };
    if (on_.moment) {
        const ExplorationResult& shown = isShownBeside ? atUpdate_ : result_;
        on.moment = [this, &shown](const ExplorerMoment& m) { on_.moment({m, shown}); };
    }
    return on;
}

}  // namespace

ExplorationResult explore(const ExplorationSetup& setup, const std::string& planner,
                          std::uint32_t seed, const std::atomic<bool>& interrupted,
                          const OnExploration& on) {
    const Stopwatch watch;
    ExplorationResult flight = Exploration(setup, planner, seed, interrupted, on).run();
    flight.wallSeconds = watch.seconds();
    return flight;
}

}  // namespace photonav
