// SPDX-License-Identifier: BSD-3-Clause
// The flight of a simulated robot to a goal in an unknown scene.
#pragma once

#include <limits>

#include "exploration/explorer.hpp"
#include "flight/flight_setup.hpp"

namespace photonav {

/// A flight of a simulated robot, evaluated against the ground truth. FlightSample::distance is the
/// length of the true path so far [m].
struct ExplorationResult : FlightResult, ExplorationRecord {
    double wallSeconds = 0.;  ///< wall-clock time of the simulation [s]
    /// Of a flight that arrived: see flownUntilDecided() [m].
    double decidedAfter = std::numeric_limits<double>::quiet_NaN();
};

/// The unknown scene and the conditions of flight.
struct ExplorationSetup {
    Config config;
    FlightWorld truth;  ///< the true world; FlightWorld::map is not used
    FlightOptions flight;
    std::shared_ptr<const TexturedOcTree> known;  ///< see ExplorerOptions::known
};

/// @param problem the config's problem in the true World, which must outlive the setup
/// @throws InputError as explorerOptions() does, and for a start in collision in the world or in
///         the known map
ExplorationSetup setUpExploration(const PlanningProblem& problem);

/// The options of the simulated robot in a setup, without the true world.
ExplorerOptions explorerOptions(const ExplorationSetup& setup);

/// Called after every update of the plan.
using OnPlanUpdate = std::function<void(const ExplorationResult& soFar)>;

/// A flight right after an update of its plan, for logs and figures.
struct ExplorationMoment : ExplorerMoment {
    const ExplorationResult& soFar;
};
using OnExplorationMoment = std::function<void(const ExplorationMoment& moment)>;

/// Callbacks of a flight. They do not change it; each may be empty.
struct OnExploration {
    OnPlanUpdate update = {};
    OnExposure exposure = {};
    OnExplorationMoment moment = {};  ///< after `update`; in real time by a second thread
};

/// Explores with a simulated robot. Deterministic for a seed, unless explore.realtime is set. When
/// interrupted, the result holds the flight so far and ends as FlightEnd::stopped.
/// @param planner a name for explorePlanner()
ExplorationResult explore(const ExplorationSetup& setup, const std::string& planner,
                          std::uint32_t seed, const std::atomic<bool>& interrupted,
                          const OnExploration& on = {});

}  // namespace photonav
