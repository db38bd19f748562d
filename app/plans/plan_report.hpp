// SPDX-License-Identifier: BSD-3-Clause
// The results of a plan: numbers, figures, page.
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>

#include "problem/plan_result.hpp"
#include "problem/tree_evolution.hpp"
#include "recording/recorded_frames.hpp"
#include "report/problem_report.hpp"

namespace photonav {

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

}  // namespace photonav
