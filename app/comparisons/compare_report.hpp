// SPDX-License-Identifier: BSD-3-Clause
// Tables, pictures and the page of `photonav compare`.
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "report/report.hpp"
#include "sweep/comparison.hpp"

namespace photonav {

/// The runs of all methods on one problem.
struct ProblemRuns {
    Config config;
    unsigned seeds = 0;  ///< number of runs per method, if it was not interrupted
    std::vector<CompareRun> runs;
};

/// The name of a config in the result, without line breaks and their like.
std::string nameOf(const Config& config);

/// The files of a comparison: for every config a table (<name>.md) and the paths from above
/// (<name>.png), and one page with all tables, on which the 3-D view shows the first config.
class CompareReport {
  public:
    /// @param hasConfig the result is that of a single config, and config.yaml is written
    CompareReport(std::filesystem::path folder, const std::string& commandLine, bool hasConfig);

    /// Writes the table of one problem, and adds it to the page. The world is used only here.
    void add(const ProblemRuns& problem, const World& world);

    /// Writes the page and the pictures; nothing if no problem was added.
    /// @param result content of result.json
    void write(const nlohmann::json& result);

  private:
    void begin(const ProblemRuns& problem, const World& world, std::vector<DrawnPath> paths);

    std::filesystem::path folder_;
    std::string commandLine_;
    bool hasConfig_;
    std::vector<std::string> names_;  // of the configs
    ReportData page_;
    std::vector<NamedFigure> figures_;
};

}  // namespace photonav
