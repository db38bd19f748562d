// SPDX-License-Identifier: BSD-3-Clause
// A flight to a goal in a scene that the robot does not know.
#pragma once

#include <atomic>
#include <functional>
#include <string>
#include <vector>

#include "exploration/online_planner.hpp"
#include "flight/flight_setup.hpp"

namespace photonav {

/// A flight, against the truth. Its samples' distance is the length of the true path.
struct ExplorationResult : FlightResult {
    std::string planner;
    std::uint32_t seed = 0;
    std::string reason;  ///< of an end that is not arrived
    int keyframes = 0;
    int blindSteps = 0;       ///< into space that could not be looked at first
    double wallSeconds = 0.;  ///< that it took to simulate
    std::vector<PlanUpdate> updates;
    std::shared_ptr<TexturedOcTree> map;  ///< that the robot made; empty: not kept
};

/// The unknown scene and the conditions of flight.
struct ExplorationSetup {
    Config config;
    FlightWorld truth;  ///< its map is not used
    FlightOptions flight;
};

/// @param problem of the config in its true World, which must outlive the setup
/// @throws InputError for a start in collision, and for headings of explore.planners where the
///         heading is not free
ExplorationSetup setUpExploration(const PlanningProblem& problem);

/// Called after every update of the plan.
using OnPlanUpdate = std::function<void(const ExplorationResult& soFar)>;

/// A flight right after an update of its plan, for logs and figures.
struct ExplorationMoment {
    const ExplorationResult& soFar;
    const OnlinePlanner& planner;
    const OwnMap& map;
    const MapChange& change;     ///< of the map, since the last moment
    const UncertainPose& T_c_w;  ///< believed
    const View& image;           ///< that was tracked last
    const View& predicted;       ///< view of the map before this update, from the believed pose
};
using OnExplorationMoment = std::function<void(const ExplorationMoment& moment)>;

/// Callbacks of a flight. They do not change it; each may be empty.
struct OnExploration {
    OnPlanUpdate update = {};
    OnExposure exposure = {};
    OnExplorationMoment moment = {};  ///< after `update`
};

/// Flies from start to goal with the robot's own camera as only sensor: the map is made, and the
/// plan repaired, as the scene comes into view. Deterministic for a seed: planning ends by work,
/// not by time.
/// @param planner as explorePlanner() takes it
ExplorationResult explore(const ExplorationSetup& setup, const std::string& planner,
                          std::uint32_t seed, const std::atomic<bool>& interrupted,
                          const OnExploration& on = {});

}  // namespace photonav
