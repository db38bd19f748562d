// SPDX-License-Identifier: BSD-3-Clause
#include "report/explore_figures.hpp"

#include <algorithm>

#include "flight/flight_statistics.hpp"

namespace photonav {
namespace {

constexpr double kExploreWidth = 900., kExploreHeight = 240.;  // of a panel [px]
constexpr const char* kWay = "way flown [m]";

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

}  // namespace

DrawnTree drawnWay(const ExplorationResult& flight) {
    const auto darker = [](std::uint8_t level) { return static_cast<std::uint8_t>(level * 3 / 5); };
    const Color color = plannerColor(flight.planner);
    DrawnTree way{"true way, " + flight.planner,
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
    DrawnPath path{"believed way", plannerColor(flight.planner)};
    double last = -kApart;
    for (const FlightSample& sample : flight.samples) {
        const bool isLast = &sample == &flight.samples.back();
        if (sample.distance < last + kApart && !isLast) continue;
        last = sample.distance;
        const double trace = weightedTrace(sample.belief.covariance, characteristicLength);
        path.points.push_back(makePathPoint(sample.belief, trace, sample.distance, sample.time));
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
    return {"Beliefs along the way", {{traces}, {nees}, {updates}}};
}

}  // namespace photonav
