// SPDX-License-Identifier: BSD-3-Clause
#include "report/check_report.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "dataset/image_file.hpp"
#include "dataset/trajectory.hpp"
#include "figures/images.hpp"
#include "figures/trace.hpp"
#include "geometry/constants.hpp"
#include "geometry/se3.hpp"
#include "report/check_figures.hpp"
#include "report/fly_figures.hpp"
#include "report/fly_report.hpp"
#include "report/problem_report.hpp"
#include "result/json_values.hpp"

namespace photonav {
namespace fs = std::filesystem;
using nlohmann::json;
namespace {

constexpr std::size_t kMostViews = 60;  // pictures in the report

json jsonOf(const Eigen::Vector3d& p) { return {p.x(), p.y(), p.z()}; }

std::string imageVerdict(const CheckedPlace& place) {
    switch (place.verdict) {
        case Verdict::converged:
            return "determined";
        case Verdict::degenerate:
            return "degenerate";
        default:
            return "rejected";
    }
}

json jsonOf(const BestHeading& best) {
    return {{"yaw", best.yaw}, {"trace", best.trace}, {"own_trace", best.ownTrace}};
}

json jsonOf(const CheckedPlace& place) {
    std::vector<double> covariance;
    for (int i = 0; i < 6; ++i) {
        for (int j = i; j < 6; ++j) covariance.push_back(place.covariance(i, j));
    }
    return {{"time_s", orNull(place.time)},
            {"position", jsonOf(place.T_w_b.translation())},
            {"yaw", yawOf(place.T_w_b)},
            {"distance", place.length},
            {"metric_length", place.distance},
            {"trace", place.trace},
            {"trace_before_view", place.traceBefore},
            {"covariance", covariance},
            {"position_sigma_m", place.positionSigma},
            {"rotation_sigma_rad", place.rotationSigma},
            {"weakest_direction", jsonOf(place.weakest_w)},
            {"image", imageVerdict(place)},
            {"open_directions", place.openDirections},
            {"overlap", place.overlap},
            {"lost", place.loss == LossCause::none ? json(nullptr) : json(nameOf(place.loss))},
            {"best_heading", place.best ? jsonOf(*place.best) : json(nullptr)}};
}

json jsonOf(const std::vector<Stretch>& stretches) {
    json list = json::array();
    for (const Stretch& stretch : stretches) list.push_back({stretch.begin, stretch.end});
    return list;
}

/// Stretches that end at lost places, with their cause.
json lostJson(const CheckedTrajectory& checked) {
    json list = json::array();
    LossCause before = LossCause::none;
    for (std::size_t i = 0; i < checked.places.size(); ++i) {
        const CheckedPlace& place = checked.places[i];
        if (place.loss != LossCause::none) {
            if (place.loss != before) {
                const double begin = i > 0 ? checked.places[i - 1].length : 0.;
                list.push_back({{"begin", begin}, {"cause", nameOf(place.loss)}});
            }
            list.back()["end"] = place.length;
        }
        before = place.loss;
    }
    return list;
}

/// Way that ends at places whose image is of a kind [m].
double lengthOf(const CheckedTrajectory& checked, bool isRejected) {
    double sum = 0.;
    for (std::size_t i = 1; i < checked.places.size(); ++i) {
        const Verdict verdict = checked.places[i].verdict;
        const bool counts = isRejected ? isLost(verdict) : verdict == Verdict::degenerate;
        if (counts) sum += checked.places[i].length - checked.places[i - 1].length;
    }
    return sum;
}

/// "along x", "level, 30 degrees left of x", "vertical".
std::string directionText(const Eigen::Vector3d& d) {
    const double elevation = std::asin(std::clamp(d.z(), -1., 1.)) / kDegree;
    if (elevation > 80.) return "vertical";
    const double azimuth = std::remainder(std::atan2(d.y(), d.x()) / kDegree, 180.);
    return fmt::format("azimuth {:.0f}°, elevation {:.0f}°", azimuth, elevation);
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
        "{} of {} arrived, {} lost track on the way, position error {} rms (predicted {})",
        s.arrived, s.flights, withLoss, lengthText(s.positionRmse), lengthText(s.predictedSigma));
}

json flightsJson(const FlightSet& set) {
    if (set.flights.empty()) return nullptr;
    const FlightSummary s = summarise(set);
    std::size_t withLoss = 0;
    for (const FlightResult& flight : set.flights) withLoss += flight.timesLost > 0;
    return {{"flights", s.flights},
            {"arrived", s.arrived},
            {"astray", s.astray},
            {"uncertain_arrivals", s.uncertain},
            {"collisions", s.collisions},
            {"given_up", s.lost},
            {"out_of_time", s.outOfTime},
            {"lost_track", withLoss},
            {"lost_s", s.lostTime},
            {"position_rmse_m", finiteOrNull(s.positionRmse)},
            {"predicted_sigma_m", finiteOrNull(s.predictedSigma)},
            {"nees_per_dof", finiteOrNull(s.nees)}};
}

json turnedJson(const std::optional<CheckedTrajectory>& turned) {
    if (!turned) return nullptr;
    return {{"mean_trace", turned->meanTrace},
            {"goal_trace", turned->places.back().trace},
            {"metric_length", turned->places.back().distance},
            {"lost_m", turned->lostLength()},
            {"lost", lostJson(*turned)}};
}

std::vector<ReportView> viewsAlong(const CheckReport& report) {
    std::vector<ReportView> views;
    const auto& places = report.checked.places;
    const std::size_t stride = 1 + places.size() / kMostViews;
    const Camera camera = report.config.camera.camera();
    View view;
    for (std::size_t i = 0; i < places.size(); i += stride) {
        const Pose T_c_w = (places[i].T_w_b * report.config.camera.T_b_c()).inverse();
        report.world.views().render(camera, T_c_w, view);
        views.push_back(
            {i, greyPng(view.intensity),
             pngOf(contributionPicture(
                 view.intensity, contributionImage(view, camera, report.config.photometric)))});
    }
    return views;
}

std::vector<NamedFigure> checkFigures(const CheckReport& report,
                                      const std::vector<DrawnPath>& paths) {
    const CheckedTrajectory& checked = report.checked;
    Config around = report.config;  // the trajectory may leave the bounds
    around.bounds.extend(boxAround(report.trajectory));
    TopView view = viewFromAbove(around, report.world, {paths.front()});
    view.title = "The trajectory, and where the camera is lost";
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
        {"top_view.png",
         {"From above: the trajectory with 3σ ellipses of the position, where the camera is lost, "
          "and headings that would gain at least a tenth of the trace.",
          topViewFigure(view).png()}},
        {"sigma.png",
         {"Standard deviations along the weakest direction, with every image.",
          sigmaFigure(checked).png()}}};
    if (checked.places.front().best) {
        figures.push_back({"headings.png",
                           {"Trace of the covariance after one view, for every heading at every "
                            "place of the trajectory.",
                            headingsFigure(checked).png()}});
    }
    figures.push_back({"trace.png",
                       {"Trace of the pose covariance along the trajectory.",
                        traceFigure("Trace along the trajectory", paths, true).png()}});
    return figures;
}

}  // namespace

