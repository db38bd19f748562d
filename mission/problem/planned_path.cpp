// SPDX-License-Identifier: BSD-3-Clause
#include "problem/planned_path.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

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

constexpr double kMostSteps = 1e5;
constexpr double kSamePlace = 1e-3;  // [m]

Place placeFrom(const json& point) {
    const auto& p = point.at("position");
    Place place{{p.at(0).get<double>(), p.at(1).get<double>(), p.at(2).get<double>()},
                point.at("yaw").get<double>()};
    if (!place.position.allFinite() || !std::isfinite(*place.yaw)) {
        throw std::runtime_error("not finite");
    }
    return place;
}

std::string textAt(const json& result, const char* key, const std::string& otherwise) {
    const auto value = result.find(key);
    return value != result.end() && value->is_string() ? value->get<std::string>() : otherwise;
}

/// A plan leads from the start to the goal of its config, within its bounds. All of its steps are
/// kept, with their beliefs.
void checkPlaces(const std::vector<Place>& waypoints, const std::string& file,
                 const Config& config) {
    constexpr double kRounding = 1e-6;  // [m]
    const auto fail = [&](const std::string& reason) { throw InputError(file, "path", reason); };
    const Eigen::AlignedBox3d bounds(config.bounds.min().array() - kRounding,
                                     config.bounds.max().array() + kRounding);
    double steps = 0.;
    for (std::size_t i = 0; i < waypoints.size(); ++i) {
        const auto& p_w = waypoints[i].position;
        if (!bounds.contains(p_w)) {
            fail(fmt::format("({}, {}, {}) is out of the bounds of its config", p_w.x(), p_w.y(),
                             p_w.z()));
        }
        if (std::abs(*waypoints[i].yaw) > kLargestHeading) {
            fail(fmt::format("a heading of {} rad", *waypoints[i].yaw));
        }
        if (i == 0) continue;
        const double turn = std::abs(*waypoints[i].yaw - *waypoints[i - 1].yaw);
        const double way = (p_w - waypoints[i - 1].position).norm() + config.rotationWeight * turn;
        steps += std::max(1., way / config.belief.ds);
    }
    if (steps > kMostSteps) {
        fail(fmt::format("{:.3g} steps of planner.ds = {} m; at most {}", steps, config.belief.ds,
                         kMostSteps));
    }
    const auto requireEnd = [&](const char* what, const Place& end, const Place& ofConfig) {
        if ((end.position - ofConfig.position).norm() <= kSamePlace) return;
        fail(fmt::format("{} ({}), but the {} of the config is ({})",
                         &end == &waypoints.front() ? "begins at" : "ends at",
                         fmt::join(end.position, ", "), what, fmt::join(ofConfig.position, ", ")));
    };
    requireEnd("start", waypoints.front(), config.start);
    requireEnd("goal", waypoints.back(), config.goal);
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

PlannedPath readPlannedPath(const fs::path& resultFile, const Config& config) {
    std::ifstream stream = openToRead(resultFile.string());
    const std::string text{std::istreambuf_iterator<char>(stream), {}};
    if (nestingDepth(text) > kMostJsonDepth) {
        throw InputError(resultFile.string(), "", "nested too deep");
    }
    const json result = json::parse(text, nullptr, false);
    if (!result.is_object()) throw InputError(resultFile.string(), "", "not a JSON object");
    if (textAt(result, "command", "") != "plan") {
        throw InputError(resultFile.string(), "command", "not a result of photonav plan");
    }
    PlannedPath path{textAt(result, "planner", "plan"), {}};
    std::vector<Place>& waypoints = path.waypoints;
    try {
        for (const json& point : result.at("path")) {
            if (point.at("waypoint").get<bool>()) waypoints.push_back(placeFrom(point));
        }
    } catch (const std::exception&) {
        throw InputError(resultFile.string(), "path", "not as photonav plan writes it");
    }
    if (waypoints.size() < 2) {
        throw InputError(resultFile.string(), "path",
                         waypoints.empty() ? "no path was found" : "one waypoint is no path");
    }
    checkPlaces(waypoints, resultFile.string(), config);
    return path;
}

}  // namespace photonav
