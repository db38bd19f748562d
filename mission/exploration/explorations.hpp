// SPDX-License-Identifier: BSD-3-Clause
// Many exploration flights in one scene, and their statistics.
#pragma once

#include <compare>
#include <limits>
#include <span>

#include "exploration/exploration.hpp"

namespace photonav {

/// One flight in an unknown scene.
struct TrialItem {
    std::string planner;  ///< a name for explorePlanner()
    std::uint32_t seed = 1;
    auto operator<=>(const TrialItem&) const = default;
};
inline TrialItem itemOf(const ExplorationResult& flight) { return {flight.planner, flight.seed}; }
/// "rrt_star seed 3"
std::string nameOf(const TrialItem& item);

/// The planners that a config compares: explore.planners, or planner.name if that list is empty.
std::vector<std::string> plannersOf(const Config& config);

/// All flights of a config: for each planner, explore.trials flights with the seeds seed,
/// seed + 1, ...
/// @throws InputError for seeds above the largest 32-bit number
std::vector<TrialItem> trialItems(const Config& config);

/// Callbacks of exploreMany(); each may be empty. `end` and `update` are never called by two
/// threads at a time.
struct OnExplorations {
    std::function<void(ExplorationResult)> end = {};  ///< called when a flight ends, in any order
    OnPlanUpdate update = {};                         ///< called for all flights
    OnExposure exposure = {};                         ///< called for the first item only
    OnExplorationMoment moment = {};                  ///< called for the first item only
};

/// Flies `items` on `jobs` threads. When interrupted, running flights end as FlightEnd::stopped and
/// no other flight begins; only the first item is always flown, even if it is stopped at once.
void exploreMany(const ExplorationSetup& setup, const std::vector<TrialItem>& items, unsigned jobs,
                 const std::atomic<bool>& interrupted, const OnExplorations& on);

/// Wall-clock time of an update: fusion, clearance, views and planning [s].
double seconds(const PlanUpdate& update);

/// Statistics of the flights of one planner. A number is NaN if no flight has a value for it.
struct ExplorationSummary {
    static constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

    std::string planner;
    std::size_t flights = 0, arrived = 0, collisions = 0;
    double positionRmse = kNone;  ///< over all exposures of all flights [m]
    double nees = kNone;          ///< per degree of freedom: mean over the flights
    double neesMedian = kNone;    ///< per degree of freedom: median over the flights
    double goalError = kNone;     ///< true distance to the goal at the end: median [m]
    double duration = kNone;      ///< mean [s]
    double length = kNone;        ///< length of the true path: mean [m]
    /// Of the flights that arrived on a way that was planned: see flownUntilDecided(): mean [m]
    double decidedAfter = kNone;
    double meanTrace = kNone;  ///< weighted trace of the belief: mean over all exposures [m^2]
    double goalTrace = kNone;  ///< weighted trace at the last exposure: mean [m^2]
    /// Wall-clock time of an update of the plan: median and 95 % quantile [s].
    double updateMedian = kNone, update95 = kNone;
};
/// @param flights flights of one planner
/// @param characteristicLength see weightedTrace() [m]
ExplorationSummary summarise(std::span<const ExplorationResult> flights,
                             double characteristicLength);

/// One summary per planner, in the order of the flights.
/// @param flights grouped by planner, as in trialItems()
/// @param characteristicLength see weightedTrace() [m]
std::vector<ExplorationSummary> summariesByPlanner(std::span<const ExplorationResult> flights,
                                                   double characteristicLength);

}  // namespace photonav
