// SPDX-License-Identifier: BSD-3-Clause
#include "sweep_config.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <sstream>

#include "constants.hpp"

namespace photonav {
namespace {

constexpr std::size_t kMaxAlphas = 10000;

double parseNumber(const std::string& text) {
    double value = 0.;
    const char* end = text.data() + text.size();
    const auto [stop, error] = std::from_chars(text.data(), end, value);
    if (error != std::errc() || stop != end || !std::isfinite(value)) {
        throw InputError("--alpha", "", "'" + text + "' is not a number");
    }
    return value;
}

std::vector<double> parseNumbers(const std::string& text, char separator) {
    std::vector<double> numbers;
    std::istringstream stream(text);
    for (std::string field; std::getline(stream, field, separator);) {
        numbers.push_back(parseNumber(field));
    }
    return numbers;
}

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

void readPaper(YamlMap& sweep, std::vector<PaperRow>& rows) {
    for (YamlMap& map : sweep.list("paper")) {
        PaperRow& row = rows.emplace_back();
        for (const char* key : {"alpha", "length", "mean_trace", "goal_trace"}) {
            if (!map.has(key)) map.fail(key, "missing");
        }
        map.readNumber("alpha", row.alpha, 0., 1.);
        map.readNumber("length", row.length, 0., kInfinity);
        map.readNumber("mean_trace", row.meanTrace, 0., kInfinity);
        map.readNumber("goal_trace", row.goalTrace, 0., kInfinity);
        map.finish();
    }
}

}  // namespace

SweepConfig readSweep(YamlMap& root, const std::vector<std::string>& knownPlanners) {
    SweepConfig config;
    YamlMap sweep = root.map("sweep");
    sweep.readNumbers("alphas", config.alphas, 1, kMaxAlphas);
    for (const double alpha : config.alphas) {
        if (!(alpha >= 0. && alpha <= 1.)) {
            sweep.fail("alphas", fmt::format("{} is outside [0, 1]", alpha));
        }
    }
    checkList(sweep, "alphas", config.alphas);
    double runs = config.runs;
    sweep.readNumber("runs", runs, 1., 1e6);
    if (runs != std::floor(runs)) sweep.fail("runs", "not a whole number");
    config.runs = static_cast<unsigned>(runs);
    sweep.read("planners", config.planners);
    for (const std::string& name : config.planners) {
        if (std::find(knownPlanners.begin(), knownPlanners.end(), name) != knownPlanners.end())
            continue;
        sweep.fail("planners",
                   fmt::format("'{}' is not one of {}", name, fmt::join(knownPlanners, ", ")));
    }
    checkList(sweep, "planners", config.planners);
    sweep.read("reference", config.reference);
    readPaper(sweep, config.paper);
    sweep.readNumber("paper_trace_unit", config.paperTraceUnit, 1e-12, kInfinity);
    sweep.finish();
    return config;
}

std::string toYaml(const SweepConfig& c) {
    std::string text = fmt::format("sweep:\n  alphas: [{}]\n  runs: {}\n  planners: [{}]\n",
                                   fmt::join(c.alphas, ", "), c.runs, fmt::join(c.planners, ", "));
    if (!c.reference.empty()) {
        text += fmt::format("  reference: {}\n", YAML::Dump(YAML::Node(c.reference)));
    }
    text += fmt::format("  paper_trace_unit: {}\n", c.paperTraceUnit);
    if (!c.paper.empty()) text += "  paper:\n";
    for (const PaperRow& row : c.paper) {
        text += fmt::format("    - {{alpha: {}, length: {}, mean_trace: {}, goal_trace: {}}}\n",
                            row.alpha, row.length, row.meanTrace, row.goalTrace);
    }
    return text;
}

std::vector<double> parseAlphas(const std::string& text) {
    if (text.find(':') == std::string::npos) {
        const auto alphas = parseNumbers(text, ',');
        if (alphas.empty()) throw InputError("--alpha", "", "no value");
        return alphas;
    }
    const auto numbers = parseNumbers(text, ':');
    if (numbers.size() != 3) {
        throw InputError("--alpha", "", "expected first:last:step or a list, found '" + text + "'");
    }
    return range(numbers[0], numbers[1], numbers[2]);
}

}  // namespace photonav
