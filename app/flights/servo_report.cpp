// SPDX-License-Identifier: BSD-3-Clause
#include "flights/servo_report.hpp"

#include <fmt/format.h>

#include <cmath>

#include "alignment/image_pyramid.hpp"
#include "figures/images.hpp"
#include "figures/servo_figures.hpp"
#include "geometry/constants.hpp"
#include "recording/halved_view.hpp"
#include "report/problem_report.hpp"
#include "result/json_values.hpp"

namespace photonav {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

constexpr double kPercent = 100.;

ReportTable basinTable(const ServoStudy& study) {
    ReportTable table{"Converged", {}};
    if (study.converged() == 0) {
        table.rows = {{"none", fmt::format("of {} starts", study.trials())}};
        return table;
    }
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
                                    : "never: the view has no information about this direction");
    }
    return table;
}

}  // namespace

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
        {"standard deviation from one image",
         std::isfinite(study.positionSigma)
             ? fmt::format("position {}, rotation {:.2g}°", lengthText(study.positionSigma),
                           study.rotationSigma / kDegree)
             : "a direction is open"},
        {"median depth of the view", fmt::format("{:.3g} m", study.depth)}};
    return table;
}

void writeServoReport(const fs::path& folder, const ServoReport& report,
                      const std::string& commandLine, const json& result) {
    ReportData page = problemReport(report.config, report.world, commandLine, result);
    page.title = fs::path(report.config.file).stem().string();
    page.subtitle = report.study.openDirections() > 0
                        ? "Photometric servoing: the goal's view leaves a direction open."
                        : "Photometric servoing at the goal: where it converges, and how fast.";
    page.start = page.goal = report.goal.T_w_b.translation();
    page.tables = {servoSummary(report), modesTable(report.study), basinTable(report.study)};
    Camera camera = report.config.camera.camera();
    for (int i = halvingsToShow(camera.width); i > 0; --i) camera = halved(camera);
    View view;
    report.goal.views.render(camera, (report.goal.T_w_b * report.goal.T_b_c).inverse(), view);
    std::vector<NamedFigure> figures{
        {"basin", "The share of starts that converge.",
         servoBasinFigure(report.options, report.study)},
        {"goal", "The goal's image.", greyFigure("The goal's image", view.intensity)}};
    if (report.study.openDirections() < report.study.modes.size()) {
        figures.push_back(
            {"modes", "The decrease of small offsets.", servoModesFigure(report.study)});
    }
    writeResultFolder(folder, page, figures);
}

}  // namespace photonav
