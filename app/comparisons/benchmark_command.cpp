// SPDX-License-Identifier: BSD-3-Clause
#include "comparisons/benchmark_command.hpp"

#include <fmt/format.h>

#include <filesystem>

#include "comparisons/sweep_report.hpp"
#include "figures/sweep_figures.hpp"
#include "io/atomic_file.hpp"
#include "io/stopwatch.hpp"
#include "plans/plan_progress.hpp"
#include "problem/planning_problem.hpp"
#include "report/problem_report.hpp"
#include "result/json_values.hpp"
#include "shared/result_folder.hpp"
#include "sweep/planner_benchmark.hpp"

namespace photonav {
namespace fs = std::filesystem;
using nlohmann::json;
namespace {

Config loadBenchmarkConfig(const BenchmarkOptions& options) {
    Config config = loadConfig(options.config, options.overrides);
    checkSeeds(config, config.sweep.runs);
    config.sweep.alphas = {config.belief.alpha};
    return config;
}

json benchmarkResult(const Config& config, const BenchmarkOutcome& outcome, bool stopped,
                     double seconds) {
    json result = resultJson("benchmark", {{"status", sweepStatus(outcome.runs, stopped)},
                                           {"planners", config.sweep.planners},
                                           {"alpha", config.belief.alpha},
                                           {"kappa", config.belief.kappa},
                                           {"first_seed", config.seed},
                                           {"runs_per_planner", config.sweep.runs},
                                           {"time", {{"total_s", seconds}}},
                                           {"runs", json::array()},
                                           {"summary", json::array()}});
    for (const SweepRun& run : outcome.runs) result["runs"].push_back(toJson(run));
    for (const SweepCell& cell : summarize(config.sweep, outcome.runs, {})) {
        result["summary"].push_back(toJson(cell));
    }
    return result;
}

ReportTable summaryTable(const SweepCell& cell) {
    const auto value = [&](const char* column) {
        const Statistic& statistic = cell.columns.at(column);
        return std::isfinite(statistic.deviation)
                   ? fmt::format("{:.4g} ± {:.2g}", statistic.mean, statistic.deviation)
                   : fmt::format("{:.4g}", statistic.mean);
    };
    return {cell.planner,
            {{"runs with a path", fmt::format("{} of {}", cell.solved, cell.runs)},
             {"cost", value("cost")},
             {"length [m]", value("length")},
             {"mean trace [m²]", value("mean_trace")},
             {"trace at the goal [m²]", value("goal_trace")},
             {"vertices", value("vertices")},
             {"views", value("views")},
             {"time [s]", value("seconds")}}};
}

/// Curves of planners that minimise what their paths are judged by: the others' costs are another
/// quantity (rrt_star's is the length).
std::vector<BenchmarkCurve> comparable(const BenchmarkOutcome& outcome) {
    constexpr double kPrinted = 1e-5;  // of the cost in a sample, relative
    std::vector<BenchmarkCurve> curves;
    for (std::size_t i = 0; i < outcome.runs.size(); ++i) {
        const double cost = outcome.runs[i].cost;
        const BenchmarkCurve& curve = outcome.curves[i];
        if (std::abs(curve.cost.back() - cost) < kPrinted * (1. + cost)) curves.push_back(curve);
    }
    return curves;
}

void writeReport(const fs::path& folder, const BenchmarkOptions& options, const Config& config,
                 const World& world, const BenchmarkOutcome& outcome, const json& result) {
    ReportData report = problemReport(config, world, options.commandLine, result);
    report.title = fs::path(options.config).stem().string();
    report.subtitle =
        fmt::format("{} runs of {} vertices, alpha {}, {} planners", outcome.runs.size(),
                    config.vertices, config.belief.alpha, config.sweep.planners.size());
    for (const SweepCell& cell : summarize(config.sweep, outcome.runs, {})) {
        report.tables.push_back(summaryTable(cell));
    }
    writeFileAtomically(folder / "benchmark.log", outcome.log);
    writeResultFolder(
        folder, report,
        {{"progress",
          "Cost of the best path over time, a line per run of the planners that minimise it.",
          costOverTimeFigure("Best cost over time", config.sweep.planners, comparable(outcome))}});
}

}  // namespace

int runBenchmark(const BenchmarkOptions& options, const std::atomic<bool>& interrupted) {
    const Stopwatch watch;
    const Config given = loadBenchmarkConfig(options);
    const World world(given);
    PlanningProblem(given, world).checkPlaces();
    FolderTransaction folder = beginResult(options, "benchmark", inputsOf(given));

    ProgressLine line(options.quiet);
    const Config config = withKappaSaid(given, world, line, interrupted);
    line.beginPhase();
    const std::size_t asked = config.sweep.planners.size() * config.sweep.runs;
    std::size_t done = 0;
    const BenchmarkOutcome outcome = benchmarkPlanners(
        config, world, {options.interval, options.timeLimit}, interrupted,
        [&](const SweepItem& item) {
            line.show(
                fmt::format("{} of {} runs, {} seed {}", done, asked, item.planner, item.seed),
                static_cast<double>(done) / static_cast<double>(asked));
            ++done;
        });
    line.clear();
    const bool stopped = outcome.runs.size() < asked;
    if (stopped && keepsEarlierResult(folder, outcome.runs.empty())) return kInterrupted;
    const double seconds = watch.seconds();
    const json result = benchmarkResult(config, outcome, stopped, seconds);
    writeReport(folder.path(), options, config, world, outcome, result);
    concludeResult(folder, options, result, [&] {
        fmt::print("{}\nlog: {}\n", sweepTable(summarize(config.sweep, outcome.runs, {})),
                   (folder.target() / "benchmark.log").string());
    });
    if (stopped) return kInterrupted;
    return result["status"] == "done" ? kDone : kNoAnswer;
}

}  // namespace photonav
