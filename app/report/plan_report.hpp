// SPDX-License-Identifier: BSD-3-Clause
// The results of a plan: numbers, figures, page.
#pragma once

#include <filesystem>
#include <functional>
#include <nlohmann/json.hpp>

#include "figures/top_view.hpp"
#include "mapping/recorded_frames.hpp"
#include "problem/planning_problem.hpp"
#include "problem/tree_evolution.hpp"
#include "report/report.hpp"

namespace photonav {

/// result.json of `photonav plan`; time.total_s (until the report is drawn) is the caller's to
/// fill.
nlohmann::json planResult(const Config& config, const PlanOutcome& outcome,
                          const std::optional<EvaluatedPath>& baseline, bool interrupted);

/// Writes config.yaml, top_view.png, report.json and report.html; with a path also path.tum,
/// trace.png, information.png (unless the world has no texture), and recorded_frames.png where
/// there is a recording to compare with; tree_evolution.png and an animation in the page if there
/// are evolutions.
void writePlanReport(const std::filesystem::path& folder, const Config& config, const World& world,
                     PlanningProblem& problem, const PlanOutcome& outcome,
                     const std::optional<EvaluatedPath>& baseline,
                     const std::optional<RecordedComparison>& recorded,
                     const std::vector<TreeEvolution>& evolutions, const std::string& commandLine,
                     const nlohmann::json& result);

/// A path to be drawn, with its beliefs.
DrawnPath drawnPath(const EvaluatedPath& path, const Pose& T_b_c);

/// Puts the surfaces of the world into the report's 3-D view.
void describeWorld(const World& world, ReportData& report);

/// The page of a planning problem, without a title: config, world, start and goal.
ReportData problemReport(const Config& config, const World& world, const std::string& commandLine,
                         const nlohmann::json& result);

/// Start, goal and paths over what lies below the bounds.
TopView viewFromAbove(const Config& config, const World& world,
                      const std::vector<DrawnPath>& paths);

/// A figure and the file it goes to.
struct NamedFigure {
    std::string name;
    ReportFigure figure;
};

/// Writes the figures (also into the report), config.yaml (unless the report has none), report.json
/// and report.html. result.json comes last and is the command's: where it is, the folder is
/// complete.
void writeResultFolder(const std::filesystem::path& folder, ReportData& report,
                       const std::vector<NamedFigure>& figures);

/// Where the views of a heat map are: the height, and the heading [rad] where it is free.
std::string placeText(const Config& config, double height, double yaw);

/// A value of the view from every cell of a horizontal grid; NaN where the robot cannot be.
/// @param cells about how many along the longer side
/// @param value of the view's Fisher information (camera frame)
Eigen::ArrayXXd viewGrid(PlanningProblem& problem, const Eigen::AlignedBox2d& area, double height,
                         double yaw, int cells, const std::function<double(const Matrix6&)>& value);

}  // namespace photonav
