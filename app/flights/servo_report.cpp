// SPDX-License-Identifier: BSD-3-Clause
#include "report/servo_report.hpp"

#include <fmt/format.h>

#include <cmath>

#include "dataset/image_file.hpp"
#include "geometry/constants.hpp"
#include "plot/figure.hpp"
#include "report/problem_report.hpp"
#include "result/json_values.hpp"

namespace photonav {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

constexpr double kPercent = 100.;

bool isOpen(const ServoStudy& study) {
    return study.modes.empty() || !(study.modes.front().rate > 0.);
}

Color colorOf(std::size_t i, std::size_t count) {
    return viridis(0.9 * static_cast<double>(i) /
                   static_cast<double>(std::max<std::size_t>(count, 2) - 1));
}

/// A curve an angle: the share of starts that converge over their distance.
Figure basinFigure(const ServoReport& report) {
    Plot plot;
    plot.x = {.min = 0., .label = "distance of the start from the goal [m]"};
    plot.y = {.min = 0., .max = kPercent, .label = "converged [%]"};
    const auto& angles = report.options.angles;
    for (std::size_t k = 0; k < angles.size(); ++k) {
        Plot::Points curve, low, high;
        for (const BasinCell& cell : report.study.basin) {
            if (cell.angle != angles[k]) continue;
            curve.emplace_back(cell.distance, kPercent * cell.converged / cell.trials);
            low.emplace_back(cell.distance, kPercent * cell.low);
            high.emplace_back(cell.distance, kPercent * cell.high);
        }
        if (curve.empty()) continue;
        const Color color = colorOf(k, angles.size());
        plot.band(low, high, {.color = color, .opacity = 0.15});
        plot.curve(curve, {.color = color,
                           .width = 2.6,
                           .name = fmt::format("rotated by {:g} degrees", angles[k])});
        plot.dots(curve, {.color = color, .width = 7.});
    }
    return {.title = "From how far the servo converges (bands: 95 % intervals)", .rows = {{plot}}};
}

/// Rates of the modes, predicted and simulated.
Figure modesFigure(const ServoReport& report) {
    Plot plot;
    plot.x = {.min = 0.5,
              .max = 0.5 + static_cast<double>(report.study.modes.size()),
              .label = "direction, the slowest first"};
    plot.y = {.min = 0., .label = "decrease of an offset [1/s]"};
    Plot::Points predicted, simulated;
    for (const ServoMode& mode : report.study.modes) {
        const double x = static_cast<double>(predicted.size() + 1);
        predicted.emplace_back(x, mode.predictedDecay);
        simulated.emplace_back(x, mode.simulatedDecay);
    }
    plot.dots(
        predicted,
        {.color = plannerColor("rrt_star"), .width = 16., .name = "predicted by the Hessian"});
    plot.dots(simulated,
              {.color = plannerColor("belief_rrt_star"), .width = 8., .name = "simulated"});
    return {.title = "How fast offsets shrink, direction by direction", .rows = {{plot}}};
}

json modeJson(const ServoMode& mode, double depth) {
    const auto list = [](const Vector6& v) { return std::vector<double>(v.data(), v.data() + 6); };
    return {{"direction", list(mode.direction)},
            {"in_words", inWords(mode, depth)},
            {"rate_per_s", mode.rate},
            {"decay_predicted_per_s", mode.predictedDecay},
            {"decay_simulated_per_s", finiteOrNull(mode.simulatedDecay)}};
}

json cellJson(const BasinCell& cell) {
    return {{"distance_m", cell.distance},
            {"angle_deg", cell.angle},
            {"trials", cell.trials},
            {"converged", cell.converged},
            {"share_95_percent", {cell.low, cell.high}},
            {"median_s", cell.converged > 0 ? json(cell.seconds) : json(nullptr)}};
}

ReportTable basinTable(const ServoStudy& study) {
    ReportTable table{"Converged", {}};
    for (const BasinCell& cell : study.basin) {
        std::string text = fmt::format("{} of {} ({:.0f} to {:.0f} %)", cell.converged, cell.trials,
                                       kPercent * cell.low, kPercent * cell.high);
        if (cell.converged > 0) text += fmt::format(", {:.1f} s", cell.seconds);
        table.rows.emplace_back(fmt::format("from {:g} m, {:g} degrees", cell.distance, cell.angle),
                                text);
    }
    return table;
}

ReportTable modesTable(const ServoStudy& study) {
    ReportTable table{"Directions, the slowest first", {}};
    for (const ServoMode& mode : study.modes) {
        table.rows.emplace_back(inWords(mode, study.depth),
                                mode.rate > 0.
                                    ? fmt::format("{:.3g} per second predicted, {:.3g} simulated",
                                                  mode.predictedDecay, mode.simulatedDecay)
                                    : "never: the view says nothing");
    }
    return table;
}

}  // namespace

