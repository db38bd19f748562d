// SPDX-License-Identifier: BSD-3-Clause
#include "comparisons/compare_command.hpp"

#include <fmt/format.h>

#include <map>
#include <utility>

#include "comparisons/compare_report.hpp"
#include "io/error.hpp"
#include "io/interrupted.hpp"
#include "io/stopwatch.hpp"
#include "plans/plan_progress.hpp"
#include "result/json_values.hpp"
#include "shared/many_runs.hpp"
#include "shared/result_folder.hpp"

namespace photonav {
using nlohmann::json;
namespace {

/// All runs of all configs.
std::vector<SweepItem> itemsOf(const CompareOptions& options) {
    std::vector<SweepItem> items;
    for (std::size_t i = 0; i < options.configs.size() * options.runs; ++i) {
        for (const CompareMethod& method : compareMethods()) items.push_back({method.label()});
    }
    return items;
}

/// The progress of all runs on a line.
class CompareProgress {
  public:
    /// @param items all runs
    CompareProgress(const std::vector<SweepItem>& items, bool quiet)
        : line_(quiet), rest_(items), asked_(items.size()) {}

    void begin(const std::string& name, const CompareMethod& method) {
        begin_ = watch_.seconds();
        line_.show(fmt::format("{} of {} runs, {}: {}{}", done_, asked_, name, method.label(),
                               rest_.text(begin_)));
    }
    void end(const CompareMethod& method) {
        ++done_;
        const double now = watch_.seconds();
        rest_.count(method.label(), now - begin_, now);
    }
    void clear() { line_.clear(); }
    ProgressLine& line() { return line_; }

  private:
    ProgressLine line_;
    RemainingTime rest_;
    Stopwatch watch_;
    std::size_t asked_, done_ = 0;
    double begin_ = 0.;  // of the present run [s]
};

std::vector<CompareRun> runMethods(const Config& config, const World& world,
                                   const CompareOptions& options, CompareProgress& progress,
                                   const std::atomic<bool>& interrupted) {
    std::vector<CompareRun> runs;
    const std::string name = nameOf(config);
    for (const CompareMethod& method : compareMethods()) {
        for (unsigned i = 0; i < options.runs; ++i) {
            const std::uint32_t seed = config.seed + i;
            progress.begin(name, method);
            try {
                CompareRun run = runMethod(config, world, method, seed, interrupted);
                if (interrupted) return runs;
                runs.push_back(std::move(run));
                progress.end(method);
            } catch (const Interrupted&) {
                return runs;
            }
        }
    }
    return runs;
}

/// @throws InputError also when the tables of two would go to the same file
std::vector<Config> loadConfigs(const CompareOptions& options) {
    std::vector<Config> configs;
    std::map<std::string, std::string> fileOf;
    for (const std::string& file : options.configs) {
        const Config& config = configs.emplace_back(loadConfig(file, options.overrides));
        checkSeeds(config, options.runs);
        const auto [known, isNew] = fileOf.emplace(nameOf(config), file);
        if (isNew) continue;
        throw InputError(file, "", "has the name of " + known->second + ", and so would its table");
    }
    return configs;
}

json scenarioJson(const ProblemRuns& problem) {
    const Config& config = problem.config;
    json scenario{{"config", nameOf(config)},
                  {"alpha", config.belief.alpha},
                  {"kappa", config.belief.kappa},
                  {"runs", json::array()}};
    for (const CompareRun& run : problem.runs) scenario["runs"].push_back(toJson(run));
    return scenario;
}

void print(const ProblemRuns& problem) {
    fmt::print("{}, mean of {} seed{}, traces in m²\n{}\n", nameOf(problem.config), problem.seeds,
               problem.seeds == 1 ? "" : "s", alignedText(shortComparisonTable(problem.runs)));
}

}  // namespace

int runCompare(const CompareOptions& options, const std::atomic<bool>& interrupted) {
    const std::vector<Config> configs = loadConfigs(options);
    InputPaths inputs;
    for (const Config& config : configs) inputs = inputsOf(config, std::move(inputs));
    FolderTransaction folder = beginResult(options.out, inputs);
    json result = resultJson("compare", {{"scenarios", json::array()}});
    CompareReport report(folder.path(), options.commandLine, configs.size() == 1);
    CompareProgress progress(itemsOf(options), options.quiet);
    bool anyPath = false;
    for (const Config& given : configs) {
        const World world(given);
        PlanningProblem(given, world).checkPlaces();
        ProblemRuns problem{
            withKappaSaid(given, world, progress.line(), interrupted), options.runs, {}};
        problem.runs = runMethods(problem.config, world, options, progress, interrupted);
        progress.clear();
        for (const CompareRun& run : problem.runs) anyPath = anyPath || run.outcome.path;
        if (!problem.runs.empty()) {
            result["scenarios"].push_back(scenarioJson(problem));
            report.add(problem, world);
            if (!options.quiet && !options.json) print(problem);
        }
        if (interrupted) break;
    }
    if (interrupted && result["scenarios"].empty()) throw Interrupted();
    result["interrupted"] = interrupted.load();
    report.write(result);
    commitResult(folder, result);
    if (options.json) {
        fmt::print("{}", jsonText(result));
    } else if (!options.quiet) {
        printFile(folder.target() / "report.html");
    }
    if (interrupted) return kInterrupted;
    return anyPath ? kDone : kNoAnswer;
}

}  // namespace photonav
