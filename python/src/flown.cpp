// SPDX-License-Identifier: BSD-3-Clause
#include "flown.hpp"

#include "conversions.hpp"
#include "flight/flight_setup.hpp"

namespace photonav::python {
namespace {

py::dict resultOf(const FlightResult& flight) {
    std::vector<double> times;
    std::vector<Eigen::Vector3d> truths, beliefs;
    for (const FlightSample& sample : flight.samples) {
        times.push_back(sample.time);
        truths.emplace_back(sample.T_c_w.inverse().translation());
        beliefs.emplace_back(sample.belief.mean.inverse().translation());
    }
    py::dict result;
    result["end"] = nameOf(flight.end);
    result["duration"] = flight.duration;
    result["goal_error"] = flight.goalError;
    result["lost"] = flight.lostTime;
    result["times_lost"] = flight.timesLost;
    result["nees"] = neesPerDof(flight);
    result["time"] = stacked(times);
    result["true_position"] = stacked(truths);
    result["believed_position"] = stacked(beliefs);
    return result;
}

}  // namespace

FlightSet flyAlong(const PlanningProblem& problem, const EvaluatedPath& path, unsigned flights,
                   unsigned jobs, const std::atomic<bool>& interrupted,
                   const std::function<void()>& onFlight) {
    const FlightSetup setup = setUpFlight(problem);
    FlightSet set{path, plannedViews(path.points), {}};
    set.flights = flyMany(set.plan, setup.world, setup.options, flights, jobs, interrupted,
                          [&](const FlightResult&) { onFlight(); });
    return set;
}

py::dict resultOf(const FlightSet& set) {
    const FlightSummary s = summarise(set);
    py::dict result;
    result["arrived"] = s.arrived;
    result["astray"] = s.astray;
    result["uncertain"] = s.uncertain;
    result["collisions"] = s.collisions;
    result["lost"] = s.lost;
    result["out_of_time"] = s.outOfTime;
    result["position_rmse"] = s.positionRmse;
    result["predicted_sigma"] = s.predictedSigma;
    result["nees"] = s.nees;
    result["goal_error"] = s.goalError;
    result["lost_time"] = s.lostTime;
    py::list flights;
    for (const FlightResult& flight : set.flights) flights.append(resultOf(flight));
    result["flights"] = flights;
    return result;
}

}  // namespace photonav::python
