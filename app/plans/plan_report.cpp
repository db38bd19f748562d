// SPDX-License-Identifier: BSD-3-Clause
#include "plans/plan_report.hpp"

#include <fmt/format.h>

#include "dataset/image_file.hpp"
#include "dataset/trajectory.hpp"
#include "figures/comparison_images.hpp"
#include "figures/cutaway.hpp"
#include "figures/heat_map.hpp"
#include "figures/images.hpp"
#include "figures/perspective.hpp"
#include "figures/trace.hpp"
#include "figures/tree_evolution_figure.hpp"
#include "geometry/se3.hpp"
#include "shared/command_io.hpp"

namespace photonav {
namespace fs = std::filesystem;
using nlohmann::json;
namespace {

constexpr std::size_t kMaxViews = 60;  // pictures in the report
constexpr int kHeatMapCells = 28;
constexpr std::size_t kViewRows = 2;  // of the figure of views
constexpr std::size_t kViewsPerRow = 3;

/// The predicted views at the waypoints, and the contributions of their pixels.
std::vector<ReportView> waypointViews(const EvaluatedPath& path, const Config& config,
                                      const World& world) {
    std::vector<std::size_t> waypoints;
    for (std::size_t i = 0; i < path.points.size(); ++i) {
        if (path.points[i].isWaypoint) waypoints.push_back(i);
    }
    std::vector<std::size_t> drawn;
    const std::size_t stride = 1 + waypoints.size() / kMaxViews;
    for (std::size_t k = 0; k < waypoints.size(); k += stride) drawn.push_back(waypoints[k]);
    return reportViews(config, world, path, drawn);
}

/// The most informative predicted view of each of several equal parts of the path.
Figure viewsFigure(const EvaluatedPath& path, const Config& config, const World& world) {
    const Camera camera = config.camera.camera();
    constexpr std::size_t kViews = kViewRows * kViewsPerRow;
    std::vector<std::vector<CaptionedImage>> rows(kViewRows);
    for (std::size_t k = 0; k < kViews; ++k) {
        const auto part = [&](std::size_t i) {
            return path.points.begin() + static_cast<long>(i * path.points.size() / kViews);
        };
        const auto end = std::max(part(k + 1), part(k) + 1);
        const BeliefPoint& point =
            *std::max_element(part(k), end, [](const BeliefPoint& a, const BeliefPoint& b) {
                return a.information.trace() < b.information.trace();
            });
        View view;
        world.views().render(camera, (point.T_w_b * config.camera.T_b_c()).inverse(), view);
        rows[k / kViewsPerRow].push_back(
            {fmt::format("at {:.1f} m", point.length), predictedPicture(view)});
    }
    return imagesFigure(rows, 300.);
}

TopView topView(const Config& config, const World& world, const PlanOutcome& outcome,
                const std::vector<DrawnPath>& paths) {
    TopView view = viewFromAbove(config, world, paths);
    view.title = fmt::format("{}, alpha {}", config.planner, outcome.alpha);
    view.trees = {{"search tree", kTreeColor, outcome.tree}};
    return view;
}

HeatMap heatMap(const Config& config, PlanningProblem& problem) {
    const double height = config.start.position.z();
    const double yaw = config.start.yaw.value_or(0.);
    HeatMap map;
    map.title = "Information of one view at " + placeText(config, height, yaw);
    map.label = "trace of the Fisher information [1/m², 1/rad²]";
    map.area = areaOf(config);
    map.values = viewGrid(problem, map.area, height, yaw, kHeatMapCells,
                          [](const Matrix6& information) { return information.trace(); });
    map.logScale = true;
    return map;
}

/// A view of the bounds of the robot and the obstacles around them, from the floor to their top.
Perspective perspective(const Config& config, const World& world, const PlanOutcome& outcome,
                        const std::vector<DrawnPath>& paths) {
    Eigen::AlignedBox3d box = config.bounds;
    const double margin = 0.1 * box.sizes().maxCoeff();
    box.min().array() -= margin;
    box.max().array() += margin;
    const Eigen::AlignedBox3d extent = world.extent();
    box = box.intersection(extent).merged(config.bounds);
    box.min().z() = std::min(box.min().z(), extent.min().z());
    box.max().z() = config.bounds.max().z();
    return {fmt::format("{}, alpha {}", config.planner, outcome.alpha), box, paths};
}

void writeTrajectory(const fs::path& file, const EvaluatedPath& path, const Pose& T_b_c) {
    Trajectory trajectory;  // one metre per second
    for (const BeliefPoint& point : path.points) {
        trajectory.push_back({point.length, point.T_w_b * T_b_c});
    }
    writeTrajectory(file.string(), trajectory);
}

std::vector<NamedFigure> planFigures(const Config& config, const World& world,
                                     PlanningProblem& problem, const PlanOutcome& outcome,
                                     const std::optional<RecordedComparison>& recorded,
                                     const std::vector<DrawnPath>& paths) {
    std::vector<NamedFigure> figures{
        {"top_view", "From above: search tree, paths and 3σ ellipses of the position.",
         topViewFigure(topView(config, world, outcome, paths))}};
    if (!paths.empty() && world.hasTexture()) {
        figures.push_back({"information",
                           config.space == StateKind::position
                               ? "Trace of the Fisher information of one view, over the area."
                               : "Trace of the Fisher information of one view, over the area, "
                                 "with the heading of "
                                 "the start; along the paths the heading changes.",
                           heatMapFigure(heatMap(config, problem))});
    }
    if (config.bounds.sizes().z() > 0. && world.hasTexture()) {
        figures.push_back(
            {"perspective",
             "In perspective, cut open above the bounds of the robot and at the near walls. The "
             "paths have shadows, and are thin where they are hidden.",
             perspectiveFigure(*cutawayViews(world, config.bounds),
                               perspective(config, world, outcome, paths))});
    }
    if (!paths.empty()) {
        figures.push_back(
            {"trace", "Trace of the pose covariance along the path, before and after every image.",
             traceFigure("Uncertainty along the path", paths, true)});
    }
    if (outcome.path && world.hasTexture()) {
        figures.push_back({"views",
                           "What the camera would see along the path: the most informative view "
                           "of each sixth of it.",
                           viewsFigure(*outcome.path, config, world)});
    }
    if (recorded) {
        const auto mean = meanDifference(*recorded);
        figures.push_back(
            {"recorded_frames",
             "Views along the path and the recorded frames nearest to them" +
                 (mean ? fmt::format("; the mean absolute difference between the frames and the "
                                     "predictions at their poses is {:.3f}.",
                                     *mean)
                       : "; the map predicts none of their pixels."),
             recordedFramesFigure(*recorded)});
    }
    return figures;
}

}  // namespace

void writePlanReport(const fs::path& folder, const Config& config, const World& world,
                     PlanningProblem& problem, const PlanOutcome& outcome,
                     const std::optional<EvaluatedPath>& baseline,
                     const std::optional<RecordedComparison>& recorded,
                     const std::vector<TreeEvolution>& evolutions, const std::string& commandLine,
                     const json& result) {
    const Pose T_b_c = config.camera.T_b_c();
    ReportData report = problemReport(config, world, commandLine, result);
    report.title = fs::path(config.file).stem().string();
    report.subtitle = fmt::format("{}, alpha {}, {} vertices, seed {}", config.planner,
                                  outcome.alpha, outcome.vertices, config.seed);
    report.trees = {{"search tree", kTreeColor, outcome.tree}};
    if (outcome.path) report.paths.push_back(drawnPath(*outcome.path, T_b_c));
    if (baseline) report.paths.push_back(drawnPath(*baseline, T_b_c));
    if (outcome.path && world.hasTexture()) {
        report.views = waypointViews(*outcome.path, config, world);
    }
    report.progress = outcome.progress;

    std::vector<NamedFigure> figures =
        planFigures(config, world, problem, outcome, recorded, report.paths);
    if (!evolutions.empty()) {
        const TopView map = topView(config, world, outcome, {});
        figures.push_back(
            {"tree_evolution",
             "The trees as they grow, and the best path so far. They were grown again for this "
             "figure, with a pause at every number of vertices; the path found by then guides the "
             "samples, so the last path may differ from the result above.",
             treeEvolutionFigure(map, evolutions, {10, 500, config.vertices})});
        for (const TreeStage& stage : evolutions.front().stages) {
            report.frames.push_back({fmt::format("{} vertices", stage.vertices),
                                     treeEvolutionFigure(map, evolutions, {stage.vertices}).png()});
        }
    }
    if (outcome.path) writeTrajectory(folder / "path.tum", *outcome.path, T_b_c);
    writeResultFolder(folder, report, figures);
}

}  // namespace photonav
