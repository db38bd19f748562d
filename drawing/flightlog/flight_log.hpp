// SPDX-License-Identifier: BSD-3-Clause
// The log of an exploration flight: for every update of the plan the changes of the map, tree,
// path, beliefs, images and grids. FlightLogger makes it; the report, its figures and the film draw
// it.
#pragma once

#include <cstdint>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "exploration/explorations.hpp"
#include "shapes/paths.hpp"

namespace photonav {

/// Changes of the drawn cells of a map, which are cubes of edge FlightLog::cell [m]. The corner of
/// the cube (i, j, k) with the least coordinates is (i, j, k) times the edge, world frame.
struct CellChanges {
    static constexpr std::uint8_t kGone = 255;  ///< grey level of a cell that is no longer occupied

    std::vector<std::int16_t> indices;  ///< i, j, k of each changed cell
    std::vector<std::uint8_t> greys;    ///< 1 per changed cell: 0 to 254, or kGone
};

/// True and believed position at an exposure.
struct FlownPoint {
    float time = 0.F, length = 0.F;  ///< time [s], length of the true path so far [m]
    Eigen::Vector3f believed = Eigen::Vector3f::Zero();  ///< camera centre, world frame [m]
    Eigen::Vector3f truth = Eigen::Vector3f::Zero();     ///< camera centre, world frame [m]
    float trace = 0.F;                                   ///< weightedTrace() of the belief [m^2]
    float yaw = 0.F;                                     ///< believed heading of the body [rad]
};

/// Tree, images and grids of a moment; images and grids as the content of encoded files. An empty
/// part was not logged at this moment.
struct MomentPictures {
    std::vector<Edge> tree;   ///< the planner's search tree
    std::string observed;     ///< JPEG of the camera's image
    std::string predicted;    ///< JPEG of the view of the map from the believed pose
    std::string obstacles;    ///< PNG, see ObstacleLevel; first row at the largest y
    std::string information;  ///< PNG, see informationLevel(); first row at the largest y

    bool empty() const { return tree.empty() && observed.empty() && obstacles.empty(); }
};

/// Grey levels of MomentPictures::obstacles: space at the robot's height that is not observed, is
/// occupied, is nearer to an obstacle than the robot's radius, or is free.
enum class ObstacleLevel : std::uint8_t { unseen = 0, occupied = 85, tooNear = 170, free = 255 };

/// Grey level of MomentPictures::information for the trace of a view's Fisher information: 20
/// levels per decade, from a trace of 1 (level 0) on, at most 254.
std::uint8_t informationLevel(double trace);
inline constexpr int kLevelsPerDecade = 20;
/// Grey level for places where the robot cannot be, or that were not observed.
inline constexpr std::uint8_t kNoInformation = 255;

/// The state after an update of the plan.
struct LoggedMoment {
    PlanUpdate update;
    double length = 0.;             ///< length of the true path so far [m]
    PathPoint robot;                ///< the belief
    std::vector<FlownPoint> flown;  ///< exposures since the last moment, at least 0.1 s apart
    std::vector<PathPoint> plan;    ///< path from the robot to the goal; empty if there is none
    CellChanges cells;
    MomentPictures pictures;
};

struct FlightLog {
    static constexpr const char* kFileName = "flight.json";

    std::string planner;
    std::uint32_t seed = 0;
    Eigen::AlignedBox3d box;    ///< bounds of the flight, which contain the tree; world frame [m]
    Eigen::AlignedBox3d scene;  ///< bounding box of the true scene, world frame [m]
    Eigen::AlignedBox2d area;   ///< area of the grids, x and y in the world frame [m]
    double cell = 0.;           ///< edge of the drawn cells [m]
    std::vector<LoggedMoment> moments;
    std::vector<FlownPoint> rest;  ///< exposures after the last moment
    std::string end;               ///< nameOf(FlightEnd); empty during the flight
    std::string reason;            ///< why the flight ended without arrival
};

/// The members of a log that do not change during a flight.
nlohmann::json headerJson(const FlightLog& log);
/// A moment as JSON. Large arrays are base64 of little-endian numbers.
nlohmann::json momentJson(const FlightLog& log, const LoggedMoment& moment);
/// The end of a flight, with the exposures after the last moment.
nlohmann::json endJson(const FlightLog& log);

/// A whole log: {"header": headerJson(), "moments": [momentJson(), ...], "end": endJson()}.
nlohmann::json flightLogJson(const FlightLog& log);

/// The inverse of flightLogJson(). @throws std::exception for JSON that is no log
FlightLog flightLogFrom(const nlohmann::json& json);

/// Reads a log from a file. @throws InputError naming the file if it is no log
FlightLog readFlightLog(const std::filesystem::path& file);

}  // namespace photonav