EvaluatedPath pathOf(const CheckedTrajectory& checked, const std::string& name) {
    EvaluatedPath path;
    path.planner = name;
    for (const CheckedPlace& place : checked.places) {
        path.points.push_back({.T_w_b = place.T_w_b,
                               .length = place.length,
                               .distance = place.distance,
                               .covariance = place.covariance,
                               .traceBefore = place.traceBefore,
                               .trace = place.trace});
    }
    path.length = checked.length;
    path.meanTrace = checked.meanTrace;
    path.goalTrace = checked.places.back().trace;
    return path;
}

std::string verdictOf(const CheckedTrajectory& checked) {
    const CheckedPlace* lost = checked.firstLost();
    if (lost == nullptr) return "the camera stays localised all along the trajectory";
    return fmt::format("the camera is lost after {:.2f} m of {:.2f} m: {}", lost->length,
                       checked.length, nameOf(lost->loss));
}

ReportTable summaryOf(const CheckReport& report) {
    const CheckedTrajectory& checked = report.checked;
    const CheckedPlace& worst = checked.worst();
    ReportTable table{"Check of the trajectory", {}};
    const auto row = [&](const std::string& label, const std::string& value) {
        table.rows.emplace_back(label, value);
    };
    row("verdict", verdictOf(checked));
    row("length", fmt::format("{:.2f} m", checked.length));
    row("lost", fmt::format("{:.2f} m", checked.lostLength()));
    row("images that leave directions open", fmt::format("{:.2f} m", lengthOf(checked, false)));
    row("images rejected", fmt::format("{:.2f} m", lengthOf(checked, true)));
    row(fmt::format("least certain, after {:.2f} m", worst.length), uncertaintyText(worst));
    row("at the end", uncertaintyText(checked.places.back()));
    row(fmt::format("within {:g} m of the end", checked.arrivalTolerance),
        fmt::format("with a believed probability of {:.1f} %", 100. * checked.arrivalProbability));
    row("mean trace", fmt::format("{:.3g} m²", checked.meanTrace));
    if (report.turned) {
        row("with the best headings",
            fmt::format("{:.3g}; {}", report.turned->meanTrace, verdictOf(*report.turned)));
    }
    row("in collision", stretchesText(report.obstruction.collisions));
    row("out of bounds", stretchesText(report.obstruction.outside));
    if (!report.flights.flights.empty()) row("flights", flightsText(report.flights));
    return table;
}

