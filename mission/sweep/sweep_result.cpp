// SPDX-License-Identifier: BSD-3-Clause
#include "sweep/sweep_result.hpp"

#include <algorithm>
#include <cmath>

#include "geometry/constants.hpp"
#include "io/atomic_file.hpp"
#include "result/json_values.hpp"

namespace photonav {
using nlohmann::json;
namespace {

const std::vector<std::string> kRunKeys{"planner", "alpha",      "seed",       "cost",
                                        "length",  "mean_trace", "goal_trace", "vertices",
                                        "views",   "seconds",    "excess",     "status"};

std::vector<std::string> summaryKeys(const ReferenceCosts& reference) {
    std::vector<std::string> keys{"planner", "alpha", "runs", "solved"};
    for (const SweepColumn& column : sweepColumns(reference)) {
        keys.push_back(column.name + "_mean");
        keys.push_back(column.name + "_std");
    }
    for (const char* key : {"paper_length", "paper_mean_trace", "paper_goal_trace"}) {
        keys.emplace_back(key);
    }
    return keys;
}

}  // namespace

std::string sweepStatus(const std::vector<SweepRun>& runs, bool interrupted) {
    if (interrupted) return "interrupted";
    return std::ranges::any_of(runs, &SweepRun::isSolved) ? "done" : "no path";
}

int traceDecimals(const std::vector<SweepCell>& cells) {
    double smallest = kInfinity;
    for (const SweepCell& cell : cells) {
        for (const char* column : {"mean_trace", "goal_trace"}) {
            const double mean = cell.columns.at(column).mean;
            if (mean > 0.) smallest = std::min(smallest, mean);
        }
    }
    constexpr int kFewest = 4;
    if (smallest == kInfinity) return kFewest;
    return std::max(kFewest, 1 - static_cast<int>(std::floor(std::log10(smallest))));
}

json sweepResult(const Config& config, const SweepOutcome& outcome,
                 const ReferenceCosts& reference) {
    json result = resultJson("sweep", {{"status", sweepStatus(outcome.runs, outcome.interrupted)},
                                       {"config", outcome.name},
                                       {"planners", config.sweep.planners},
                                       {"alphas", config.sweep.alphas},
                                       {"kappa", config.belief.kappa},
                                       {"first_seed", config.seed},
                                       {"runs_per_cell", config.sweep.runs},
                                       {"shard", toString(outcome.shard)},
                                       {"runs_done", outcome.runs.size()},
                                       {"runs_asked", outcome.asked},
                                       {"time", {{"total_s", outcome.seconds}}},
                                       {"runs", json::array()},
                                       {"summary", json::array()}});
    for (const SweepRun& run : outcome.runs) {
        json row = toJson(run);
        row["excess"] = finiteOrNull(reference.excess(run));
        result["runs"].push_back(row);
    }
    const auto cells = summarize(config.sweep, outcome.runs, reference);
    result["trace_decimals"] = traceDecimals(cells);
    for (const SweepCell& cell : cells) result["summary"].push_back(toJson(cell));
    return result;
}

void writeSweepTables(const std::filesystem::path& folder, const json& result,
                      const ReferenceCosts& reference) {
    writeFileAtomically(folder / "runs.csv", toCsv(result["runs"], kRunKeys));
    writeFileAtomically(folder / "summary.csv", toCsv(result["summary"], summaryKeys(reference)));
}

}  // namespace photonav
