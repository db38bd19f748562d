// SPDX-License-Identifier: BSD-3-Clause
#include "figures/explore_figures.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "evaluation/averages.hpp"
#include "flight/flight_statistics.hpp"

namespace photonav {
namespace {

constexpr double kExploreWidth = 900., kExploreHeight = 240.;  // of a panel [px]
constexpr const char* kWay = "path flown [m]";

Plot panel(const std::string& label, bool isLog) {
    Plot plot;
    plot.width = kExploreWidth;
    plot.height = kExploreHeight;
    plot.x = {.min = 0., .label = kWay};
    plot.y = {.log = isLog, .label = label};
    return plot;
}

Style styleOf(const ExplorationResult& flight) {
    return {.color = plannerColor(flight.planner), .opacity = 0.7, .name = flight.planner};
}

constexpr int kShares = 100;      // of the way, that bands are drawn at
constexpr double kInBand = 0.95;  // of the flights

/// Trace of the belief at a distance, between the samples of a flight.
double traceAt(const std::vector<FlightSample>& samples, double distance, double length) {
    const auto after =
        std::lower_bound(samples.begin(), samples.end(), distance,
                         [](const FlightSample& sample, double d) { return sample.distance < d; });
    const auto trace = [&](const FlightSample& sample) {
        return weightedTrace(sample.belief.covariance, length);
    };
    if (after == samples.begin()) return trace(samples.front());
    if (after == samples.end()) return trace(samples.back());
    const FlightSample& before = *std::prev(after);
    const double share = (distance - before.distance) / (after->distance - before.distance);
    return trace(before) + share * (trace(*after) - trace(before));
}

/// @param values sorted
double quantile(const std::vector<double>& values, double share) {
    const double at = share * static_cast<double>(values.size() - 1);
    const auto low = static_cast<std::size_t>(at);
    const std::size_t high = std::min(low + 1, values.size() - 1);
    return values[low] + (at - static_cast<double>(low)) * (values[high] - values[low]);
}

/// Adds the flights of a planner.
void addBand(Plot& plot, const std::vector<const ExplorationResult*>& flights, double length) {
    Plot::Points low, middle, high;
    for (int i = 0; i <= kShares; ++i) {
        const double share = static_cast<double>(i) / kShares;
        std::vector<double> traces;
        for (const ExplorationResult* flight : flights) {
            const double way = flight->samples.back().distance;
            traces.push_back(traceAt(flight->samples, share * way, length));
        }
        std::sort(traces.begin(), traces.end());
        low.emplace_back(share, quantile(traces, 0.5 * (1. - kInBand)));
        middle.emplace_back(share, mean(traces, 0.));
        high.emplace_back(share, quantile(traces, 0.5 * (1. + kInBand)));
    }
    Style style = styleOf(*flights.front());
    style.opacity = 1.;
    style.width = 2.6;
    if (flights.size() > 1) {
        style.name = fmt::format("{}, {} flights", flights.front()->planner, flights.size());
        plot.band(low, high, {.color = style.color, .opacity = 0.2});
    }
    plot.curve(middle, style);
}

}  // namespace

DrawnTree drawnWay(const ExplorationResult& flight) {
    const auto darker = [](std::uint8_t level) { return static_cast<std::uint8_t>(level * 3 / 5); };
    const Color color = plannerColor(flight.planner);
    DrawnTree way{"true path, " + flight.planner,
                  {darker(color.red), darker(color.green), darker(color.blue)},
                  {},
                  true};
    const auto at = [&](std::size_t i) -> Eigen::Vector3f {
        return flight.samples[i].T_c_w.inverse().translation().cast<float>();
    };
    for (std::size_t i = 1; i < flight.samples.size(); ++i) way.edges.push_back({at(i - 1), at(i)});
    return way;
}

DrawnPath drawnBeliefs(const ExplorationResult& flight, double characteristicLength) {
    constexpr double kApart = 0.1;  // [m]
    DrawnPath path{"believed path", plannerColor(flight.planner)};
    double last = -kApart;
    for (const FlightSample& sample : flight.samples) {
        const bool isLast = &sample == &flight.samples.back();
        if (sample.distance < last + kApart && !isLast) continue;
        last = sample.distance;
        const double trace = weightedTrace(sample.belief.covariance, characteristicLength);
        path.points.push_back(makePathPoint(sample.belief, trace, sample.distance, 0.));
    }
    return path;
}

Figure explorationFigure(const std::vector<ExplorationResult>& flights,
                         double characteristicLength) {
    Plot traces = panel("trace of the belief [m²]", true);
    Plot nees = panel("NEES per degree of freedom", true);
    Plot updates = panel("time of an update [s]", true);
    nees.curve({{0., 0.5}, {0., 2.}}, {.width = 0.});  // at least this range
    for (const ExplorationResult& flight : flights) {
        Plot::Points ofTrace, ofNees, ofUpdate;
        for (const FlightSample& sample : flight.samples) {
            const double trace = weightedTrace(sample.belief.covariance, characteristicLength);
            ofTrace.emplace_back(sample.distance, trace);
            if (const auto value = neesPerDof(sample)) ofNees.emplace_back(sample.distance, *value);
        }
        for (const PlanUpdate& update : flight.updates) {
            const auto sample =
                std::lower_bound(flight.samples.begin(), flight.samples.end(), update.time,
                                 [](const FlightSample& s, double time) { return s.time < time; });
            if (sample == flight.samples.end()) continue;
            ofUpdate.emplace_back(sample->distance, seconds(update));
        }
        traces.curve(ofTrace, styleOf(flight));
        nees.curve(ofNees, styleOf(flight));
        updates.dots(ofUpdate, {.color = plannerColor(flight.planner), .width = 5.});
    }
    return {"Beliefs along the path", {{traces}, {nees}, {updates}}};
}

Figure traceBandsFigure(const std::vector<ExplorationResult>& flights,
                        double characteristicLength) {
    Plot plot = panel("trace of the belief [m²]", true);
    plot.height = 340.;
    plot.x = {.min = 0., .max = 1., .label = "share of the path flown"};
    std::map<std::string, std::vector<const ExplorationResult*>> ofPlanner;
    for (const ExplorationResult& flight : flights) {
        if (!flight.samples.empty()) ofPlanner[flight.planner].push_back(&flight);
    }
    for (const auto& [planner, own] : ofPlanner) addBand(plot, own, characteristicLength);
    return {"Uncertainty over the share of the distance flown", {{plot}}};
}

}  // namespace photonav
