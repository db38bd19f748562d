// SPDX-License-Identifier: BSD-3-Clause
#include "sweep/comparison.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "belief/view_model_table.hpp"
#include "planners/planner_traits.hpp"

namespace photonav {
using nlohmann::json;
namespace {

constexpr const char* kNoModel = "none";

using Values = std::vector<double>;

/// Of what a table shows of its values.
enum class Shown { mean, meanAndDeviation };

std::string textOf(const Values& values, int decimals, Shown shown) {
    if (values.empty()) return "-";
    const auto n = static_cast<double>(values.size());
    double mean = 0.;
    for (const double v : values) mean += v / n;
    if (values.size() == 1 || shown == Shown::mean) return fmt::format("{:.{}f}", mean, decimals);
    double variance = 0.;
    for (const double v : values) variance += (v - mean) * (v - mean) / (n - 1.);
    return fmt::format("{:.{}f} ± {:.{}f}", mean, decimals, std::sqrt(variance), decimals);
}

/// Three digits, whatever the order of magnitude.
std::string traceText(const Values& values, Shown shown) {
    double largest = 0.;
    for (const double v : values) largest = std::max(largest, std::abs(v));
    const bool isNumber = largest > 0. && std::isfinite(largest);
    const int decimals = isNumber ? 2 - static_cast<int>(std::floor(std::log10(largest))) : 2;
    return textOf(values, std::clamp(decimals, 0, 12), shown);
}

/// The runs of one method.
struct MethodRuns {
    std::string method;
    std::vector<const CompareRun*> runs;

    Values ofPaths(double EvaluatedPath::*value) const {
        Values values;
        for (const CompareRun* run : runs) {
            if (run->outcome.path) values.push_back((*run->outcome.path).*value);
        }
        return values;
    }
    Values ofRuns(const std::function<double(const PlanOutcome&)>& value) const {
        Values values;
        for (const CompareRun* run : runs) values.push_back(value(run->outcome));
        return values;
    }
    std::string label() const {
        const std::size_t found = ofPaths(&EvaluatedPath::cost).size();
        if (found == runs.size()) return method;
        return fmt::format("{} ({} of {} found a path)", method, found, runs.size());
    }
};

std::vector<MethodRuns> byMethod(const std::vector<CompareRun>& runs) {
    std::vector<MethodRuns> all;
    for (const CompareMethod& method : compareMethods()) {
        MethodRuns own{method.label(), {}};
        for (const CompareRun& run : runs) {
            if (run.method == own.method) own.runs.push_back(&run);
        }
        if (!own.runs.empty()) all.push_back(std::move(own));
    }
    return all;
}

/// Label, cost, length and traces.
std::vector<std::string> cellsOfPaths(const MethodRuns& own, Shown shown) {
    return {own.label(), textOf(own.ofPaths(&EvaluatedPath::cost), 3, shown),
            textOf(own.ofPaths(&EvaluatedPath::length), 2, shown),
            traceText(own.ofPaths(&EvaluatedPath::meanTrace), shown),
            traceText(own.ofPaths(&EvaluatedPath::goalTrace), shown)};
}

/// Planners with views by the photometric model; then the default one by every other model, and
/// without any; then the planners without views.
std::vector<CompareMethod> allMethods() {
    const std::string &ours = plannerNames().front(), paper = viewModelNames().front();
    std::vector<CompareMethod> methods;
    for (const std::string& planner : plannerNames()) {
        if (!usesViews(planner)) continue;
        methods.push_back({planner, paper, findPlanner(planner)->mostCompared});
    }
    for (const std::string& model : viewModelNames()) {
        if (model != paper && model != kNoModel) methods.push_back({ours, model});
    }
    methods.push_back({ours, kNoModel});
    for (const std::string& planner : plannerNames()) {
        if (!usesViews(planner)) methods.push_back({planner, kNoModel});
    }
    return methods;
}

}  // namespace

std::string CompareMethod::label() const {
    if (!usesViews(planner)) return planner;
    return planner + ", " + information;
}

const std::vector<CompareMethod>& compareMethods() {
    static const std::vector<CompareMethod> methods = allMethods();
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

TextTable comparisonTable(const std::vector<CompareRun>& runs) {
    TextTable table{{"planner, information", "cost J", "length [m]", "mean trace [m²]",
                     "goal trace [m²]", "vertices", "views", "seconds"},
                    {}};
    for (const MethodRuns& own : byMethod(runs)) {
        auto& row = table.rows.emplace_back(cellsOfPaths(own, Shown::meanAndDeviation));
        const auto add = [&](const auto& value, int decimals) {
            row.push_back(textOf(own.ofRuns(value), decimals, Shown::meanAndDeviation));
        };
        add([](const PlanOutcome& o) { return static_cast<double>(o.vertices); }, 0);
        add([](const PlanOutcome& o) { return static_cast<double>(o.views); }, 0);
        add([](const PlanOutcome& o) { return o.planSeconds; }, 1);
    }
    return table;
}

TextTable shortComparisonTable(const std::vector<CompareRun>& runs) {
    TextTable table{{"planner, information", "cost J", "length", "mean trace", "at goal"}, {}};
    for (const MethodRuns& own : byMethod(runs)) {
        table.rows.push_back(cellsOfPaths(own, Shown::mean));
    }
    return table;
}

json toJson(const CompareRun& run) {
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

}  // namespace photonav