json servoResult(const ServoReport& report) {
    const ServoStudy& study = report.study;
    const Eigen::Vector3d p = report.goal.T_w_b.translation();
    json modes = json::array(), cells = json::array();
    for (const ServoMode& mode : study.modes) modes.push_back(modeJson(mode, study.depth));
    for (const BasinCell& cell : study.basin) cells.push_back(cellJson(cell));
    return {{"schema", 1},
            {"command", "servo"},
            {"version", PHOTONAV_VERSION},
            {"interrupted", study.interrupted},
            {"goal", {{"position", {p.x(), p.y(), p.z()}}, {"depth_m", study.depth}}},
            {"servo",
             {{"degrees_of_freedom", report.options.hasTilt ? 6 : 4},
              {"gain", report.options.gain},
              {"damping", report.options.damping},
              {"image_rate", report.options.rate},
              {"image_width", report.goal.camera.width}}},
            {"seed", report.options.seed},
            {"directions_are", "body twists x, y, z, roll, pitch, yaw [m, rad]"},
            {"condition", finiteOrNull(study.condition)},
            {"modes", modes},
            {"basin", cells}};
}

ReportTable servoSummary(const ServoReport& report) {
    const ServoStudy& study = report.study;
    ReportTable table{"At the goal", {}};
    if (study.modes.empty()) return table;
    const ServoMode& slowest = study.modes.front();
    table.rows = {
        {"slowest direction", inWords(slowest, study.depth)},
        {"its time constant",
         slowest.rate > 0. ? fmt::format("{:.3g} s", 1. / slowest.rate) : "it never converges"},
        {"condition of the Hessian",
         std::isfinite(study.condition) ? fmt::format("{:.3g}", study.condition) : "singular"},
        {"median depth of the view", fmt::format("{:.3g} m", study.depth)}};
    return table;
}

void writeServoReport(const fs::path& folder, const ServoReport& report,
                      const std::string& commandLine, const json& result) {
    ReportData page = problemReport(report.config, report.world, commandLine, result);
    page.title = fs::path(report.config.file).stem().string();
    page.subtitle = isOpen(report.study)
                        ? "Photometric servoing: the goal's view leaves a direction open."
                        : "Photometric servoing at the goal: where it converges, and how fast.";
    page.start = page.goal = report.goal.T_w_b.translation();
    page.tables = {servoSummary(report), modesTable(report.study), basinTable(report.study)};
    View view;
    report.goal.views.render(report.config.camera.camera(),
                             (report.goal.T_w_b * report.goal.T_b_c).inverse(), view);
    writeResultFolder(
        folder, page,
        {{"basin.png", {"The share of starts that converge.", basinFigure(report).png()}},
         {"modes.png", {"The decrease of small offsets.", modesFigure(report).png()}},
         {"goal.png", {"The goal's image.", greyPng(view.intensity)}}});
}

}  // namespace photonav
