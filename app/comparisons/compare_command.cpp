// SPDX-License-Identifier: BSD-3-Clause
#include "commands/compare_command.hpp"

#include <fmt/format.h>

#include <cmath>
#include <functional>
#include <map>

#include "commands/result_folder.hpp"
#include "figures/top_view.hpp"
#include "io/atomic_file.hpp"
#include "io/error.hpp"
#include "planners/planner_table.hpp"
#include "render/interruptible_views.hpp"
#include "report/problem_report.hpp"
#include "sweep/sweep_plan.hpp"

namespace photonav {
namespace fs = std::filesystem;
using nlohmann::json;
namespace {

constexpr unsigned kRrbtVertices = 400;

using Values = std::vector<double>;

std::string nameOf(const Config& config) { return fs::path(config.file).stem().string(); }

std::string meanAndDeviation(const Values& values, int decimals) {
    if (values.empty()) return "-";
    const auto n = static_cast<double>(values.size());
    double mean = 0.;
    for (const double v : values) mean += v / n;
    if (values.size() == 1) return fmt::format("{:.{}f}", mean, decimals);
    double variance = 0.;
    for (const double v : values) variance += (v - mean) * (v - mean) / (n - 1.);
    return fmt::format("{:.{}f} ± {:.{}f}", mean, decimals, std::sqrt(variance), decimals);
}

/// Three digits, whatever the order of magnitude.
std::string traceText(const Values& values) {
    double largest = 0.;
    for (const double v : values) largest = std::max(largest, std::abs(v));
    const bool isNumber = largest > 0. && std::isfinite(largest);
    const int decimals = isNumber ? 2 - static_cast<int>(std::floor(std::log10(largest))) : 2;
    return meanAndDeviation(values, std::clamp(decimals, 0, 12));
}

std::string tableRow(const std::string& method, const std::vector<const CompareRun*>& runs) {
    const auto ofPath = [&](double EvaluatedPath::*value) {
        Values values;
        for (const CompareRun* run : runs) {
            if (run->outcome.path) values.push_back((*run->outcome.path).*value);
        }
        return values;
    };
    const auto ofRun = [&](const std::function<double(const PlanOutcome&)>& value) {
        Values values;
        for (const CompareRun* run : runs) values.push_back(value(run->outcome));
        return values;
    };
    const Values costs = ofPath(&EvaluatedPath::cost);
    const std::string label =
        costs.size() == runs.size()
            ? method
            : fmt::format("{} ({} of {} found a path)", method, costs.size(), runs.size());
    return fmt::format(
        "| {} | {} | {} | {} | {} | {} | {} | {} |\n", label, meanAndDeviation(costs, 3),
        meanAndDeviation(ofPath(&EvaluatedPath::length), 2),
        traceText(ofPath(&EvaluatedPath::meanTrace)), traceText(ofPath(&EvaluatedPath::goalTrace)),
        meanAndDeviation(ofRun([](const auto& o) { return static_cast<double>(o.vertices); }), 0),
        meanAndDeviation(ofRun([](const auto& o) { return static_cast<double>(o.views); }), 0),
        meanAndDeviation(ofRun([](const auto& o) { return o.planSeconds; }), 1));
}

json jsonOf(const CompareRun& run) {
    const PlanOutcome& o = run.outcome;
    json result{{"method", run.method}, {"seed", run.seed},         {"vertices", o.vertices},
                {"views", o.views},     {"seconds", o.planSeconds}, {"status", run.status}};
    if (!o.path) return result;
    result.update({{"cost", o.path->cost},
                   {"planner_cost", o.plannerCost},
                   {"length", o.path->length},
                   {"mean_trace", o.path->meanTrace},
                   {"goal_trace", o.path->goalTrace}});
    return result;
}

/// The first path of every method from above.
Png picture(const Config& config, const World& world, const std::vector<CompareRun>& runs) {
    std::vector<DrawnPath> paths;
    for (const CompareMethod& method : compareMethods()) {
        const auto run = std::find_if(runs.begin(), runs.end(), [&](const CompareRun& r) {
            return r.method == method.label() && r.outcome.path;
        });
        if (run == runs.end()) continue;
        DrawnPath& path = paths.emplace_back(drawnPath(*run->outcome.path, config.camera.T_b_c()));
        path.name = method.label();
        path.color = method.color;
    }
    TopView view = viewFromAbove(config, world, paths);
    view.title = fmt::format("{}, alpha {}", nameOf(config), config.belief.alpha);
    view.ellipseScale = 0.;
    return topViewFigure(view).png();
}

std::vector<CompareRun> runMethods(const Config& config, const World& world,
                                   const CompareOptions& options, ProgressLine& line,
                                   const std::atomic<bool>& interrupted) {
    std::vector<CompareRun> runs;
    const std::string name = nameOf(config);
    for (const CompareMethod& method : compareMethods()) {
        for (unsigned i = 0; i < options.runs; ++i) {
            const std::uint32_t seed = config.seed + i;
            line.show(fmt::format("{}: {}, seed {} ({} of {})", name, method.label(), seed, i + 1,
                                  options.runs));
            try {
                CompareRun run = runMethod(config, world, method, seed, interrupted);
                if (interrupted) return runs;
                runs.push_back(std::move(run));
            } catch (const RenderingStopped&) {
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

/// Writes the table and picture of one problem.
json writeScenario(const Config& config, const World& world, const std::vector<CompareRun>& runs,
                   const fs::path& folder, bool quiet) {
    const std::string name = nameOf(config);
    const std::string table = compareTable(runs);
    writeFileAtomically(folder / (name + ".md"), table);
    writeFileAtomically(folder / (name + ".png"), picture(config, world, runs));
    if (!quiet) fmt::print("{}\n{}\n", name, table);
    json scenario{{"config", name},
                  {"alpha", config.belief.alpha},
                  {"kappa", config.belief.kappa},
                  {"runs", json::array()}};
    for (const CompareRun& run : runs) scenario["runs"].push_back(jsonOf(run));
    return scenario;
}

}  // namespace

std::string CompareMethod::label() const {
    if (!usesViews(planner)) return planner;
    return planner + ", " + information;
}

const std::vector<CompareMethod>& compareMethods() {
    static const std::vector<CompareMethod> methods{
        {"belief_rrt_star", "photometric", plannerColor("belief_rrt_star")},
        {"pa_rrt_star", "photometric", plannerColor("pa_rrt_star")},
        {"rrbt", "photometric", plannerColor("rrbt"), kRrbtVertices},
        {"belief_rrt_star", "feature_reprojection", {86, 180, 233}},
        {"belief_rrt_star", "feature_count", {204, 121, 167}},
        {"belief_rrt_star", "map_uncertainty", {110, 60, 160}},
        {"belief_rrt_star", "none", {90, 90, 90}},
        {"rrt_star", "none", plannerColor("rrt_star")}};
    return methods;
}

CompareRun runMethod(const Config& config, const World& world, const CompareMethod& method,
                     std::uint32_t seed, const std::atomic<bool>& interrupted) {
    Config own = config;
    own.seed = seed;
    own.viewModel.name = method.information;
    if (method.maxVertices > 0) own.vertices = std::min(own.vertices, method.maxVertices);
    PlanningProblem problem(own, world);
    PlanOutcome outcome = problem.solve(method.planner, interrupted);
    const std::string status = problem.statusOf(outcome);
    return {method.label(), seed, std::move(outcome), status};
}

std::string compareTable(const std::vector<CompareRun>& runs) {
    std::string table =
        "| planner, information | cost J | length [m] | mean trace [m²] | goal trace [m² + "
        "rad²] | "
        "vertices | views | seconds |\n|---|---|---|---|---|---|---|---|\n";
    for (const CompareMethod& method : compareMethods()) {
        std::vector<const CompareRun*> own;
        for (const CompareRun& run : runs) {
            if (run.method == method.label()) own.push_back(&run);
        }
        if (!own.empty()) table += tableRow(method.label(), own);
    }
    return table;
}

int runCompare(const CompareOptions& options, const std::atomic<bool>& interrupted) {
    const std::vector<Config> configs = loadConfigs(options);
    FolderTransaction folder =
        beginResult(options.out, {options.configs.begin(), options.configs.end()});
    json result{{"schema", 1},
                {"command", "compare"},
                {"version", PHOTONAV_VERSION},
                {"scenarios", json::array()}};
    bool anyPath = false;
    for (const Config& given : configs) {
        const World world(given);
        PlanningProblem(given, world).checkPlaces();
        const Config config = withKappa(given, world, interrupted);
        ProgressLine line(options.quiet);
        const auto runs = runMethods(config, world, options, line, interrupted);
        line.clear();
        for (const CompareRun& run : runs) anyPath = anyPath || run.outcome.path;
        if (!runs.empty())
            result["scenarios"].push_back(
                writeScenario(config, world, runs, folder.path(), options.quiet));
        if (interrupted) break;
    }
    result["interrupted"] = interrupted.load();
    commitResult(folder, result);
    if (interrupted) return kInterrupted;
    return anyPath ? kDone : kNoAnswer;
}

}  // namespace photonav
