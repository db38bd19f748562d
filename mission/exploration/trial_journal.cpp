// SPDX-License-Identifier: BSD-3-Clause
#include "exploration/trial_journal.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <stdexcept>

#include "exploration/real_time_json.hpp"
#include "geometry/constants.hpp"
#include "geometry/uncertain_pose.hpp"
#include "map/octree_file.hpp"
#include "replanning/plan_update_json.hpp"
#include "result/json_values.hpp"

namespace photonav {
namespace fs = std::filesystem;
using nlohmann::json;
namespace {

constexpr double kFarthestPosition = 1e6;  // from the origin [m]

void require(bool holds, const char* what) {
    if (!holds) throw std::out_of_range(what);
}

int countOf(const json& line, const char* key) { return wholeNumber<int>(line.at(key)); }

json rowsOf(const Pose& pose) { return matrixJson(pose.matrix().topRows<3>()); }

Pose poseFrom(const json& values) {
    constexpr double kTolerance = 1e-6;
    Pose pose = Pose::Identity();
    pose.matrix().topRows<3>() = matrixFrom<3, 4>(values);
    require(pose.linear().isUnitary(kTolerance) && pose.linear().determinant() > 0., "rotation");
    require(pose.translation().norm() < kFarthestPosition, "position");
    return pose;
}

json lineOf(const FlightSample& sample) {
    return {{"time", sample.time},
            {"distance", sample.distance},
            {"T_c_w", rowsOf(sample.T_c_w)},
            {"believed_T_c_w", rowsOf(sample.belief.mean)},
            {"covariance", matrixJson(sample.belief.covariance)}};
}

FlightSample sampleFrom(const json& line) {
    const auto covariance = matrixFrom<6, 6>(line.at("covariance"));
    require(isCovariance(covariance), "covariance");
    return {nonNegative(line, "time"),
            nonNegative(line, "distance"),
            poseFrom(line.at("T_c_w")),
            {poseFrom(line.at("believed_T_c_w")), covariance}};
}

/// The end of a flight that was not stopped.
FlightEnd endFrom(const std::string& name) {
    for (int i = 0; i < static_cast<int>(FlightEnd::stopped); ++i) {
        if (nameOf(static_cast<FlightEnd>(i)) == name) return static_cast<FlightEnd>(i);
    }
    throw std::out_of_range("end");
}

/// @throws std::out_of_range for a flight that cannot be
void checkPossible(const ExplorationResult& flight) {
    const auto isBefore = [](const FlightSample& a, const FlightSample& b) {
        return a.time < b.time;
    };
    require(!flight.samples.empty(), "samples");
    require(std::is_sorted(flight.samples.begin(), flight.samples.end(), isBefore), "time");
    require(flight.rejectedImages <= flight.images, "rejected_images");
}

template <typename Element>
json linesOf(const std::vector<Element>& elements) {
    json lines = json::array();
    for (const Element& element : elements) lines.push_back(lineOf(element));
    return lines;
}

/// A flight but for what its journal's folder and the machine's speed decide.
json lineOf(const ExplorationResult& flight, json updates) {
    return {{"planner", flight.planner},
            {"seed", flight.seed},
            {"end", nameOf(flight.end)},
            {"reason", flight.reason},
            {"duration_s", flight.duration},
            {"way", flight.flown},
            {"lost_s", flight.lostTime},
            {"times_lost", flight.timesLost},
            {"goal_error", flight.goalError},
            {"arrival_probability", flight.arrivalProbability},
            {"decided_after", finiteOrNull(flight.decidedAfter)},
            {"least_clearance", finiteOrNull(flight.leastClearance)},
            {"images", flight.images},
            {"rejected_images", flight.rejectedImages},
            {"keyframes", flight.keyframes},
            {"blind_steps", flight.blindSteps},
            {"samples", linesOf(flight.samples)},
            {"updates", std::move(updates)}};
}

}  // namespace

Identity TrialKind::identity(const Config& config) {
    Identity identity =
        without({"planner.name", "planner.compare_with_rrt_star", "map.made_by", "sweep."},
                identityOf(config));
    identity["explore.planners"] = fmt::format("[{}]", fmt::join(plannersOf(config), ", "));
    return identity;
}

Identity TrialKind::runIdentity(const Identity& exploration) {
    return without({"seed", "explore.trials", "explore.planners"}, exploration);
}

json TrialKind::save(const ExplorationResult& flight, const fs::path& folder) {
    if (flight.map) saveTexturedOcTree(*flight.map, folder / kMapFile);
    json line = lineOf(flight, linesOf(flight.updates));
    line["wall_s"] = flight.wallSeconds;
    line["has_map"] = flight.map != nullptr;
    if (flight.realTime) line["real_time"] = realTimeJson(*flight.realTime);
    return line;
}

json TrialKind::reproducible(const ExplorationResult& flight) {
    json updates = json::array();
    for (const PlanUpdate& update : flight.updates) updates.push_back(untimedJson(update));
    return lineOf(flight, std::move(updates));
}

ExplorationResult TrialKind::load(const json& line, const fs::path& folder) {
    ExplorationResult flight;
    flight.planner = line.at("planner");
    flight.seed = wholeNumber<std::uint32_t>(line.at("seed"));
    flight.end = endFrom(line.at("end"));
    flight.reason = line.at("reason");
    flight.duration = nonNegative(line, "duration_s");
    flight.flown = nonNegative(line, "way");
    flight.lostTime = nonNegative(line, "lost_s");
    flight.timesLost = countOf(line, "times_lost");
    flight.goalError = nonNegative(line, "goal_error");
    flight.arrivalProbability = nonNegative(line, "arrival_probability");
    flight.decidedAfter = numberOrNone(line, "decided_after");
    flight.leastClearance = numberOrNone(line, "least_clearance");
    flight.images = countOf(line, "images");
    flight.rejectedImages = countOf(line, "rejected_images");
    flight.keyframes = countOf(line, "keyframes");
    flight.blindSteps = countOf(line, "blind_steps");
    flight.wallSeconds = nonNegative(line, "wall_s");
    for (const json& sample : line.at("samples")) flight.samples.push_back(sampleFrom(sample));
    checkPossible(flight);
    for (const json& update : line.at("updates")) flight.updates.push_back(planUpdateFrom(update));
    if (line.contains("real_time")) flight.realTime = realTimeFrom(line.at("real_time"));
    if (line.at("has_map").get<bool>() && fs::exists(folder / kMapFile)) {
        flight.map = loadTexturedOcTree(folder / kMapFile);
    }
    return flight;
}

void keepMapOf(const TrialItem& first, std::vector<ExplorationResult>& flights) {
    std::erase_if(flights, [&](ExplorationResult& flight) {
        if (itemOf(flight) == first) return !flight.map;
        flight.map.reset();
        return false;
    });
}

}  // namespace photonav
