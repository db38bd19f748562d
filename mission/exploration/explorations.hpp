// SPDX-License-Identifier: BSD-3-Clause
// Many explorations of a scene, and their numbers.
#pragma once

#include <compare>
#include <limits>
#include <span>

#include "exploration/exploration.hpp"

namespace photonav {

/// One flight of an unknown scene.
struct TrialItem {
    std::string planner;  ///< as explorePlanner() takes it
    std::uint32_t seed = 1;
    auto operator<=>(const TrialItem&) const = default;
};
inline TrialItem itemOf(const ExplorationResult& flight) { return {flight.planner, flight.seed}; }

/// The planners that a config compares: planner.name alone where no others are named.
std::vector<std::string> plannersOf(const Config& config);

/// All flights that a config asks for: planner by planner, seed by seed from the config's on.
/// @throws InputError for seeds beyond the last one
std::vector<TrialItem> trialItems(const Config& config);

/// Called while scenes are explored, one at a time; each may be empty.
struct OnExplorations {
    std::function<void(ExplorationResult)> end = {};  ///< as flights end, in any order
    OnPlanUpdate update = {};
    OnExposure exposure = {};         ///< of the first item
    OnExplorationMoment moment = {};  ///< of the first item
};

/// Flies `items` on `jobs` threads. When interrupted, flights end as FlightEnd::stopped and no
/// others begin, but the first.
void exploreMany(const ExplorationSetup& setup, const std::vector<TrialItem>& items, unsigned jobs,
                 const std::atomic<bool>& interrupted, const OnExplorations& on);

/// Wall-clock time of an update: fusion, clearance, views and planning [s].
double seconds(const PlanUpdate& update);

/// Over the flights of a planner. Numbers are NaN where no flight gave one.
struct ExplorationSummary {
    static constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

    std::string planner;
    std::size_t flights = 0, arrived = 0, collisions = 0;
    double positionRmse = kNone;  ///< over all exposures [m]
    double nees = kNone;          ///< per degree of freedom, mean over the flights
    double neesMedian = kNone;    ///< of the median flight
    double goalError = kNone;     ///< median [m]
    double duration = kNone;      ///< mean [s]
    double length = kNone;        ///< mean [m]
    double meanTrace = kNone;     ///< of the beliefs, over all exposures
    double goalTrace = kNone;     ///< of the last beliefs, mean
    double updateMedian = kNone, update95 = kNone;  ///< wall-clock time of an update [s]
};
/// @param flights of one planner
ExplorationSummary summarise(std::span<const ExplorationResult> flights,
                             double characteristicLength);

/// One for each planner, in the order of the flights.
/// @param flights those of a planner one after the other, as in trialItems()
std::vector<ExplorationSummary> summariesByPlanner(std::span<const ExplorationResult> flights,
                                                   double characteristicLength);

}  // namespace photonav
