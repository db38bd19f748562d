// SPDX-License-Identifier: BSD-3-Clause
#include "comparisons/sweep_report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "figures/sweep_figures.hpp"
#include "geometry/constants.hpp"
#include "io/atomic_file.hpp"
#include "io/interrupted.hpp"
#include "report/problem_report.hpp"
#include "result/json_values.hpp"
#include "result/text_table.hpp"

namespace photonav {
namespace fs = std::filesystem;
using nlohmann::json;
namespace {

/// "1 seed", "2 seeds".
std::string counted(std::size_t count, const std::string& noun, const std::string& rest = "") {
    return fmt::format("{} {}{}{}", count, noun, count == 1 ? "" : "s", rest);
}

constexpr const char* kBlank = "-";  // in the table

/// The cheapest path of the first planner for every alpha with its beliefs, coloured from dark
/// (alpha 0) to bright (1). Runs keep headings alone: in se3 the beliefs are those of level flight.
/// Without them if the sweep was interrupted and its views are large.
std::vector<DrawnPath> pathsByAlpha(const Config& config, const World& world,
                                    const SweepOutcome& outcome) {
    const std::atomic<bool> interrupted = outcome.interrupted;
    std::vector<DrawnPath> paths;
    PlanningProblem problem(config, world);  // whose views all share
    for (const auto& [alpha, run] : cheapestRuns(config.sweep.planners.front(), outcome.runs)) {
        try {
            const EvaluatedPath path =
                PlanningProblem(problem, alpha).evaluate("", run->path, interrupted);
            paths.push_back(drawnPath(path, config.camera.T_b_c()));
        } catch (const Interrupted&) {
            return {};
        }
        paths.back().name = fmt::format("alpha {}", alpha);
        paths.back().color = viridis(0.94 * alpha);
    }
    return paths;
}

TopView pathsView(const Config& config, const World& world, const std::vector<DrawnPath>& paths) {
    TopView view = viewFromAbove(config, world, paths);
    view.title = fmt::format("{}: the cheapest path per alpha", config.sweep.planners.front());
    view.ellipseScale = view.horizontalFov = 0.;
    return view;
}

/// "12.34 +- 0.05" with a fixed number of decimals, the deviation only where there is one.
std::string cellText(const Statistic& value, double scale, int decimals) {
    if (!std::isfinite(value.mean)) return kBlank;
    const std::string mean = fmt::format("{:.{}f}", scale * value.mean, decimals);
    if (!std::isfinite(value.deviation)) return mean;
    return fmt::format("{} ± {:.{}f}", mean, scale * value.deviation, decimals);
}

/// A column of the table.
struct TextColumn {
    std::string heading;
    std::function<std::string(const SweepCell&)> text;
};

TextColumn ownColumn(const std::string& heading, const std::string& name, double scale,
                     int decimals) {
    return {heading, [=](const SweepCell& cell) {
                return cellText(cell.columns.at(name), scale, decimals);
            }};
}

TextColumn paperColumn(double PaperRow::*value, int decimals) {
    return {"paper", [=](const SweepCell& cell) {
                const bool isBeside = cell.paper && cell.solved > 0;  // a value of ours
                return isBeside ? fmt::format("{:.{}f}", (*cell.paper).*value, decimals) : "";
            }};
}

/// The columns that are not empty for a planner.
std::vector<TextColumn> textColumns(const std::vector<SweepCell>& cells, int decimals) {
    std::vector<TextColumn> columns{
        {"alpha", [](const SweepCell& cell) { return fmt::format("{}", cell.alpha); }},
        {"solved",
         [](const SweepCell& cell) { return fmt::format("{}/{}", cell.solved, cell.runs); }},
        ownColumn("J", "cost", 1., 3),
        ownColumn("length [m]", "length", 1., 2),
        paperColumn(&PaperRow::length, 2),
        ownColumn("mean trace", "mean_trace", 1., decimals),
        paperColumn(&PaperRow::meanTrace, decimals),
        ownColumn("goal trace", "goal_trace", 1., decimals),
        paperColumn(&PaperRow::goalTrace, decimals),
        ownColumn("excess [%]", "excess", 100., 2),
        ownColumn("vertices", "vertices", 1., 0),
        ownColumn("views", "views", 1., 0),
        ownColumn("seconds", "seconds", 1., 2)};
    std::erase_if(columns, [&](const TextColumn& column) {
        return std::all_of(cells.begin(), cells.end(), [&](const SweepCell& cell) {
            const std::string text = column.text(cell);
            return text.empty() || text == kBlank;
        });
    });
    return columns;
}

TextTable textTable(const std::vector<SweepCell>& cells, int decimals) {
    const std::vector<TextColumn> columns = textColumns(cells, decimals);
    TextTable table;
    for (const TextColumn& column : columns) table.head.push_back(column.heading);
    for (const SweepCell& cell : cells) {
        std::vector<std::string>& row = table.rows.emplace_back();
        for (const TextColumn& column : columns) row.push_back(column.text(cell));
    }
    return table;
}

}  // namespace

void writeSweepReport(const fs::path& folder, const Config& config, const World& world,
                      const SweepOutcome& outcome, const ReferenceCosts& reference,
                      const json& result) {
    const auto cells = summarize(config.sweep, outcome.runs, reference);
    ReportData report = problemReport(config, world, outcome.commandLine, result);
    report.title = outcome.name;
    report.subtitle =
        fmt::format("{} of {} vertices: {}, {}, {}", counted(outcome.runs.size(), "run"),
                    config.vertices, counted(config.sweep.planners.size(), "planner"),
                    counted(config.sweep.alphas.size(), "value", " of alpha"),
                    counted(config.sweep.runs, "seed"));
    report.paths = pathsByAlpha(config, world, outcome);

    writeSweepTables(folder, result, reference);
    writeFigure(folder, "sweep", sweepFigure(outcome.name, cells));
    writeFigure(folder, "pareto", frontFigure(outcome.name, cells, outcome.runs));
    writeResultFolder(
        folder, report,
        {{"paths",
          "The cheapest path of " + config.sweep.planners.front() + " for every alpha, from above.",
          topViewFigure(pathsView(config, world, report.paths))}});
}

std::string sweepTable(const std::vector<SweepCell>& cells) {
    std::string text;
    const int decimals = traceDecimals(cells);
    for (auto first = cells.begin(); first != cells.end();) {
        const auto last = std::find_if(
            first, cells.end(), [&](const SweepCell& c) { return c.planner != first->planner; });
        text += "\n" + first->planner + "  (traces in m²)\n";
        text += alignedText(textTable({first, last}, decimals));
        first = last;
    }
    return text;
}

}  // namespace photonav
