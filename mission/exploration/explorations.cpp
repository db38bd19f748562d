// SPDX-License-Identifier: BSD-3-Clause
#include "exploration/explorations.hpp"

#include <cmath>
#include <mutex>
#include <utility>

#include "evaluation/averages.hpp"
#include "flight/flight_statistics.hpp"
#include "runs/work_items.hpp"

namespace photonav {

void exploreMany(const ExplorationSetup& setup, const std::vector<TrialItem>& items, unsigned jobs,
                 const std::atomic<bool>& interrupted, const OnExplorations& on) {
    std::mutex mutex;  // of the callbacks
    const auto report = [&](const ExplorationResult& soFar) {
        const std::lock_guard lock(mutex);
        if (on.update) on.update(soFar);
    };
    workInOrder(items.size(), jobs, [&](std::size_t i) {
        if (interrupted && i > 0) return false;
        OnExploration onThis{.update = report};
        if (i == 0) onThis = {report, on.exposure, on.moment};
        ExplorationResult flight =
            explore(setup, items[i].planner, items[i].seed, interrupted, onThis);
        const std::lock_guard lock(mutex);
        if (on.end) on.end(std::move(flight));
        return true;
    });
}

double seconds(const PlanUpdate& update) {
    return update.fuseSeconds + update.clearanceSeconds + update.planSeconds;
}

ExplorationSummary summarise(std::span<const ExplorationResult> flights,
                             double characteristicLength) {
    ExplorationSummary s;
    s.flights = flights.size();
    if (flights.empty()) return s;
    s.planner = flights.front().planner;
    constexpr double kNoFlight = ExplorationSummary::kNone;
    std::vector<double> nees, goalErrors, durations, lengths, decided, traces, goalTraces, updates;
    double square = 0., samples = 0.;
    const auto traceOf = [&](const FlightSample& sample) {
        return weightedTrace(sample.belief.covariance, characteristicLength);
    };
    for (const ExplorationResult& flight : flights) {
        s.arrived += flight.hasArrived();
        s.collisions += flight.end == FlightEnd::collided;
        goalErrors.push_back(flight.goalError);
        durations.push_back(flight.duration);
        lengths.push_back(flight.flown);
        if (!std::isnan(flight.decidedAfter)) decided.push_back(flight.decidedAfter);
        for (const PlanUpdate& update : flight.updates) updates.push_back(seconds(update));
        if (flight.samples.empty()) continue;
        if (const double x = neesPerDof(flight); !std::isnan(x)) nees.push_back(x);
        const auto n = static_cast<double>(flight.samples.size());
        square += n * std::pow(positionRmse(flight), 2);
        samples += n;
        for (const FlightSample& sample : flight.samples) traces.push_back(traceOf(sample));
        goalTraces.push_back(traceOf(flight.samples.back()));
    }
    s.positionRmse = std::sqrt(square / samples);
    s.nees = mean(nees, kNoFlight);
    s.neesMedian = median(nees, kNoFlight);
    s.goalError = median(goalErrors, kNoFlight);
    s.duration = mean(durations, kNoFlight);
    s.length = mean(lengths, kNoFlight);
    s.decidedAfter = mean(decided, kNoFlight);
    s.meanTrace = mean(traces, kNoFlight);
    s.goalTrace = mean(goalTraces, kNoFlight);
    if (updates.empty()) return s;
    const Durations ofUpdates = summaryOf(std::move(updates));
    s.updateMedian = ofUpdates.median;
    s.update95 = ofUpdates.quantile95;
    return s;
}

std::vector<ExplorationSummary> summariesByPlanner(std::span<const ExplorationResult> flights,
                                                   double characteristicLength) {
    std::vector<ExplorationSummary> summaries;
    for (std::size_t first = 0; first < flights.size();) {
        std::size_t last = first;
        while (last < flights.size() && flights[last].planner == flights[first].planner) ++last;
        summaries.push_back(summarise(flights.subspan(first, last - first), characteristicLength));
        first = last;
    }
    return summaries;
}

}  // namespace photonav
