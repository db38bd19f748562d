// SPDX-License-Identifier: BSD-3-Clause
#include "figures/sweep_figures.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace photonav {
namespace {

struct Planner {
    std::string name;
    Color color;
    double extra;  ///< width, so that it is visible below those drawn upon it [px]
};

std::vector<Planner> plannersOf(const std::vector<std::string>& names) {
    std::vector<Planner> planners;
    planners.reserve(names.size());
    for (const std::string& name : names) {
        planners.push_back({name, plannerColor(name), 2.6 * static_cast<double>(planners.size())});
    }
    std::reverse(planners.begin(), planners.end());  // the first one is drawn on top
    return planners;
}

std::vector<Planner> plannersOf(const std::vector<SweepCell>& cells) {
    std::vector<std::string> names;
    for (const SweepCell& cell : cells) {
        if (names.empty() || names.back() != cell.planner) names.push_back(cell.planner);
    }
    return plannersOf(names);
}

/// What the three panels of sweepFigure() show.
struct Quantity {
    std::string column, label;
    bool log;
    double PaperRow::*paper;
};

struct Curve {
    Plot::Points means, whiskers;
};

Curve curveOf(const std::string& planner, const Quantity& quantity,
              const std::vector<SweepCell>& cells) {
    Curve curve;
    for (const SweepCell& cell : cells) {
        const Statistic value = cell.columns.at(quantity.column);
        if (cell.planner != planner || !std::isfinite(value.mean)) continue;
        curve.means.emplace_back(cell.alpha, value.mean);
        if (!(value.deviation > 0.)) continue;
        for (const double end : {value.mean - value.deviation, value.mean + value.deviation})
            curve.whiskers.emplace_back(cell.alpha, end);
    }
    std::sort(curve.means.begin(), curve.means.end(),
              [](const auto& a, const auto& b) { return a.x() < b.x(); });
    return curve;
}

Plot quantityPanel(const Quantity& quantity, const std::vector<SweepCell>& cells) {
    Plot plot;
    plot.x.label = "alpha";
    plot.y = {.log = quantity.log, .label = quantity.label};
    Plot::Points paper;
    for (const SweepCell& cell : cells)
        if (cell.paper) paper.emplace_back(cell.alpha, (*cell.paper).*quantity.paper);
    if (!paper.empty()) plot.dots(paper, {.width = 12., .name = "paper"});
    for (const Planner& planner : plannersOf(cells)) {
        const Curve curve = curveOf(planner.name, quantity, cells);
        plot.segments(curve.whiskers, {.color = planner.color, .width = 1.6});
        plot.curve(curve.means, {.color = planner.color, .width = 2.4 + planner.extra / 2.});
        plot.dots(curve.means,
                  {.color = planner.color, .width = 9. + planner.extra, .name = planner.name});
    }
    return plot;
}

/// Steps from one value to the next.
Plot::Points stepsOf(const BenchmarkCurve& curve) {
    Plot::Points steps;
    for (std::size_t i = 0; i < curve.cost.size(); ++i) {
        if (!std::isfinite(curve.cost[i])) continue;
        if (!steps.empty()) steps.emplace_back(curve.seconds[i], steps.back().y());
        steps.emplace_back(curve.seconds[i], curve.cost[i]);
    }
    return steps;
}

}  // namespace

Figure sweepFigure(const std::string& title, const std::vector<SweepCell>& cells) {
    Figure figure{title};
    for (const Quantity& quantity :
         {Quantity{"length", "length [m]", false, &PaperRow::length},
          Quantity{"mean_trace", "mean trace [m²]", true, &PaperRow::meanTrace},
          Quantity{"goal_trace", "goal trace [m²]", true, &PaperRow::goalTrace}})
        figure.rows.push_back({quantityPanel(quantity, cells)});
    return figure;
}

Figure frontFigure(const std::string& title, const std::vector<SweepCell>& cells,
                   const std::vector<SweepRun>& runs) {
    Plot plot;
    plot.height = 560.;
    plot.x.label = "length [m]";
    plot.y = {.log = true, .label = "mean trace [m²]"};
    Plot::Points paper;
    for (const SweepCell& cell : cells)
        if (cell.paper) paper.emplace_back(cell.paper->length, cell.paper->meanTrace);
    if (!paper.empty()) plot.dots(paper, {.width = 10., .name = "paper"});
    const auto at = [](const SweepCell& cell) {
        return Plot::Point(cell.columns.at("length").mean, cell.columns.at("mean_trace").mean);
    };
    for (const Planner& planner : plannersOf(cells)) {
        Plot::Points single, means, front;
        for (const SweepRun& run : runs)
            if (run.item.planner == planner.name && run.isSolved())
                single.emplace_back(run.length, run.meanTrace);
        for (const SweepCell& cell : cells)
            if (cell.planner == planner.name && cell.solved > 0) means.push_back(at(cell));
        for (const std::size_t i : paretoFront(planner.name, cells)) front.push_back(at(cells[i]));
        plot.dots(single, {.color = planner.color, .width = 7., .opacity = 0.3});
        plot.curve(front, {.color = planner.color});
        plot.dots(
            means,
            {.color = planner.color, .width = 10. + 2. * planner.extra, .name = planner.name});
    }
    return {title, {{plot}}};
}

Figure costOverTimeFigure(const std::string& title, const std::vector<std::string>& planners,
                          const std::vector<BenchmarkCurve>& curves) {
    Plot plot;
    plot.height = 480.;
    plot.x = {.log = true, .label = "time [s]"};
    plot.y.label = "cost of the best path";
    for (const Planner& planner : plannersOf(planners)) {
        for (const BenchmarkCurve& curve : curves) {
            const Plot::Points steps = stepsOf(curve);
            if (curve.planner != planner.name || steps.empty()) continue;
            plot.curve(steps, {.color = planner.color, .width = 1.8});
            plot.dots({steps.back()}, {.color = planner.color, .width = 8., .name = planner.name});
        }
    }
    return {title, {{plot}}};
}

std::map<double, const SweepRun*> cheapestRuns(const std::string& planner,
                                               const std::vector<SweepRun>& runs) {
    std::map<double, const SweepRun*> best;
    for (const SweepRun& run : runs) {
        if (run.item.planner != planner || !run.isSolved()) continue;
        const SweepRun*& known = best[run.item.alpha];
        if (known == nullptr || run.cost < known->cost) known = &run;
    }
    return best;
}

std::vector<std::size_t> paretoFront(const std::string& planner,
                                     const std::vector<SweepCell>& cells) {
    std::vector<std::size_t> members;
    for (std::size_t i = 0; i < cells.size(); ++i) {
        if (cells[i].planner == planner && cells[i].solved > 0) members.push_back(i);
    }
    const auto length = [&](std::size_t i) { return cells[i].columns.at("length").mean; };
    const auto trace = [&](std::size_t i) { return cells[i].columns.at("mean_trace").mean; };
    std::sort(members.begin(), members.end(), [&](std::size_t a, std::size_t b) {
        return std::pair(length(a), trace(a)) < std::pair(length(b), trace(b));
    });
    std::vector<std::size_t> front;
    for (const std::size_t i : members) {
        if (front.empty() || trace(i) < trace(front.back())) front.push_back(i);
    }
    return front;
}

}  // namespace photonav
