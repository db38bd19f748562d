// SPDX-License-Identifier: BSD-3-Clause
#include "check/check_result.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "flight/fly_result.hpp"
#include "geometry/constants.hpp"
#include "geometry/se3.hpp"
#include "result/json_values.hpp"

namespace photonav {
using nlohmann::json;
namespace {

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

std::string nameOf(TrajectoryFormat format) {
    switch (format) {
        case TrajectoryFormat::tum:
            return "tum";
        case TrajectoryFormat::kitti:
            return "kitti";
        case TrajectoryFormat::csv:
            return "csv";
        case TrajectoryFormat::table:
            return "table";
    }
    return {};
}

json jsonOf(const BestHeading& best) {
    return {{"yaw", best.yaw}, {"trace", best.trace}, {"own_trace", best.ownTrace}};
}

json jsonOf(const CheckedPlace& place) {
    return {{"time_s", orNull(place.time)},
            {"position", vectorJson(place.T_w_b.translation())},
            {"yaw", yawOf(place.T_w_b)},
            {"distance", place.length},
            {"metric_length", place.distance},
            {"trace", place.trace},
            {"trace_before_view", place.traceBefore},
            {"covariance", triangleJson(place.covariance)},
            {"position_sigma_m", place.positionSigma},
            {"rotation_sigma_rad", place.rotationSigma},
            {"weakest_direction", vectorJson(place.weakest_w)},
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

json flightsJson(const FlightSet& set) {
    if (set.flights.empty()) return nullptr;
    json result = flightSummaryJson(summarise(set));
    result["lost_track"] = std::ranges::count_if(
        set.flights, [](const FlightResult& flight) { return flight.timesLost > 0; });
    return result;
}

json turnedJson(const std::optional<CheckedTrajectory>& turned) {
    if (!turned) return nullptr;
    return {{"mean_trace", turned->meanTrace},
            {"goal_trace", turned->places.back().trace},
            {"metric_length", turned->places.back().distance},
            {"lost_m", turned->lostLength()},
            {"lost", lostJson(*turned)}};
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
    if (lost != nullptr) {
        return fmt::format("the camera is lost after {:.2f} m of {:.2f} m: {}", lost->length,
                           checked.wholeLength, nameOf(lost->loss));
    }
    if (checked.length < checked.wholeLength) {
        return fmt::format("interrupted: the camera stays localised for the first {:.2f} m",
                           checked.length);
    }
    return "the camera stays localised all along the trajectory";
}

/// Way that ends at places whose image is of a kind [m].
double lengthByVerdict(const CheckedTrajectory& checked, bool isRejected) {
    double sum = 0.;
    for (std::size_t i = 1; i < checked.places.size(); ++i) {
        const Verdict verdict = checked.places[i].verdict;
        const bool counts = isRejected ? isLost(verdict) : verdict == Verdict::degenerate;
        if (counts) sum += checked.places[i].length - checked.places[i - 1].length;
    }
    return sum;
}

json localisationJson(const CheckedTrajectory& checked) {
    json result{
        {"verdict", verdictOf(checked)},
        {"is_lost", checked.isLost()},
        {"length", checked.wholeLength},
        {"checked_length", checked.length},
        {"metric_length", checked.places.back().distance},
        {"mean_trace", checked.meanTrace},
        {"goal_trace", checked.places.back().trace},
        {"lost", lostJson(checked)},
        {"lost_m", checked.lostLength()},
        {"open_directions_m", lengthByVerdict(checked, false)},
        {"rejected_images_m", lengthByVerdict(checked, true)},
        {"worst", jsonOf(checked.worst())},
        {"arrival",
         {{"tolerance_m", checked.arrivalTolerance}, {"probability", checked.arrivalProbability}}},
        {"covariance_frame", kCovarianceFrame},
        {"path", json::array()}};
    for (const CheckedPlace& place : checked.places) result["path"].push_back(jsonOf(place));
    return result;
}

json checkResult(const CheckOutcome& report) {
    const GivenTrajectory& given = report.trajectory;
    json result =
        resultJson("check", {{"status", report.interrupted ? "interrupted" : "done"},
                             {"seed", report.config.seed},
                             {"trajectory",
                              {{"file", report.file},
                               {"format", nameOf(given.format)},
                               {"poses", given.poses.size()},
                               {"has_heading", given.hasHeading},
                               {"tilt_deg", report.tilt / kDegree}}},
                             {"characteristic_length", report.config.belief.characteristicLength},
                             {"collisions", jsonOf(report.obstruction.collisions)},
                             {"unknown_cells", jsonOf(report.obstruction.unknown)},
                             {"out_of_bounds", jsonOf(report.obstruction.outside)},
                             {"least_clearance_m", finiteOrNull(report.obstruction.leastClearance)},
                             {"with_best_headings", turnedJson(report.turned)},
                             {"flights", flightsJson(report.flights)}});
    result.update(localisationJson(report.checked));
    return result;
}

}  // namespace photonav
