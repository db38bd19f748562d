// SPDX-License-Identifier: BSD-3-Clause
#include "recordings/replay_report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>
#include <vector>

#include "figures/replay_figures.hpp"
#include "figures/top_view.hpp"
#include "replay/replay_tables.hpp"
#include "report/problem_report.hpp"

namespace photonav {
namespace {

using nlohmann::json;
namespace fs = std::filesystem;

constexpr Color kEstimateColor = kIndigo, kTruthColor = kPurple;  // as on the page
constexpr double kOverconfident = 3.;  // NEES per degree of freedom that is stated in words
/// Above this standard deviation of the measured squared point spread, sharp images and images with
/// a blur of one pixel cannot be told apart [pixels^2].
constexpr double kTooVague = 0.5;

/// "0.0123 m", or `none` for a missing value.
std::string number(const json& value, double factor, const char* format,
                   const char* none = "not known") {
    if (!value.is_number()) return none;
    return fmt::format(fmt::runtime(format), factor * value.get<double>());
}

std::string relative(const json& rpe) {
    if (!rpe.is_object()) return "recording too short";
    return fmt::format("{:.2f} mm, {:.3f} deg (rms of {})",
                       1e3 * rpe["translation_m"].get<double>(), rpe["rotation_deg"].get<double>(),
                       rpe["pairs"].get<std::size_t>());
}

std::string calibrationText(const json& c) {
    std::string text = fmt::format(
        "--scale {:.3g} --least-sigma {:.3g} --least-sigma-rotation {:.3g} (NEES of single "
        "alignments {:.3g}, "
        "then {:.3g}",
        c["scale"].get<double>(), c["least_sigma"][0].get<double>(),
        c["least_sigma"][1].get<double>(), c["nees_before"].get<double>(),
        c["nees_after"].get<double>());
    const auto alike = c["correlation_time"].get<double>();
    if (alike > 1.) text += fmt::format("; errors correlated over {:.3g} images", alike);
    text += ")";
    if (!c["depth_error"].is_number()) return text;
    return text +
           fmt::format("; or depth_error: {:.3g} in camera.yaml", c["depth_error"].get<double>());
}

std::string blurText(const json& blur) {
    const std::string assumed = fmt::format("{:.2f} pixels assumed", blur["assumed"].get<double>());
    if (!blur["estimated"].is_number()) return assumed;
    const double sigma = blur["variance_sigma"];
    if (sigma > kTooVague && !blur["contradicts"].get<bool>())
        return assumed + "; these images do not show it";
    return fmt::format("{}, {:.2f} by the images{}", assumed, blur["estimated"].get<double>(),
                       blur["contradicts"].get<bool>() ? ": give `blur` in camera.yaml" : "");
}

DrawnPath estimatedPath(const ReplayRun& run) {
    DrawnPath path{"estimate", kEstimateColor};
    for (const StampedBelief& belief : beliefsOf(run))
        append(path, makePathPoint(belief.T_c_w, weightedTrace(belief.T_c_w.covariance), 0., 0.));
    return path;
}

DrawnPath truePath(const ReplayRun& run) {
    DrawnPath path{"ground truth", kTruthColor};
    for (const ReplayedFrame& frame : run.frames)
        if (frame.truth_c_w)
            append(path, makePathPoint({*frame.truth_c_w, Matrix6::Zero()}, 0., 0., 0.));
    return path;
}

/// The paths with a margin, not narrower than a third of its length.
Eigen::AlignedBox2d areaOf(const std::vector<DrawnPath>& paths) {
    Eigen::AlignedBox2d area;
    for (const DrawnPath& path : paths) {
        for (const PathPoint& point : path.points) area.extend(point.position.head<2>());
    }
    const double side = std::max(area.sizes().maxCoeff(), 0.02);
    const Eigen::Vector2d half =
        (0.5 * area.sizes()).cwiseMax(side / 6.) + Eigen::Vector2d::Constant(0.08 * side);
    return {Eigen::Vector2d(area.center() - half), Eigen::Vector2d(area.center() + half)};
}

Figure topView(const std::vector<DrawnPath>& paths, const std::string& title) {
    TopView view;
    view.title = title;
    view.paths = paths;
    view.area = areaOf(paths);
    view.start = paths[0].points.front().position;
    view.goal = paths[0].points.back().position;
    view.goalName = "end";
    view.ellipseScale = readableEllipseScale({paths[0]}, view.area.sizes().maxCoeff());
    return topViewFigure(view);
}

std::vector<NamedFigure> figuresOf(const ReplayRun& run, const ReplayErrors& errors,
                                   const std::vector<DrawnPath>& paths, const std::string& name) {
    std::vector<NamedFigure> figures;
    if (!paths.empty()) {
        const std::string caption = run.alignedFrame
                                        ? fmt::format(
                                              "From above. The estimate is placed at the "
                                              "true pose of image {}, not aligned as a "
                                              "whole.",
                                              *run.alignedFrame)
                                        : "From above.";
        figures.push_back({"top_view", caption, topView(paths, name)});
    }
    if (!run.frames.empty()) {
        figures.push_back(
            {"errors",
             "Error and predicted standard deviation (root of the trace) over time; below, the "
             "NEES per degree of freedom, 1 on average if the covariances are consistent.",
             replayErrorsFigure("Error and prediction", run, errors)});
    }
    if (!run.strips.empty()) {
        const char* caption =
            run.odometry
                ? "Observed; the keyframe rendered at the estimated pose and exposure; their "
                  "difference (violet: none, yellow: 0.25 of the grey scale)."
                : "Observed; the map rendered at the estimated pose and exposure; their difference "
                  "(violet: none, yellow: 0.25 of the grey scale).";
        figures.push_back({"strips", caption, stripsFigure(run.strips)});
    }
    return figures;
}

using TableRows = std::vector<std::pair<std::string, std::string>>;

/// With a warning where covariances are overconfident.
std::string neesText(const json& result) {
    const double nees = result["nees_per_dof"], median = result["nees_median_per_dof"];
    const std::string text = fmt::format("{:.3g}, {:.3g}", nees, median);
    if (nees < kOverconfident || result.contains("calibration")) return text;
    if (median < kOverconfident) return text + ": overconfident in some images (frames.csv)";
    return text + fmt::format(
                      ": overconfident, errors are {:.1f} times the predicted ones in the "
                      "median (--calibrate)",
                      std::sqrt(median));
}

TableRows errorRows(const json& result) {
    if (result["judged"] == 0) return {{"errors", "not known: no tracked image has a true pose"}};
    const auto& rpe = result["rpe"];
    const bool isLaidLater = result["aligned_frame"].is_number() && result["aligned_frame"] > 0;
    const std::string nees = result["nees_per_dof"].is_number() ? neesText(result)
                             : isLaidLater
                                 ? "not known: the first image has no true pose (--frames)"
                                 : "not known";
    const std::string aligned = result["ate_alignment"] == "none" ? "not aligned" : "SE(3) aligned";
    const auto absolute = [&](const char* key, double factor, const char* format) {
        return number(result[key], factor, format,
                      "not known: fewer than 3 images with true poses");
    };
    return {
        {fmt::format("absolute error ({}), rms", aligned),
         absolute("ate_rmse_m", 1e3, "{:.2f} mm")},
        {"absolute error, largest", absolute("ate_max_m", 1e3, "{:.2f} mm")},
        {"absolute error of orientation, rms", absolute("ate_rotation_rmse_deg", 1., "{:.3f} deg")},
        {"relative error over a frame", relative(rpe["frame"])},
        {"relative error over a second", relative(rpe["second"])},
        {"relative error over a metre", relative(rpe["metre"])},
        {"NEES per degree of freedom (1: consistent), mean, median", nees}};
}

std::string degenerateText(const json& result) {
    const int count = result["degenerate"];
    return count > 0 ? fmt::format(" ({} degenerate)", count) : "";
}

/// The systematic errors that the covariances of odometry include, if there are any.
std::string depthErrorText(const json& dataset) {
    std::string text =
        fmt::format("{:g} % of the motion", 100. * dataset["depth_error"].get<double>());
    if (dataset["depth_error_assumed"].get<bool>()) {
        text += fmt::format(", assumed (noise {:.1f} mm at 1 m, no depth_error in camera.yaml)",
                            1e3 * dataset["depth_noise_m"].get<double>());
    }
    return text;
}

ReportFrame reportFrame(const ReplayStrip& strip, const ReplayedFrame& frame) {
    ReportFrame shown{strip.caption, stripFigure(strip).png()};
    const UncertainPose& T_c_w = frame.tracked.T_c_w;
    shown.believed = makePathPoint(T_c_w, weightedTrace(T_c_w.covariance), 0., 0.);
    if (frame.truth_c_w) shown.truth = frame.truth_c_w->inverse().translation();
    shown.color = kEstimateColor;
    return shown;
}

}  // namespace

ReportTable replaySummary(const json& result) {
    const bool isStereo = result["dataset"]["layout"] == "EuRoC";
    ReportTable table{"Replay", {}};
    table.rows = {
        {"verdict", result["verdict"].get<std::string>()},
        {"frames tracked, lost, unreadable",
         fmt::format("{}{}, {}, {}", result["tracked"].dump(), degenerateText(result),
                     result["lost"].dump(), result["unreadable"].dump())},
        {"skipped, gaps in time",
         fmt::format("{}, {}", result["skipped"].size(), result["gaps"].size())},
    };
    if (result["mode"] == "cells") {
        table.rows.emplace_back("map",
                                "has no surfaces inside its cells: poses may be wrong by half a "
                                "cell, and covariances too small (photonav map makes surfaces "
                                "from images with depth)");
    }
    for (auto& row : errorRows(result)) table.rows.push_back(std::move(row));
    table.rows.emplace_back(
        isStereo ? "pixels with depth from stereo" : "pixels with recorded depth",
        number(result["depth_density"], 100., "{:.1f} %", "none"));
    if (result["dataset"]["depth_error"] != 0.) {
        table.rows.emplace_back("error of depth that repeats from image to image",
                                depthErrorText(result["dataset"]));
    }
    if (result.contains("blur")) {
        table.rows.emplace_back("point spread of the images", blurText(result["blur"]));
    }
    table.rows.emplace_back(
        isStereo ? "tracking; with reading images and stereo" : "tracking; with reading images",
        number(result["fps"], 1., "{:.0f} frames/s; ", "nothing tracked; ") +
            number(result["fps_with_reading"], 1., "{:.0f} frames/s", "none"));
    if (result.contains("calibration")) {
        const json& c = result["calibration"];
        table.rows.emplace_back("calibrated", c.is_null()
                                                  ? "fewer than 20 alignments with a true pose"
                                                  : calibrationText(c));
    }
    return table;
}

void writeReplayReport(const std::filesystem::path& folder, const ReplayCommandOptions& options,
                       const std::string& config, const json& result, const Replay& replay,
                       const ReplayRun& run, const ReplayErrors& errors) {
    const std::string name =
        (fs::path(options.dataset) / "").lexically_normal().parent_path().filename().string();
    ReportData report;
    report.title = "Replay of " + name;
    report.subtitle = options.odometry ? "Odometry from image to image: errors accumulate."
                                       : "Localisation of every image in " +
                                             fs::path(options.mapFile).filename().string() + ".";
    report.commandLine = options.commandLine;
    report.result = result;
    report.config = config;
    report.tables = {replaySummary(result)};
    report.fieldOfView = fieldOfView(replay.recording().sequence.camera);
    if (const TexturedOcTree* map = replay.map().octree.get()) report.voxels = drawnVoxels(*map);
    if (const Scene* scene = replay.map().scene.get()) report.mesh = drawnMesh(*scene);
    std::array paths{estimatedPath(run), truePath(run)};
    for (DrawnPath& path : paths) {
        if (!path.points.empty()) report.paths.push_back(std::move(path));
    }
    if (!report.paths.empty()) {
        report.start = report.paths[0].points.front().position;
        report.goal = report.paths[0].points.back().position;
    }
    for (const ReplayStrip& strip : run.strips) {
        report.frames.push_back(reportFrame(strip, run.frames[strip.frame]));
    }
    writeResultFolder(folder, report, figuresOf(run, errors, report.paths, name));
}

}  // namespace photonav
