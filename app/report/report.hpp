// SPDX-License-Identifier: BSD-3-Clause
// The report of a run: one self-contained HTML page (3-D view, charts, figures, numbers) that opens
// offline, and the JSON it is made of.
#pragma once

#include <cstddef>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "plot/picture.hpp"
#include "problem/planning_problem.hpp"
#include "shapes/paths.hpp"
#include "shapes/surroundings.hpp"

namespace photonav {

/// The predicted view at a point of the first path.
struct ReportView {
    std::size_t point = 0;  ///< index into paths[0].points
    Png image;
    Png contribution;  ///< see contributionPicture(); may be empty
};

struct ReportFigure {
    std::string caption;
    Png image;
};

/// A picture of an animation, with the robot of that time in the 3-D view.
struct ReportFrame {
    std::string caption;
    Png image;
    std::string series = {};                    ///< frames of one name are played in a row
    std::optional<PathPoint> believed = {};     ///< none: no robot is drawn
    std::optional<Eigen::Vector3d> truth = {};  ///< of the camera centre, in w [m]
    Color color = kInk;                         ///< of the robot
};

struct ReportTable {
    std::string title;
    std::vector<std::pair<std::string, std::string>> rows;  ///< label, value with unit
};

/// All the page shows. Empty members are simply not shown.
struct ReportData {
    std::string title;
    std::string subtitle;     ///< one sentence: what was done
    std::string commandLine;  ///< as typed
    std::string version = PHOTONAV_VERSION;
    nlohmann::json result = nlohmann::json::object();  ///< result.json of the run
    std::string config;                                ///< YAML, complete
    DrawnMesh mesh;
    DrawnVoxels voxels;
    std::vector<DrawnTree> trees;
    std::vector<DrawnPath> paths;  ///< the answer first, then what it is compared with
    Eigen::Vector3d start = Eigen::Vector3d::Zero();
    Eigen::Vector3d goal = Eigen::Vector3d::Zero();
    Eigen::Vector2d fieldOfView{1.2217, 0.84};  ///< of the camera, full angles, horizontal and
                                                ///< vertical [rad]
    std::vector<ReportView> views;
    std::vector<PlanProgress> progress;
    std::vector<ReportFigure> figures;
    std::vector<ReportFrame> frames;  ///< one after the other, as an animation
    std::vector<ReportTable> tables;
    nlohmann::json flight;  ///< flightLogJson() of a flight to be watched; null: none
};

/// "0.537 m", "3.75 mm".
std::string lengthText(double metres);

/// Full angles of a camera, horizontal and vertical [rad].
Eigen::Vector2d fieldOfView(const Camera& camera);

/// The JSON that the page draws, the content of report.json: large arrays as base64 of
/// little-endian float32, uint32 or uint8, pictures as base64 of PNG.
std::string reportJson(const ReportData& data);

/// The content of report.json.
/// @throws InputError naming file and reason if it is missing, cut or not ours
std::string readReportJson(const std::filesystem::path& file);

/// The content of the report.json of a result folder.
/// @throws InputError also for a folder without one
std::string readReportOf(const std::filesystem::path& folder);

/// The page, HTML.
/// @param content of reportJson() or readReportJson()
std::string reportPage(std::string_view content);

/// Writes the page, whole or not at all.
/// @param content of reportJson() or readReportJson()
/// @throws InputError if it cannot be written
void writeReport(const std::filesystem::path& file, std::string_view content);

/// A figure and the file it goes to.
struct NamedFigure {
    std::string name;
    ReportFigure figure;
};

/// Writes the figures (also into the report), config.yaml (unless the report has none), report.json
/// and report.html. result.json comes last and is the command's: where it is, the folder is
/// complete.
void writeResultFolder(const std::filesystem::path& folder, ReportData& report,
                       const std::vector<NamedFigure>& figures);

}  // namespace photonav
