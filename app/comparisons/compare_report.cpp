// SPDX-License-Identifier: BSD-3-Clause
#include "comparisons/compare_report.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cctype>
#include <map>
#include <utility>

#include "figures/top_view.hpp"
#include "io/atomic_file.hpp"
#include "planners/planner_traits.hpp"
#include "report/problem_report.hpp"

namespace photonav {
namespace fs = std::filesystem;
namespace {

/// Planners with the photometric model, or without views, have their own colours.
Color colorOf(const CompareMethod& method) {
    static const std::map<std::string, Color> kColors{{"feature_reprojection", kBrown},
                                                      {"feature_count", kMint},
                                                      {"map_uncertainty", kIndigo},
                                                      {"none", {90, 90, 90}}};
    const auto own = kColors.find(method.information);
    const bool isOwn = usesViews(method.planner) && own != kColors.end();
    return isOwn ? own->second : plannerColor(method.planner);
}

/// The first path of every method.
std::vector<DrawnPath> firstPaths(const ProblemRuns& problem) {
    std::vector<DrawnPath> paths;
    for (const CompareMethod& method : compareMethods()) {
        const auto run = std::find_if(
            problem.runs.begin(), problem.runs.end(),
            [&](const CompareRun& r) { return r.method == method.label() && r.outcome.path; });
        if (run == problem.runs.end()) continue;
        DrawnPath& path =
            paths.emplace_back(drawnPath(*run->outcome.path, problem.config.camera.T_b_c()));
        path.name = method.label();
        path.color = colorOf(method);
    }
    return paths;
}

Figure fromAbove(const Config& config, const World& world, const std::vector<DrawnPath>& paths) {
    TopView view = viewFromAbove(config, world, paths);
    view.title = fmt::format("{}, alpha {}", nameOf(config), config.belief.alpha);
    view.ellipseScale = 0.;
    return topViewFigure(view);
}

}  // namespace

std::string nameOf(const Config& config) {
    std::string name = fs::path(config.file).stem().string();
    std::replace_if(
        name.begin(), name.end(), [](unsigned char c) { return std::iscntrl(c) != 0; }, '_');
    return name;
}

CompareReport::CompareReport(fs::path folder, const std::string& commandLine, bool hasConfig)
    : folder_(std::move(folder)), commandLine_(commandLine), hasConfig_(hasConfig) {}

void CompareReport::add(const ProblemRuns& problem, const World& world) {
    const std::string name = nameOf(problem.config);
    const TextTable table = comparisonTable(problem.runs);
    writeFileAtomically(folder_ / (name + ".md"), alignedMarkdown(table));
    std::vector<DrawnPath> paths = firstPaths(problem);
    figures_.push_back({name, fmt::format("{}: the first path of every method, from above.", name),
                        fromAbove(problem.config, world, paths)});
    if (names_.empty()) begin(problem, world, std::move(paths));
    names_.push_back(name);
    page_.textTables.push_back(
        {fmt::format("{}, alpha {}", name, problem.config.belief.alpha), table,
         fmt::format("Mean ± standard deviation over {} seed{}. All paths are evaluated by the "
                     "photometric beliefs.",
                     problem.seeds, problem.seeds == 1 ? "" : "s")});
}

void CompareReport::begin(const ProblemRuns& problem, const World& world,
                          std::vector<DrawnPath> paths) {
    page_ = problemReport(problem.config, world, commandLine_, {});
    page_.paths = std::move(paths);
    if (!hasConfig_) page_.config.clear();
}

void CompareReport::write(const nlohmann::json& result) {
    if (names_.empty()) return;
    page_.result = result;
    page_.title = fmt::format("{}", fmt::join(names_, ", "));
    page_.subtitle = fmt::format(
        "{} methods: planners, and what they take for the information "
        "of an image",
        compareMethods().size());
    if (names_.size() > 1) page_.subtitle += fmt::format("; in 3-D: {}", names_.front());
    writeResultFolder(folder_, page_, figures_);
}

}  // namespace photonav
