// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <fmt/ranges.h>

#include "comparisons/benchmark_command.hpp"
#include "comparisons/compare_command.hpp"
#include "comparisons/reference_command.hpp"
#include "comparisons/sweep_command.hpp"
#include "config/sweep_config.hpp"
#include "shared/command_line.hpp"
#include "sweep/sweep_journal.hpp"

namespace photonav {
namespace {

// Lists of a sweep, in place of those of the config.

void addAlphas(CLI::App& parser, std::vector<std::string>& overrides) {
    addValue(parser, overrides, "--alpha", "sweep.alphas",
             "values of alpha: a,b,c or "
             "first:last:step",
             [](const std::string& typed) {
                 return fmt::format("[{}]", fmt::join(parseAlphas(typed), ", "));
             })
        ->type_name("ALPHAS");
}

void addSweepOptions(CLI::App& parser, ManyRunsOptions& options) {
    addCommon(parser, options, false);
    addAlphas(parser, options.overrides);
    addPlanners(parser, options.overrides, "sweep.planners");
    addValue(parser, options.overrides, "--runs", "sweep.runs",
             "number of seeds per planner and alpha");
    addSeed(parser, options.overrides, "the first seed");
    addManyRuns(parser, options, SweepKind::kWords);
}

void addCompareOptions(CLI::App& parser, CompareOptions& options) {
    parser.add_option("configs", options.configs, "YAML files of planning problems")->required();
    addOverrides(parser, options.overrides);
    addNumber(parser, "--runs", options.runs,
              "number of seeds per method, from the config's seed on", 1U, 10000U);
    addOutput(parser, options, options.out.string());
}

void addBenchmarkOptions(CLI::App& parser, BenchmarkOptions& options) {
    addCommon(parser, options);
    addPlanners(parser, options.overrides, "sweep.planners");
    addValue(parser, options.overrides, "--runs", "sweep.runs", "number of seeds per planner");
    addSeed(parser, options.overrides, "the first seed");
    addNumber(parser, "--interval", options.interval, "time between samples of the progress [s]",
              1e-3, 1e3);
    addNumber(parser, "--time-limit", options.timeLimit, "time limit of a run [s]", 1e-3, 1e6);
}

void addReferenceOptions(CLI::App& parser, ReferenceOptions& options) {
    parser.add_option("config", options.config, "YAML file of the planning problem")->required();
    addOverrides(parser, options.overrides);
    addAlphas(parser, options.overrides);
    addPlanners(parser, options.overrides, "sweep.planners");
    addNumber(parser, "--runs", options.runs, "number of seeds per planner and alpha", 0U,
              1000000U);
    addNumber(parser, "--vertices", options.vertices, "vertices of each run", 2U, 100000000U);
    addNumber(parser, "--labels", options.labels, "labels per vertex", 1U, 1000000U);
    addNumber(parser, "--moves", options.moves, "changes that the descent tries from each path", 0U,
              1000000000U);
    parser
        .add_option("--file", options.file,
                    "file of the table (default: reference/<config>.csv beside the config)")
        ->type_name("FILE")
        ->check(notEmpty());
    parser.add_flag("--from-scratch", options.fromScratch,
                    "do not start from the paths of the table");
    addQuiet(parser, options.quiet);
}

}  // namespace

Commands comparisonCommands(CLI::App& app, const Invocation& invocation) {
    Commands commands{
        makeCommand<ManyRunsOptions>(
            app, invocation, "sweep",
            "Compare planners over alpha and seeds (Table I of the paper).", addSweepOptions,
            runSweep),
        makeCommand<CompareOptions>(
            app, invocation, "compare",
            "Compare all planners and information models on the same problems.", addCompareOptions,
            runCompare),
        makeCommand<BenchmarkOptions>(
            app, invocation, "benchmark",
            "Run planners in OMPL's benchmark and write a log for its tools.", addBenchmarkOptions,
            runBenchmark),
        makeCommand<ReferenceOptions>(app, invocation, "reference",
                                      "Compute near-optimal reference paths (takes hours).",
                                      addReferenceOptions, runReference)};
    commands.back().onInterrupt = OnInterrupt::finishAlways;
    return commands;
}

}  // namespace photonav
