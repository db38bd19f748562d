// SPDX-License-Identifier: BSD-3-Clause
#include "flight/fly_result.hpp"

#include <Eigen/Eigenvalues>

#include "dataset/belief_trajectory.hpp"
#include "flight/flight_statistics.hpp"
#include "result/json_values.hpp"

namespace photonav {
using nlohmann::json;
namespace {

/// Null for a flight that did not end at its believed goal.
json ellipseJson(const std::optional<PositionBelief>& position) {
    if (!position) return nullptr;
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(position->covariance);
    const Eigen::Matrix3d& axes = solver.eigenvectors();
    return {{"position", vectorJson(position->mean_w)},
            {"sigmas_m", vectorJson(solver.eigenvalues().cwiseMax(0.).cwiseSqrt())},
            {"axes", json::array({vectorJson(axes.col(0)), vectorJson(axes.col(1)),
                                  vectorJson(axes.col(2))})}};
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
    json result = flightSummaryJson(summarise(set));
    result["planner"] = set.path.planner;
    result["length_m"] = set.path.length;
    result["each"] = json::array();
    for (const FlightResult& flight : set.flights) result["each"].push_back(jsonOf(flight));
    return result;
}

/// Null: images are taken as they are.
json priorJson(const std::optional<ExposurePrior>& prior) {
    if (!prior) return nullptr;
    return {{"gain_sigma", prior->gainSigma}, {"offset_sigma", prior->offsetSigma}};
}

}  // namespace

json flightSummaryJson(const FlightSummary& s) {
    return {{"flights", s.flights},
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
              {"error_after_m", finiteOrNull(s.photometricAfter)}}}};
}

json flyResult(const Config& config, const std::vector<FlightSet>& sets,
               const FlightOptions& options, bool interrupted) {
    json result = resultJson(
        "fly",
        {{"status", interrupted    ? "interrupted"
                    : sets.empty() ? "no path"
                                   : "done"},
         {"seed", config.seed},
         {"flight",
          {{"camera_period_s", options.robot.camera.period},
           {"camera_latency_s", options.robot.camera.latency},
           {"camera_drop_rate", options.robot.camera.dropRate},
           {"camera_black_rate", options.robot.camera.blackRate},
           {"blackout_s",
            {options.robot.camera.blackoutStart, options.robot.camera.blackoutLength}},
           {"max_speed_mps", options.pilot.route.limits.maxSpeed},
           {"max_turn_rate_radps", options.pilot.route.limits.maxYawRate},
           {"velocity_lag_s", options.robot.body.lag},
           {"drift_mps", options.robot.body.drift},
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
         {"planners", json::array()}});
    for (const FlightSet& set : sets) result["planners"].push_back(jsonOf(set));
    return result;
}

void writeFlownTrajectory(const std::filesystem::path& folder, const FlightResult& flight) {
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
