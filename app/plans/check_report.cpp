// SPDX-License-Identifier: BSD-3-Clause
#include "plans/check_report.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "dataset/image_file.hpp"
#include "dataset/trajectory.hpp"
#include "figures/check_figures.hpp"
#include "figures/fly_figures.hpp"
#include "figures/images.hpp"
#include "figures/trace.hpp"
#include "geometry/constants.hpp"
#include "geometry/se3.hpp"
#include "report/problem_report.hpp"
#include "result/json_values.hpp"

namespace photonav {
namespace fs = std::filesystem;
using nlohmann::json;
namespace {

constexpr std::size_t kMostViews = 60;  // pictures in the report

/// "along x", "level, 30 degrees left of x", "vertical".
std::string directionText(const Eigen::Vector3d& d) {
    const double elevation = std::asin(std::clamp(d.z(), -1., 1.)) / kDegree;
    if (elevation > 80.) return "vertical";
    const double azimuth = std::remainder(std::atan2(d.y(), d.x()) / kDegree, 180.);
    const auto whole = [](double degrees) { return std::lround(degrees); };  // not -0
    return fmt::format("azimuth {}°, elevation {}°", whole(azimuth), whole(elevation));
}

std::string uncertaintyText(const CheckedPlace& place) {
    return fmt::format("{} along its weakest direction ({}), rotation {:.2g}°",
                       lengthText(place.positionSigma), directionText(place.weakest_w),
                       place.rotationSigma / kDegree);
}

std::string stretchesText(const std::vector<Stretch>& stretches) {
    if (stretches.empty()) return "none";
    std::vector<std::string> texts;
    texts.reserve(stretches.size());
    for (const Stretch& s : stretches)
        texts.push_back(fmt::format("{:.2f} to {:.2f} m", s.begin, s.end));
    constexpr std::size_t kMost = 4;
    const std::size_t more = texts.size() > kMost ? texts.size() - kMost : 0;
    texts.resize(texts.size() - more);
    return fmt::format("{}{}", fmt::join(texts, ", "),
                       more > 0 ? fmt::format(" and {} more", more) : "");
}

std::string flightsText(const FlightSet& set) {
    const FlightSummary s = summarise(set);
    std::size_t withLoss = 0;
    for (const FlightResult& flight : set.flights) withLoss += flight.timesLost > 0;
    return fmt::format(
        "{} of {} arrived, {} collided, {} lost track, position error {} rms (predicted {})",
        s.arrived, s.flights, s.collisions, withLoss, lengthText(s.positionRmse),
        lengthText(s.predictedSigma));
}

std::vector<ReportView> viewsAlong(const CheckOutcome& report) {
    std::vector<std::size_t> drawn;
    const std::size_t places = report.checked.places.size();
    for (std::size_t i = 0; i < places; i += 1 + places / kMostViews) drawn.push_back(i);
    return reportViews(report.config, report.world, report.path, drawn);
}

std::vector<NamedFigure> checkFigures(const CheckOutcome& report,
                                      const std::vector<DrawnPath>& paths) {
    const CheckedTrajectory& checked = report.checked;
    Config around = report.config;  // the trajectory may leave the bounds
    around.bounds.extend(boxAround(report.trajectory));
    TopView view = viewFromAbove(around, report.world, {paths.front()});
    const bool isLost = checked.isLost();
    view.title = isLost ? "The trajectory, and where the camera is lost" : "The trajectory";
    view.start = checked.places.front().T_w_b.translation();
    view.goal = checked.places.back().T_w_b.translation();
    view.goalName = "end";
    const auto add = [&](DrawnTree tree) {
        if (!tree.edges.empty()) view.trees.push_back(std::move(tree));
    };
    add(betterHeadings(checked, 0.03 * view.area.sizes().maxCoeff()));
    if (!report.flights.flights.empty()) add(drawnFlights(report.flights));
    add(lostStretches(checked));
    std::vector<NamedFigure> figures{
        {"top_view",
         fmt::format("From above: the trajectory with 3σ ellipses of the position{}, and headings "
                     "that would reduce the trace by more than a tenth.",
                     isLost ? ", where the camera is lost" : ""),
         topViewFigure(view)},
        {"sigma", "Standard deviations along the weakest direction, with every image.",
         sigmaFigure(checked)}};
    if (checked.places.front().best) {
        figures.push_back({"headings",
                           "Trace of the covariance after one view, for every heading at every "
                           "place of the trajectory.",
                           headingsFigure(checked)});
    }
    figures.push_back(
        {"trace",
         "Trace of the pose covariance along the trajectory, before and after every image.",
         traceFigure("Trace along the trajectory", paths, true)});
    return figures;
}

}  // namespace

ReportTable summaryOf(const CheckOutcome& report) {
    const CheckedTrajectory& checked = report.checked;
    const CheckedPlace& worst = checked.worst();
    ReportTable table{"Check of the trajectory", {}};
    const auto row = [&](const std::string& label, const std::string& value) {
        table.rows.emplace_back(label, value);
    };
    row("verdict", verdictOf(checked));
    row("length", fmt::format("{:.2f} m", checked.wholeLength));
    if (checked.length < checked.wholeLength) {
        row("checked", fmt::format("{:.2f} m", checked.length));
    }
    row("lost", fmt::format("{:.2f} m", checked.lostLength()));
    row("images that leave directions open",
        fmt::format("{:.2f} m", lengthByVerdict(checked, false)));
    row("images rejected", fmt::format("{:.2f} m", lengthByVerdict(checked, true)));
    row(fmt::format("least certain, after {:.2f} m", worst.length), uncertaintyText(worst));
    row("at the end", uncertaintyText(checked.places.back()));
    row(fmt::format("within {:g} m of the end", checked.arrivalTolerance),
        fmt::format("with a believed probability of {:.1f} %", 100. * checked.arrivalProbability));
    row("mean trace", fmt::format("{:.3g} m²", checked.meanTrace));
    if (report.turned) {
        // Each is the best for its own image, not for the whole trajectory.
        const bool isBetter = report.turned->meanTrace < checked.meanTrace;
        row("with the best headings", fmt::format("{:.3g} m²{}; {}", report.turned->meanTrace,
                                                  isBetter ? "" : ", no better than the given ones",
                                                  verdictOf(*report.turned)));
    }
    const bool isWithin = report.obstruction.outside.empty();
    row("in collision", stretchesText(report.obstruction.collisions) +
                            (isWithin ? "" : "; unknown where it is out of bounds"));
    if (report.world.map() != nullptr) {
        row("next to unknown cells", stretchesText(report.obstruction.unknown));
    }
    row("out of bounds", stretchesText(report.obstruction.outside));
    if (!report.flights.flights.empty()) row("flights", flightsText(report.flights));
    return table;
}

void writeCheckReport(const fs::path& folder, const CheckOutcome& report,
                      const std::string& commandLine, const json& result) {
    const Config& config = report.config;
    const Pose T_b_c = config.camera.T_b_c();
    json shown = result;
    shown.erase("path");
    ReportData page = problemReport(config, report.world, commandLine, shown);
    page.title = "Check of " + fs::path(report.file).filename().string();
    page.subtitle = "Whether the camera stays localised along a given trajectory.";
    page.start = report.checked.places.front().T_w_b.translation();
    page.goal = report.checked.places.back().T_w_b.translation();
    page.paths.push_back(drawnPath(report.path, T_b_c));
    page.paths.back().color = plannerColor("belief_rrt_star");
    if (report.turned) {
        page.paths.push_back(drawnPath(pathOf(*report.turned, "best headings"), T_b_c));
        page.paths.back().color = {22, 128, 57};
    }
    if (report.checked.isLost()) page.trees.push_back(lostStretches(report.checked));
    if (!report.flights.flights.empty()) page.trees.push_back(drawnFlights(report.flights));
    page.views = viewsAlong(report);
    page.tables.push_back(summaryOf(report));

    Trajectory trajectory;  // as the places were looked at, one metre per second without times
    for (const CheckedPlace& place : report.checked.places) {
        trajectory.push_back({place.time.value_or(place.length), place.T_w_b * T_b_c});
    }
    writeTrajectory((folder / "path.tum").string(), trajectory);
    writeKittiTrajectory((folder / "path.kitti").string(), trajectory);
    writeResultFolder(folder, page, checkFigures(report, page.paths));
}

}  // namespace photonav
