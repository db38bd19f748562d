// SPDX-License-Identifier: BSD-3-Clause
#include "exploration/explore_result.hpp"

#include "exploration/real_time_json.hpp"
#include "flight/flight_statistics.hpp"
#include "replanning/plan_update_json.hpp"
#include "result/json_values.hpp"

namespace photonav {
using nlohmann::json;
namespace {

json jsonOf(const PlanUpdate& update) {
    json result = untimedJson(update);
    result["fuse_ms"] = 1e3 * update.fuseSeconds;
    result["clearance_ms"] = 1e3 * update.clearanceSeconds;
    result["views_ms"] = 1e3 * update.viewSeconds;
    result["plan_ms"] = 1e3 * update.planSeconds;
    return result;
}

/// The trace of the belief over the path flown.
json traceOf(const ExplorationResult& flight, double characteristicLength) {
    json trace = json::array();
    for (const FlightSample& sample : flight.samples) {
        trace.push_back({{"time", sample.time},
                         {"distance", sample.distance},
                         {"trace", weightedTrace(sample.belief.covariance, characteristicLength)}});
    }
    return trace;
}

json jsonOf(const ExplorationResult& flight, double characteristicLength) {
    json updates = json::array();
    for (const PlanUpdate& update : flight.updates) updates.push_back(jsonOf(update));
    json result{{"planner", flight.planner},
                {"seed", flight.seed},
                {"arrived", flight.hasArrived()},
                {"end", nameOf(flight.end)},
                {"reason", flight.reason},
                {"collisions", flight.end == FlightEnd::collided ? 1 : 0},
                {"duration_s", flight.duration},
                {"length", flight.flown},
                {"goal_error_m", flight.goalError},
                {"arrival_probability", flight.arrivalProbability},
                {"decided_after_m", finiteOrNull(flight.decidedAfter)},
                {"position_rmse_m", finiteOrNull(positionRmse(flight))},
                {"nees_per_dof", finiteOrNull(neesPerDof(flight))},
                {"least_clearance_m", finiteOrNull(flight.leastClearance)},
                {"images", flight.images},
                {"rejected_images", flight.rejectedImages},
                {"keyframes", flight.keyframes},
                {"blind_steps", flight.blindSteps},
                {"times_lost", flight.timesLost},
                {"lost_s", flight.lostTime},
                {"wall_s", flight.wallSeconds},
                {"path_trace", traceOf(flight, characteristicLength)},
                {"updates", std::move(updates)}};
    if (flight.realTime) result["real_time"] = realTimeJson(*flight.realTime);
    return result;
}

json jsonOf(const ExplorationSummary& s) {
    return {{"planner", s.planner},
            {"flights", s.flights},
            {"arrived", s.arrived},
            {"collisions", s.collisions},
            {"position_rmse_m", finiteOrNull(s.positionRmse)},
            {"nees_per_dof", finiteOrNull(s.nees)},
            {"nees_median_flight_per_dof", finiteOrNull(s.neesMedian)},
            {"goal_error_m", finiteOrNull(s.goalError)},
            {"duration_s", finiteOrNull(s.duration)},
            {"length", finiteOrNull(s.length)},
            {"decided_after_m", finiteOrNull(s.decidedAfter)},
            {"mean_trace", finiteOrNull(s.meanTrace)},
            {"goal_trace", finiteOrNull(s.goalTrace)},
            {"update_median_ms", finiteOrNull(1e3 * s.updateMedian)},
            {"update_95_percent_ms", finiteOrNull(1e3 * s.update95)}};
}

}  // namespace

json exploreResult(const ExplorationSetup& setup, const ExplorationSet& outcome) {
    const std::vector<ExplorationResult>& flights = outcome.flights;
    const double length = setup.config.belief.characteristicLength;
    json result = resultJson("explore", jsonOf(flights.front(), length));
    result.update(
        {{"status", outcome.interrupted            ? "interrupted"
                    : flights.front().hasArrived() ? "done"
                                                   : "not arrived: " + flights.front().reason},
         {"seed", setup.config.seed},
         {"kappa", setup.config.belief.kappa},
         {"known_map", setup.known ? json(setup.config.mapFile) : json()},
         {"flights_ended", outcome.ended},
         {"flights_asked", outcome.asked},
         {"trials", json::array()},
         {"summary", json::array()}});
    for (const ExplorationResult& flight : flights) {
        result["trials"].push_back(jsonOf(flight, length));
    }
    for (const ExplorationSummary& s : outcome.summaries) result["summary"].push_back(jsonOf(s));
    return result;
}

}  // namespace photonav
