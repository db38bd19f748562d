// SPDX-License-Identifier: BSD-3-Clause
// The runs of a sweep as a table: a row per planner and alpha, beside published values.
#pragma once

#include <map>
#include <nlohmann/json.hpp>
#include <optional>

#include "sweep/sweep_runs.hpp"

namespace photonav {

/// Mean and sample standard deviation; NaN of no values, the deviation also of a single one.
struct Statistic {
    double mean, deviation;
};

Statistic statisticOf(const std::vector<double>& values);

/// Best known cost by alpha.
class ReferenceCosts {
  public:
    ReferenceCosts() = default;

    /// Reads a CSV file with the columns `alpha` and `cost` among others.
    /// @throws InputError naming file and line
    explicit ReferenceCosts(const std::string& file);

    std::optional<double> at(double alpha) const;

    /// How far a run's cost is above the reference, as a fraction of it; NaN where there is none.
    double excess(const SweepRun& run) const;

  private:
    std::map<double, double> costs_;
};

/// All runs of one planner with one alpha.
struct SweepCell {
    std::string planner;
    double alpha = 0.;
    std::size_t runs = 0;
    std::size_t solved = 0;  ///< runs with a path: only these have a cost, length and traces
    std::map<std::string, Statistic> columns;  ///< by name, see sweepColumns()
    std::optional<PaperRow> paper;             ///< of a planner that uses views; traces in m^2
};

/// A column of the table: its name in result.json and how a run's value is found.
struct SweepColumn {
    std::string name;
    std::function<double(const SweepRun&)> value;
};

std::vector<SweepColumn> sweepColumns(const ReferenceCosts& reference);

/// In the config's order of planners and alphas; cells without runs are left out.
std::vector<SweepCell> summarize(const SweepConfig& config, const std::vector<SweepRun>& runs,
                                 const ReferenceCosts& reference);

/// A row of result.json's `summary`.
nlohmann::json toJson(const SweepCell& cell);

/// Rows of flat objects as CSV, nulls empty; `keys` gives the columns and their order.
std::string toCsv(const nlohmann::json& rows, const std::vector<std::string>& keys);

}  // namespace photonav
