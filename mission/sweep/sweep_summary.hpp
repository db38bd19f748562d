// SPDX-License-Identifier: BSD-3-Clause
// Summary of the runs of a sweep: one row per planner and alpha, with published values to compare.
#pragma once

#include <map>
#include <nlohmann/json.hpp>
#include <optional>

#include "sweep/sweep_runs.hpp"

namespace photonav {

/// Mean and sample standard deviation. Both are NaN without values; the deviation is also NaN for a
/// single value.
struct Statistic {
    double mean, deviation;
};

Statistic statisticOf(const std::vector<double>& values);

/// The best known cost for each alpha.
class ReferenceCosts {
  public:
    ReferenceCosts() = default;

    /// Reads a CSV file with the columns `alpha` and `cost` among others.
    /// @throws InputError naming file and line
    explicit ReferenceCosts(const std::string& file);

    /// The cost for an alpha (to 1e-6); nothing if there is none.
    std::optional<double> at(double alpha) const;

    /// Relative excess of a run's cost over the reference: cost / reference - 1. NaN without a
    /// reference or a path.
    double excess(const SweepRun& run) const;

  private:
    std::map<double, double> costs_;
};

/// Summary of all runs of one planner with one alpha.
struct SweepCell {
    std::string planner;
    double alpha = 0.;
    std::size_t runs = 0;
    std::size_t solved = 0;  ///< runs with a path; only these have cost, length and traces
    std::map<std::string, Statistic> columns;  ///< by name, see sweepColumns()
    std::optional<PaperRow> paper;  ///< published values, for planners that use views; traces [m^2]
};

/// A column of the table: its name in result.json, and a function that returns a run's value.
struct SweepColumn {
    std::string name;
    std::function<double(const SweepRun&)> value;
};

/// All columns: cost, length, traces, vertices, views, seconds and excess over the reference.
std::vector<SweepColumn> sweepColumns(const ReferenceCosts& reference);

/// One cell per planner and alpha, in the order of the config; cells without runs are left out.
std::vector<SweepCell> summarize(const SweepConfig& config, const std::vector<SweepRun>& runs,
                                 const ReferenceCosts& reference);

/// A cell as a row of `summary` in result.json.
nlohmann::json toJson(const SweepCell& cell);

/// A list of flat JSON objects as CSV. Null values give empty fields.
/// @param keys the columns, in their order
std::string toCsv(const nlohmann::json& rows, const std::vector<std::string>& keys);

}  // namespace photonav