json checkResult(const CheckReport& report) {
    const CheckedTrajectory& checked = report.checked;
    const GivenTrajectory& given = report.trajectory;
    json result{
        {"schema", 1},
        {"command", "check"},
        {"version", PHOTONAV_VERSION},
        {"status", report.interrupted ? "interrupted" : "done"},
        {"verdict", verdictOf(checked)},
        {"is_lost", checked.isLost()},
        {"seed", report.config.seed},
        {"trajectory",
         {{"file", report.file},
          {"format", given.format == TrajectoryFormat::cameraPoses ? "tum" : "table"},
          {"poses", given.poses.size()},
          {"has_heading", given.hasHeading},
          {"tilt_deg", report.tilt / kDegree}}},
        {"length", checked.length},
        {"metric_length", checked.places.back().distance},
        {"mean_trace", checked.meanTrace},
        {"goal_trace", checked.places.back().trace},
        {"characteristic_length", report.config.belief.characteristicLength},
        {"lost", lostJson(checked)},
        {"lost_m", checked.lostLength()},
        {"open_directions_m", lengthOf(checked, false)},
        {"rejected_images_m", lengthOf(checked, true)},
        {"worst", jsonOf(checked.worst())},
        {"arrival",
         {{"tolerance_m", checked.arrivalTolerance}, {"probability", checked.arrivalProbability}}},
        {"collisions", jsonOf(report.obstruction.collisions)},
        {"out_of_bounds", jsonOf(report.obstruction.outside)},
        {"least_clearance_m", finiteOrNull(report.obstruction.leastClearance)},
        {"with_best_headings", turnedJson(report.turned)},
        {"flights", flightsJson(report.flights)},
        {"covariance_frame",
         "camera, left perturbation T_c_w = exp(xi) mean, order (rho, phi), upper triangle by "
         "rows"},
        {"path", json::array()}};
    for (const CheckedPlace& place : checked.places) result["path"].push_back(jsonOf(place));
    return result;
}

void writeCheckReport(const fs::path& folder, const CheckReport& report,
                      const std::string& commandLine, const json& result) {
    const Config& config = report.config;
    const Pose T_b_c = config.camera.T_b_c();
    json shown = result;
    shown.erase("path");
    ReportData page = problemReport(config, report.world, commandLine, shown);
    page.title = fs::path(report.file).stem().string();
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
    page.fieldOfView = fieldOfView(config.camera.camera());
    if (report.world.hasTexture()) page.views = viewsAlong(report);
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
