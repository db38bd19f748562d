// SPDX-License-Identifier: BSD-3-Clause
#include "report/fly_report.hpp"

#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <cmath>

#include "dataset/belief_trajectory.hpp"
#include "report/fly_figures.hpp"
#include "report/problem_report.hpp"
#include "result/json_values.hpp"

namespace photonav {
namespace fs = std::filesystem;
using nlohmann::json;
namespace {

/// Null for a flight that did not end at its believed goal.
json ellipseJson(const std::optional<PositionBelief>& position) {
    if (!position) return nullptr;
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(position->covariance);
    const auto row = [](const Eigen::Vector3d& v) { return json::array({v.x(), v.y(), v.z()}); };
    const Eigen::Matrix3d& axes = solver.eigenvectors();
    return {{"position", row(position->mean_w)},
            {"sigmas_m", row(solver.eigenvalues().cwiseMax(0.).cwiseSqrt())},
            {"axes", json::array({row(axes.col(0)), row(axes.col(1)), row(axes.col(2))})}};
}

json jsonOf(const FlightResult& flight) {
    return {{"flight", flight.number},
            {"end", nameOf(flight.end)},
            {"duration_s", flight.duration},
            {"mean_speed_mps", orNull(flight.meanSpeed)},
            {"way_m", flight.flown},
            {"goal_error_m", flight.goalError},
            {"believed_goal", ellipseJson(flight.believedGoal)},
            {"arrival_probability",
             flight.believedGoal ? json(flight.arrivalProbability) : json(nullptr)},
            {"least_clearance_m", finiteOrNull(flight.leastClearance)},
            {"images", flight.images},
            {"rejected_images", flight.rejectedImages},
            {"times_lost", flight.timesLost},
            {"lost_s", flight.lostTime},
            {"photometric_goal", flight.photometric},
            {"nees_per_dof", finiteOrNull(neesPerDof(flight))}};
}

json jsonOf(const FlightSet& set) {
    const FlightSummary s = summarise(set);
    json result{{"planner", set.path.planner},
                {"length_m", set.path.length},
                {"flights", s.flights},
                {"arrived", s.arrived},
                {"astray", s.astray},
                {"uncertain_arrivals", s.uncertain},
                {"collisions", s.collisions},
                {"given_up", s.lost},
                {"out_of_time", s.outOfTime},
                {"position_rmse_m", finiteOrNull(s.positionRmse)},
                {"predicted_sigma_m", finiteOrNull(s.predictedSigma)},
                {"within_predicted_3_sigma", finiteOrNull(s.within3Sigma)},
                {"believed_sigma_m", finiteOrNull(s.believedSigma)},
                {"nees_per_dof", finiteOrNull(s.nees)},
                {"nees_median_flight_per_dof", finiteOrNull(s.neesMedian)},
                {"nees_at_goal_per_dof", finiteOrNull(s.neesAtGoal)},
                {"nees_at_goal_bounds", {finiteOrNull(s.neesLow), finiteOrNull(s.neesHigh)}},
                {"lost_s", s.lostTime},
                {"duration_s", finiteOrNull(s.duration)},
                {"mean_speed_mps", finiteOrNull(s.meanSpeed)},
                {"goal_error_m", finiteOrNull(s.goalError)},
                {"photometric_goal",
                 {{"flights", s.photometric},
                  {"error_before_m", finiteOrNull(s.photometricBefore)},
                  {"error_after_m", finiteOrNull(s.photometricAfter)}}},
                {"each", json::array()}};
    for (const FlightResult& flight : set.flights) result["each"].push_back(jsonOf(flight));
    return result;
}

ReportTable tableOf(const FlightSet& set) {
    const FlightSummary s = summarise(set);
    ReportTable table{"Flights of " + set.path.planner, {}};
    if (s.flights == 0) {
        table.rows = {{"flights", "none"}};
        return table;
    }
    table.rows = {
        {"arrived", fmt::format("{} of {}", s.arrived, s.flights)},
        {"wrong arrivals (estimate at the goal, robot elsewhere)", fmt::format("{}", s.astray)},
        {"uncertain arrivals (estimate at the goal, not certain enough)",
         fmt::format("{}", s.uncertain)},
        {"collisions", fmt::format("{}", s.collisions)},
        {"gave up lost / out of time", fmt::format("{} / {}", s.lost, s.outOfTime)},
        {"position error, rms", lengthText(s.positionRmse)},
        {"standard deviation of the position predicted by the plan", lengthText(s.predictedSigma)},
        {"errors within 3 predicted standard deviations",
         fmt::format("{:.1f} %", 100. * s.within3Sigma)},
        {"standard deviation estimated in flight", lengthText(s.believedSigma)},
        {"NEES per degree of freedom (1: consistent), mean and median flight",
         fmt::format("{:.2f}, {:.2f}", s.nees, s.neesMedian)},
        {"NEES per degree of freedom at the goal (95 % interval if consistent)",
         fmt::format("{:.2f} ({:.2f} to {:.2f})", s.neesAtGoal, s.neesLow, s.neesHigh)},
        {"true distance to the goal at the end, median", lengthText(s.goalError)},
        {"time without tracking, all flights", fmt::format("{:.1f} s", s.lostTime)},
        {"duration, mean", fmt::format("{:.1f} s", s.duration)},
        {"speed on the way to the goal, mean", fmt::format("{:.2f} m/s", s.meanSpeed)}};
    if (s.photometric > 0) {
        table.rows.emplace_back(
            "servoing on the image of the goal",
            fmt::format("{} flights, {} to {}", s.photometric, lengthText(s.photometricBefore),
                        lengthText(s.photometricAfter)));
    }
    return table;
}

Png topView(const Config& config, const World& world, const std::vector<FlightSet>& sets,
            const std::vector<DrawnPath>& paths) {
    TopView view = viewFromAbove(config, world, paths);
    view.title = "Plans and true positions of the flights";
    for (std::size_t k = 0; k < sets.size(); ++k) {
        if (!sets[k].flights.empty()) view.trees.push_back(drawnFlights(sets[k]));
    }
    return topViewFigure(view).png();
}

std::vector<NamedFigure> figuresOf(const Config& config, const World& world,
                                   const std::vector<FlightSet>& sets,
                                   const std::vector<DrawnPath>& paths) {
    std::vector<NamedFigure> figures;
    if (!sets.empty()) {
        figures.push_back(
            {"errors.png",
             {"Error of the estimated position at each image, and the standard deviation "
              "that the plan predicted.",
              errorBandsFigure(sets).png()}});
    }
    figures.push_back({"top_view.png",
                       {"From above: plans with the predicted 3σ ellipses, and the true positions "
                        "of the flights.",
                        topView(config, world, sets, paths)}});
    if (!sets.empty()) {
        figures.push_back(
            {"nees.png",
             {"Mean NEES along the plan: 1 if the covariances are consistent with the errors.",
              neesFigure(sets).png()}});
    }
    return figures;
}

/// Null: images are taken as they are.
json priorJson(const std::optional<ExposurePrior>& prior) {
    if (!prior) return nullptr;
    return {{"gain_sigma", prior->gainSigma}, {"offset_sigma", prior->offsetSigma}};
}

std::string subtitleOf(const FlyConfig& fly) {
    std::string text = "Closed-loop flights along plans";
    if (fly.camera == "real") text += " with the image noise of a real camera";
    if (!fly.map.empty()) text += ", tracking in the map " + fs::path(fly.map).filename().string();
    return text + ": predicted and actual errors.";
}

/// Named after the config, or after the result folder of the plan.
std::string titleOf(const Config& config) {
    const fs::path plan = config.fly.plan;
    const fs::path name =
        plan.empty() ? fs::path(config.file).stem() : plan.parent_path().filename();
    return name.string() + ", flown";
}

}  // namespace

std::string lengthText(double metres) {
    return std::abs(metres) < 0.1 ? fmt::format("{:.3g} mm", 1e3 * metres)
                                  : fmt::format("{:.3f} m", metres);
}

json flyResult(const Config& config, const std::vector<FlightSet>& sets,
               const FlightOptions& options, bool interrupted) {
    json result{
        {"schema", 1},
        {"command", "fly"},
        {"version", PHOTONAV_VERSION},
        {"status", interrupted    ? "interrupted"
                   : sets.empty() ? "no path"
                                  : "done"},
        {"seed", config.seed},
        {"flight",
         {{"camera_period_s", options.robot.camera.period},
          {"camera_latency_s", options.robot.camera.latency},
          {"camera_drop_rate", options.robot.camera.dropRate},
          {"camera_black_rate", options.robot.camera.blackRate},
          {"blackout_s", {options.robot.camera.blackoutStart, options.robot.camera.blackoutLength}},
          {"max_speed_mps", options.pilot.route.limits.maxSpeed},
          {"odometry_factor", options.robot.body.odometryFactor},
          {"body_radius_m", options.bodyRadius},
          {"arrival_tolerance_m", options.arrivalTolerance},
          {"camera", config.fly.camera},
          {"exposure_prior", priorJson(options.tracker.map.exposure)},
          {"photometric_goal", options.pilot.photometricGoal},
          {"map", config.fly.map},
          {"scale", options.tracker.map.informationScale},
          {"least_sigma",
           {options.tracker.map.trust.leastSigma, options.tracker.map.trust.leastSigmaRotation}}}},
        {"planners", json::array()}};
    for (const FlightSet& set : sets) result["planners"].push_back(jsonOf(set));
    return result;
}

void writeFlyReport(const fs::path& folder, const Config& config, const World& world,
                    const std::vector<FlightSet>& sets, std::vector<ReportFrame> frames,
                    const std::string& commandLine, const json& result) {
    ReportData report = problemReport(config, world, commandLine, result);
    report.frames = std::move(frames);
    report.title = titleOf(config);
    report.subtitle = subtitleOf(config.fly);
    for (std::size_t k = 0; k < sets.size(); ++k) {
        report.paths.push_back(drawnPath(sets[k].path, config.camera.T_b_c()));
        report.trees.push_back(drawnFlights(sets[k]));
        report.tables.push_back(tableOf(sets[k]));
    }
    report.fieldOfView = fieldOfView(config.camera.camera());
    if (!sets.empty() && !sets[0].flights.empty() && sets[0].flights[0].number == 0) {
        writeFlownTrajectory(folder, sets[0].flights[0]);
    }
    writeResultFolder(folder, report, figuresOf(config, world, sets, report.paths));
}

void writeFlownTrajectory(const fs::path& folder, const FlightResult& flight) {
    std::vector<StampedBelief> beliefs;
    Trajectory truth;
    for (const FlightSample& sample : flight.samples) {
        beliefs.push_back({sample.time, sample.belief});
        truth.push_back({sample.time, sample.T_c_w.inverse()});
    }
    const auto file = [&](const char* name) { return (folder / name).string(); };
    writeTrajectory(file("trajectory.tum"), meansOf(beliefs));
    writeTrajectory(file("groundtruth.tum"), truth);
    writeCovariances(file("trajectory.cov"), beliefs);
    writeOpenVinsTrajectory(file("trajectory.ov"), beliefs);
}

}  // namespace photonav
