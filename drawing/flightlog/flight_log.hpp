// SPDX-License-Identifier: BSD-3-Clause
// An exploration as it can be watched again: at every update of the plan what changed in the map,
// tree, path, beliefs, images and grids. Made by FlightLogger; drawn by the report, its figures and
// the film.
#pragma once

#include <cstdint>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "exploration/explorations.hpp"
#include "shapes/paths.hpp"

namespace photonav {

/// What changed among the drawn cells of a map: cubes of `FlightLog::cell` metres. The cube (i, j,
/// k) begins at (i, j, k) times its size, in w.
struct CellChanges {
    static constexpr std::uint8_t kGone = 255;  ///< as grey level: no longer occupied

    std::vector<std::int16_t> indices;  ///< 3 per cell
    std::vector<std::uint8_t> greys;    ///< 1 per cell: 0 to 254
};

/// Where the robot was at an exposure.
struct FlownPoint {
    float time = 0.F, way = 0.F;  ///< [s], truly flown [m]
    Eigen::Vector3f believed = Eigen::Vector3f::Zero();
    Eigen::Vector3f truth = Eigen::Vector3f::Zero();  ///< camera centre in w [m]
    float trace = 0.F;                                ///< of the belief, weightedTrace() [m^2]
    float yaw = 0.F;                                  ///< believed heading of the body [rad]
};

/// Images and grids of a moment, as encoded files. A part that is empty was not logged then.
struct MomentPictures {
    std::vector<Edge> tree;   ///< of the planner
    std::string observed;     ///< JPEG of the camera's image
    std::string predicted;    ///< JPEG of the view of the map from the believed pose
    std::string obstacles;    ///< PNG, see ObstacleLevel; first row at the largest y
    std::string information;  ///< PNG, see informationLevel(); first row at the largest y

    bool empty() const { return tree.empty() && observed.empty() && obstacles.empty(); }
};

/// Grey levels of MomentPictures::obstacles, at the height of the robot.
enum class ObstacleLevel : std::uint8_t { unseen = 0, occupied = 85, tooNear = 170, free = 255 };

/// Grey level of the trace of a view's Fisher information: 20 per decade from 1 on; 255: the robot
/// cannot be there, or has not seen the place.
std::uint8_t informationLevel(double trace);
inline constexpr int kLevelsPerDecade = 20;
inline constexpr std::uint8_t kNoInformation = 255;

struct LoggedMoment {
    PlanUpdate update;
    double way = 0.;                ///< truly flown [m]
    PathPoint robot;                ///< the believed pose
    std::vector<FlownPoint> flown;  ///< since the last moment
    std::vector<PathPoint> plan;    ///< from here to the goal; empty: no way
    CellChanges cells;
    MomentPictures pictures;
};

struct FlightLog {
    static constexpr const char* kFileName = "flight.json";

    std::string planner;
    std::uint32_t seed = 0;
    Eigen::AlignedBox3d box;    ///< of the tree and of what may be flown [m]
    Eigen::AlignedBox3d scene;  ///< of what can be seen [m]
    Eigen::AlignedBox2d area;   ///< of the grids [m]
    double cell = 0.;           ///< edge of the drawn cells [m]
    std::vector<LoggedMoment> moments;
    std::vector<FlownPoint> rest;  ///< flown after the last moment
    std::string end;               ///< nameOf(FlightEnd); empty while it is flown
    std::string reason;
};

/// What does not change in a flight.
nlohmann::json headerJson(const FlightLog& log);
nlohmann::json momentJson(const FlightLog& log, const LoggedMoment& moment);
nlohmann::json endJson(const FlightLog& log);

/// {"header": ..., "moments": [...], "end": ...}: large arrays as base64 of little-endian numbers.
nlohmann::json flightLogJson(const FlightLog& log);

/// @throws std::exception for what is no log
FlightLog flightLogFrom(const nlohmann::json& json);

/// @throws InputError naming the file for what is no log
FlightLog readFlightLog(const std::filesystem::path& file);

}  // namespace photonav
