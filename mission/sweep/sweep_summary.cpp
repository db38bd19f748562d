// SPDX-License-Identifier: BSD-3-Clause
#include "sweep/sweep_summary.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <sstream>

#include "geometry/constants.hpp"
#include "io/error.hpp"
#include "io/number.hpp"
#include "io/text_table.hpp"
#include "planners/planner_traits.hpp"
#include "result/json_values.hpp"

namespace photonav {
using nlohmann::json;
namespace {

constexpr double kSameAlpha = 1e-6;
constexpr double kLeastReference = 1e-9, kMostReference = 1e12;  // of a reference

std::vector<std::string> fieldsOf(std::string line) {
    if (line.ends_with('\r')) line.pop_back();
    std::vector<std::string> fields;
    std::istringstream stream(line);
    for (std::string field; std::getline(stream, field, ',');) fields.push_back(field);
    return fields;
}

double numberOf(const std::vector<std::string>& fields, std::size_t column, const std::string& file,
                int line) {
    const auto value = column < fields.size() ? numberIn(fields[column]) : std::nullopt;
    if (value && std::isfinite(*value)) return *value;
    throw InputError(file, fmt::format("line {}", line), "expected a number in every column");
}

std::string csvField(const json& value) {
    if (value.is_null()) return "";
    if (!value.is_string()) return value.dump();
    std::string text = value;
    if (text.find_first_of(",\"\n") == std::string::npos) return text;
    std::string quoted = "\"";
    for (const char c : text) quoted += c == '"' ? "\"\"" : std::string(1, c);
    return quoted + '"';
}

}  // namespace

Statistic statisticOf(const std::vector<double>& values) {
    if (values.empty()) return {kNone, kNone};
    const auto n = static_cast<double>(values.size());
    const double mean = std::accumulate(values.begin(), values.end(), 0.) / n;
    double squares = 0.;
    for (const double value : values) squares += (value - mean) * (value - mean);
    return {mean, values.size() > 1 ? std::sqrt(squares / (n - 1.)) : kNone};
}

ReferenceCosts::ReferenceCosts(const std::string& file) {
    std::ifstream stream = openText(file);
    std::string line;
    int number = 1;
    while (std::getline(stream, line) && line.starts_with('#')) ++number;
    const auto names = fieldsOf(line);
    const auto column = [&](const char* name) {
        const auto it = std::find(names.begin(), names.end(), name);
        if (it == names.end()) {
            throw InputError(file, fmt::format("line {}", number),
                             fmt::format("no column {}", name));
        }
        return static_cast<std::size_t>(it - names.begin());
    };
    const std::size_t alpha = column("alpha");
    const std::size_t cost = column("cost");
    while (std::getline(stream, line)) {
        ++number;
        if (line.empty()) continue;
        const auto fields = fieldsOf(line);
        const double value = numberOf(fields, cost, file, number);
        const auto fail = [&](const std::string& reason) {
            throw InputError(file, fmt::format("line {}", number), reason);
        };
        if (!(value >= kLeastReference && value <= kMostReference)) {
            fail(fmt::format("the cost is not between {:g} and {:g}", kLeastReference,
                             kMostReference));
        }
        const double key = numberOf(fields, alpha, file, number);
        if (const auto known = at(key); known && *known != value) {
            fail(fmt::format("alpha {} is there twice, with different costs", key));
        }
        costs_[key] = value;
    }
}

std::optional<double> ReferenceCosts::at(double alpha) const {
    const auto it = costs_.lower_bound(alpha - kSameAlpha);
    if (it == costs_.end() || it->first > alpha + kSameAlpha) return std::nullopt;
    return it->second;
}

double ReferenceCosts::excess(const SweepRun& run) const {
    const auto best = at(run.item.alpha);
    return best ? run.cost / *best - 1. : kNone;
}

std::vector<SweepColumn> sweepColumns(const ReferenceCosts& reference) {
    return {{"cost", [](const SweepRun& run) { return run.cost; }},
            {"length", [](const SweepRun& run) { return run.length; }},
            {"mean_trace", [](const SweepRun& run) { return run.meanTrace; }},
            {"goal_trace", [](const SweepRun& run) { return run.goalTrace; }},
            {"vertices", [](const SweepRun& run) { return static_cast<double>(run.vertices); }},
            {"views", [](const SweepRun& run) { return static_cast<double>(run.views); }},
            {"seconds", [](const SweepRun& run) { return run.seconds; }},
            {"excess", [reference](const SweepRun& run) { return reference.excess(run); }}};
}

std::vector<SweepCell> summarize(const SweepConfig& config, const std::vector<SweepRun>& runs,
                                 const ReferenceCosts& reference) {
    std::map<std::pair<std::string, double>, std::vector<const SweepRun*>> byCell;
    for (const SweepRun& run : runs) byCell[{run.item.planner, run.item.alpha}].push_back(&run);
    const auto columns = sweepColumns(reference);
    std::vector<SweepCell> cells;
    for (const std::string& planner : config.planners) {
        for (const double alpha : config.alphas) {
            const auto& members = byCell[{planner, alpha}];
            if (members.empty()) continue;
            SweepCell cell;
            cell.planner = planner;
            cell.alpha = alpha;
            cell.runs = members.size();
            for (const SweepRun* run : members) cell.solved += run->isSolved() ? 1 : 0;
            for (const SweepColumn& column : columns) {
                std::vector<double> values;
                for (const SweepRun* run : members) values.push_back(column.value(*run));
                std::erase_if(values, [](double value) { return std::isnan(value); });
                cell.columns[column.name] = statisticOf(values);
            }
            for (PaperRow row : config.paper) {
                if (!usesViews(planner) || std::abs(row.alpha - alpha) > kSameAlpha) continue;
                row.meanTrace *= config.paperTraceUnit;
                row.goalTrace *= config.paperTraceUnit;
                cell.paper = row;
            }
            cells.push_back(cell);
        }
    }
    return cells;
}

json toJson(const SweepCell& cell) {
    json row{{"planner", cell.planner},
             {"alpha", cell.alpha},
             {"runs", cell.runs},
             {"solved", cell.solved}};
    for (const auto& [name, statistic] : cell.columns) {
        row[name + "_mean"] = finiteOrNull(statistic.mean);
        row[name + "_std"] = finiteOrNull(statistic.deviation);
    }
    row["paper_length"] = cell.paper ? json(cell.paper->length) : json();
    row["paper_mean_trace"] = cell.paper ? json(cell.paper->meanTrace) : json();
    row["paper_goal_trace"] = cell.paper ? json(cell.paper->goalTrace) : json();
    return row;
}

std::string toCsv(const json& rows, const std::vector<std::string>& keys) {
    std::string text = fmt::format("{}\n", fmt::join(keys, ","));
    for (const json& row : rows) {
        std::vector<std::string> fields;
        fields.reserve(keys.size());
        for (const std::string& key : keys) fields.push_back(csvField(row.at(key)));
        text += fmt::format("{}\n", fmt::join(fields, ","));
    }
    return text;
}

}  // namespace photonav
