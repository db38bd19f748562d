// SPDX-License-Identifier: BSD-3-Clause
#include "plans/plan_command.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "io/error.hpp"
#include "io/stopwatch.hpp"
#include "mapping/map_config.hpp"
#include "planners/planner_table.hpp"
#include "plans/plan_progress.hpp"
#include "plans/plan_report.hpp"
#include "problem/advantage.hpp"
#include "problem/tree_evolution.hpp"
#include "shared/command_io.hpp"
#include "shared/result_folder.hpp"

namespace photonav {
namespace {

/// @param status PlanningProblem::statusOf()
void printSummary(const PlanOutcome& outcome, const std::string& status,
                  const std::optional<EvaluatedPath>& baseline, double kappa, bool audit,
                  double seconds) {
    const auto row = [](const EvaluatedPath& path) {
        fmt::print("{:<16} {:>8.2f} m {:>15.3g} {:>15.3g} {:>10.4g}\n", path.planner, path.length,
                   path.meanTrace, path.goalTrace, path.cost);
    };
    const bool isFound = !outcome.progress.empty() && std::isfinite(outcome.progress.back().cost);
    if (!outcome.path && isFound) {
        fmt::print("interrupted before the path was evaluated\n");
    } else if (!outcome.isSolved()) {
        fmt::print("{}\n", status);
    }
    if (outcome.path || baseline) {
        fmt::print("{:<16} {:>10} {:>15} {:>15} {:>10}\n", "planner", "length", "mean trace [m²]",
                   "goal trace [m²]", "cost");
    }
    if (outcome.path) row(*outcome.path);
    if (baseline) row(*baseline);
    if (outcome.isSolved()) {
        fmt::print("cost: {} (alpha {}, kappa {:.4g} 1/m²)\n", costShares(*outcome.path),
                   outcome.alpha, kappa);
    }
    if (outcome.isSolved() && baseline) {
        const std::string reason = noAdvantage(*outcome.path, *baseline, outcome.alpha);
        if (!reason.empty()) fmt::print("{}\n", reason);
    }
    if (audit) {
        fmt::print("audit: {} beliefs replayed, cost error {:.1e}, covariance error {:.1e}\n",
                   outcome.audit.nodes, outcome.audit.maxCostError,
                   outcome.audit.maxCovarianceError);
    }
    fmt::print("{} vertices, {} views, {:.2f} s\n", outcome.vertices, outcome.views, seconds);
}

/// Recorded images near the path; a recording that cannot be read is a warning, not an error.
std::optional<RecordedComparison> compareWithImages(const Config& config, const World& world,
                                                    const PlanOutcome& outcome) {
    if (!outcome.path || !world.hasTexture()) return {};
    try {
        const auto map = optionsOfMap(config.mapFile);
        if (!map) return {};
        return compareWithRecording(*map, config, world, *outcome.path);
    } catch (const InputError& error) {
        printMessage(fmt::format("warning: recorded frames not compared: {}", error.what()));
        return {};
    }
}

/// At every 1, 2 and 5 times a power of ten, up to the number of vertices; of an interrupted
/// command, the stages that all planners have reached.
std::vector<TreeEvolution> growthOf(const std::set<std::string>& planners, PlanningProblem& problem,
                                    std::size_t vertices, ProgressLine& line,
                                    const std::atomic<bool>& interrupted) {
    std::vector<std::size_t> stages;
    for (std::size_t ten = 10; ten < vertices; ten *= 10) {
        for (const std::size_t k : {1, 2, 5}) {
            if (k * ten < vertices) stages.push_back(k * ten);
        }
    }
    stages.push_back(vertices);
    std::vector<TreeEvolution> evolutions;
    evolutions.reserve(planners.size());
    for (const std::string& planner : planners) {
        evolutions.push_back(
            growInStages(problem, planner, stages, interrupted,
                         shownOn(line, static_cast<unsigned>(vertices), "tree of " + planner)));
    }
    std::size_t reached = stages.size();
    for (const TreeEvolution& evolution : evolutions) {
        reached = std::min(reached, evolution.stages.size());
    }
    if (reached == 0) return {};
    for (TreeEvolution& evolution : evolutions) evolution.stages.resize(reached);
    return evolutions;
}

}  // namespace

int runPlan(const PlanOptions& options, const std::atomic<bool>& interrupted) {
    const Stopwatch watch;
    const Config config = loadConfig(options.config, options.overrides);
    const World world(config);
    PlanningProblem problem(config, world, alphaOf(config.planner, config.belief.alpha));
    problem.checkPlaces();
    FolderTransaction folder = beginResult(options, "plan", inputsOf(config));
    if (!world.hasTexture()) {
        printMessage(
            fmt::format("warning: {}: no cell of the map has a grey value; planning without "
                        "views",
                        config.mapFile));
    }

    PlanOutcome outcome;
    std::optional<EvaluatedPath> baseline;
    std::vector<TreeEvolution> evolutions;
    {
        ProgressLine line(options.quiet);
        problem.kappa(interrupted, kappaShownOn(line, config));
        outcome = problem.solve(config.planner, interrupted,
                                shownOn(line, config.vertices, config.planner));
        if (config.compareWithRrtStar && usesViews(config.planner) && !interrupted) {
            baseline = problem
                           .solve("rrt_star", interrupted,
                                  shownOn(line, config.vertices, "rrt_star for comparison"))
                           .path;
        }
        if (options.evolution) {
            evolutions =
                growthOf({"rrt_star", config.planner}, problem, config.vertices, line, interrupted);
        }
    }
    const bool stopped = interrupted;
    if (stopped && keepsEarlierResult(folder, !outcome.path)) return kInterrupted;
    nlohmann::json result = planResult(config, problem.kappa(), outcome, baseline, stopped);
    const auto recorded = compareWithImages(config, world, outcome);
    if (recorded) result["recorded_frames"] = toJson(*recorded);
    result["time"]["total_s"] = watch.seconds();
    writePlanReport(folder.path(), config, world, problem, outcome, baseline, recorded, evolutions,
                    options.commandLine, result);
    result["time"]["total_s"] = watch.seconds();
    concludeResult(folder, options, result, [&] {
        printSummary(outcome, problem.statusOf(outcome), baseline, problem.kappa(), options.audit,
                     watch.seconds());
    });
    if (stopped) return kInterrupted;
    return outcome.isSolved() ? kDone : kNoAnswer;
}

}  // namespace photonav
