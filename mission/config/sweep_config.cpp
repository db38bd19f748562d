// SPDX-License-Identifier: BSD-3-Clause
#include "config/sweep_config.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "config/config_keys.hpp"
#include "geometry/constants.hpp"
#include "io/number.hpp"
#include "planners/planner_traits.hpp"

namespace photonav {
namespace {

constexpr std::size_t kMaxAlphas = 10000;

std::vector<double> range(double first, double last, double step) {
    if (!(step > 0.)) throw InputError("--alpha", "", "the step must be positive");
    if (first > last) throw InputError("--alpha", "", "the first value is above the last");
    const double count = std::floor((last - first) / step + 1e-9) + 1.;
    if (count > double{kMaxAlphas}) throw InputError("--alpha", "", "too many values");
    std::vector<double> values;
    values.reserve(static_cast<std::size_t>(count));
    for (int i = 0; i < static_cast<int>(count); ++i) {
        values.push_back(std::round((first + i * step) * 1e9) / 1e9);  // 0.15, not 0.15000000000002
    }
    return values;
}

/// @throws InputError unless there is something in the list, and nothing twice
template <typename T>
void checkList(const YamlMap& map, const std::string& key, const std::vector<T>& list) {
    if (list.empty()) map.fail(key, "empty");
    for (auto it = list.begin(); it != list.end(); ++it) {
        if (std::find(list.begin(), it, *it) != it) map.fail(key, fmt::format("{} twice", *it));
    }
}

void readAlphas(YamlMap& sweep, std::vector<double>& alphas) {
    sweep.readNumbers("alphas", alphas, 1, kMaxAlphas);
    for (const double alpha : alphas) {
        if (!(alpha >= 0. && alpha <= 1.)) {
            sweep.fail("alphas", fmt::format("{} is outside [0, 1]", alpha));
        }
    }
    checkList(sweep, "alphas", alphas);
}

void readPlanners(YamlMap& sweep, std::vector<std::string>& planners) {
    sweep.read("planners", planners);
    const std::vector<std::string>& known = plannerNames();
    for (const std::string& name : planners) {
        if (std::find(known.begin(), known.end(), name) != known.end()) continue;
        sweep.fail("planners", fmt::format("'{}' is not one of {}", name, fmt::join(known, ", ")));
    }
    checkList(sweep, "planners", planners);
}

void readPaper(YamlMap& sweep, std::vector<PaperRow>& rows) {
    if (sweep.has("paper")) rows.clear();
    for (YamlMap& map : sweep.list("paper")) {
        PaperRow& row = rows.emplace_back();
        for (const char* key : {"alpha", "length", "mean_trace", "goal_trace"}) {
            if (!map.has(key)) map.fail(key, "missing");
        }
        map.readNumber("alpha", row.alpha, 0., 1.);
        map.readNumber("length", row.length, 0., 1e12);
        map.readNumber("mean_trace", row.meanTrace, 0., 1e12);
        map.readNumber("goal_trace", row.goalTrace, 0., 1e12);
        map.finish();
    }
}

YAML::Node nodeOf(const std::vector<PaperRow>& rows) {
    if (rows.empty()) return {};
    YAML::Node list(YAML::NodeType::Sequence);
    for (const PaperRow& row : rows) {
        YAML::Node node;
        node["alpha"] = yamlNumber(row.alpha);
        node["length"] = yamlNumber(row.length);
        node["mean_trace"] = yamlNumber(row.meanTrace);
        node["goal_trace"] = yamlNumber(row.goalTrace);
        node.SetStyle(YAML::EmitterStyle::Flow);
        list.push_back(node);
    }
    return list;
}

}  // namespace

void addKeys(KeyTable& keys, SweepConfig& c) {
    keys.beginSection("sweep");
    keys.add({.words = {"alphas", "", "values of `planner.alpha`"},
              .allowed = "0 to 1",
              .read = [&c](YamlMap& map) { readAlphas(map, c.alphas); },
              .value = [&c] { return yamlList(c.alphas); }});
    keys.count({"runs", "", "runs per planner and alpha, with the seeds `seed`, `seed` + 1, ..."},
               c.runs, {1., 1e6});
    keys.add({.words = {"planners", "", "names as of `planner.name`"},
              .read = [&c](YamlMap& map) { readPlanners(map, c.planners); },
              .value = [&c] { return yamlList(c.planners); }});
    keys.file({"reference", "", "CSV of the best known cost per alpha"}, c.reference);
    keys.add({.words = {"paper", "m, `paper_trace_unit`", "rows of a published table"},
              .allowed = "`{alpha, length, mean_trace, goal_trace}`",
              .read = [&c](YamlMap& map) { readPaper(map, c.paper); },
              .value = [&c] { return nodeOf(c.paper); }});
    keys.number({"paper_trace_unit", "m^2", "value of a printed trace of 1"}, c.paperTraceUnit,
                {1e-12, 1e12});
}

std::vector<double> parseAlphas(const std::string& text) {
    const bool isRange = text.find(':') != std::string::npos;
    const auto numbers = numbersIn(text, isRange ? ':' : ',');
    if (!numbers || (isRange && numbers->size() != 3)) {
        throw InputError("--alpha", "", "expected first:last:step or a list, found '" + text + "'");
    }
    return isRange ? range((*numbers)[0], (*numbers)[1], (*numbers)[2]) : *numbers;
}

}  // namespace photonav
