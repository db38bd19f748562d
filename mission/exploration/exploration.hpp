// SPDX-License-Identifier: BSD-3-Clause
// The flight of a simulated robot to a goal in a scene that it does not know.
#pragma once

#include "exploration/explorer.hpp"
#include "flight/flight_setup.hpp"

namespace photonav {

/// A flight of a simulated robot, against the truth. Its samples' distance is the length of the
/// true path.
struct ExplorationResult : FlightResult, ExplorationRecord {
    double wallSeconds = 0.;  ///< that it took to simulate
};

/// The unknown scene and the conditions of flight.
struct ExplorationSetup {
    Config config;
    FlightWorld truth;  ///< its map is not used
    FlightOptions flight;
};

/// @param problem of the config in its true World, which must outlive the setup
/// @throws InputError as explorerOptions() does, and for a start in collision
ExplorationSetup setUpExploration(const PlanningProblem& problem);

/// The part of a setup that is the robot's own.
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
    OnExplorationMoment moment = {};  ///< after `update`
};

/// Explores with a simulated robot. Deterministic for a seed.
/// @param planner as explorePlanner() takes it
ExplorationResult explore(const ExplorationSetup& setup, const std::string& planner,
                          std::uint32_t seed, const std::atomic<bool>& interrupted,
                          const OnExploration& on = {});

}  // namespace photonav
