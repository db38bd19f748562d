// SPDX-License-Identifier: BSD-3-Clause
// Writes the result files of a plan: path, figures and page.
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>

#include "problem/plan_result.hpp"
#include "problem/tree_evolution.hpp"
#include "recording/recorded_frames.hpp"
#include "report/problem_report.hpp"

namespace photonav {

/// Writes config.yaml, top_view.png, report.json and report.html. With a path it also writes
/// path.tum and trace.png and, if the world has texture, information.png and views.png. Other
/// figures: perspective.png if the world has texture and the bounds have a height,
/// recorded_frames.png if `recorded` is given, tree_evolution.png and an animation in the page if
/// there are evolutions.
/// @param baseline path of RRT* for comparison
/// @param recorded views along the path with the nearest recorded frames
/// @param evolutions growth of the trees, at the same stages for all planners; may be empty
/// @param result content of result.json
void writePlanReport(const std::filesystem::path& folder, const Config& config, const World& world,
                     PlanningProblem& problem, const PlanOutcome& outcome,
                     const std::optional<EvaluatedPath>& baseline,
                     const std::optional<RecordedComparison>& recorded,
                     const std::vector<TreeEvolution>& evolutions, const std::string& commandLine,
                     const nlohmann::json& result);

}  // namespace photonav
