// SPDX-License-Identifier: BSD-3-Clause
#include "problem/planned_path.hpp"

#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>

#include "io/error.hpp"
#include "io/json_nesting.hpp"
#include "io/reading.hpp"

namespace photonav {
namespace fs = std::filesystem;
using nlohmann::json;
namespace {

Place placeFrom(const json& point) {
    const auto& p = point.at("position");
    Place place{{p.at(0).get<double>(), p.at(1).get<double>(), p.at(2).get<double>()},
                point.at("yaw").get<double>()};
    if (!place.position.allFinite() || !std::isfinite(*place.yaw)) {
        throw std::runtime_error("not finite");
    }
    return place;
}

}  // namespace

PlanSource findPlan(const std::string& argument) {
    fs::path folder = argument;
    const fs::path name = folder.filename();
    if (!fs::is_directory(folder)) {
        if (name != "result.json" && name != "path.tum") return {argument, {}};
        folder = folder.parent_path();
    }
    const fs::path config = folder / "config.yaml";
    const fs::path result = folder / "result.json";
    for (const fs::path& file : {config, result}) {
        if (!fs::exists(file)) {
            throw InputError(argument, "",
                             "not a result of photonav plan: no " + file.filename().string());
        }
    }
    return {config.string(), result};
}

EvaluatedPath readPlannedPath(const fs::path& resultFile, PlanningProblem& problem,
                              const std::atomic<bool>& interrupted) {
    std::ifstream stream = openToRead(resultFile.string());
    const std::string text{std::istreambuf_iterator<char>(stream), {}};
    if (nestingDepth(text) > kMostJsonDepth) {
        throw InputError(resultFile.string(), "", "nested too deep");
    }
    const json result = json::parse(text, nullptr, false);
    if (!result.is_object()) throw InputError(resultFile.string(), "", "not a JSON object");
    if (result.value("command", "") != "plan") {
        throw InputError(resultFile.string(), "command", "not a result of photonav plan");
    }
    std::vector<Place> waypoints;
    try {
        for (const json& point : result.at("path")) {
            if (point.at("waypoint").get<bool>()) waypoints.push_back(placeFrom(point));
        }
    } catch (const std::exception&) {
        throw InputError(resultFile.string(), "path", "not as photonav plan writes it");
    }
    if (waypoints.size() < 2) throw InputError(resultFile.string(), "path", "no path was found");
    return problem.evaluate(result.value("planner", "plan"), waypoints, interrupted);
}

}  // namespace photonav
