// SPDX-License-Identifier: BSD-3-Clause
#include "comparisons/compare_command.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <functional>
#include <map>
#include <utility>

#include "figures/top_view.hpp"
#include "io/atomic_file.hpp"
#include "io/error.hpp"
#include "planners/planner_traits.hpp"
#include "render/interruptible_views.hpp"
#include "report/problem_report.hpp"
#include "result/json_values.hpp"
#include "shared/result_folder.hpp"

namespace photonav {
namespace fs = std::filesystem;
using nlohmann::json;
namespace {

/// Of files of the result: without line breaks and their like.
std::string nameOf(const Config& config) {
    std::string name = fs::path(config.file).stem().string();
    std::replace_if(
        name.begin(), name.end(), [](unsigned char c) { return std::iscntrl(c) != 0; }, '_');
    return name;
}

/// Planners with the photometric model, or without views, have their own colours.
Color colorOf(const CompareMethod& method) {
    static const std::map<std::string, Color> kColors{{"feature_reprojection", {86, 180, 233}},
                                                      {"feature_count", {204, 121, 167}},
                                                      {"map_uncertainty", {110, 60, 160}},
                                                      {"none", {90, 90, 90}}};
    const auto own = kColors.find(method.information);
    const bool isOwn = usesViews(method.planner) && own != kColors.end();
    return isOwn ? own->second : plannerColor(method.planner);
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
        path.color = colorOf(method);
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
    for (const CompareRun& run : runs) scenario["runs"].push_back(toJson(run));
    return scenario;
}

}  // namespace

int runCompare(const CompareOptions& options, const std::atomic<bool>& interrupted) {
    const std::vector<Config> configs = loadConfigs(options);
    InputPaths inputs;
    for (const Config& config : configs) inputs = inputsOf(config, std::move(inputs));
    FolderTransaction folder = beginResult(options.out, inputs);
    json result = resultJson("compare", {{"scenarios", json::array()}});
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
    if (interrupted && keepsEarlierResult(folder, result["scenarios"].empty())) {
        return kInterrupted;
    }
    result["interrupted"] = interrupted.load();
    commitResult(folder, result);
    if (interrupted) return kInterrupted;
    return anyPath ? kDone : kNoAnswer;
}

}  // namespace photonav
