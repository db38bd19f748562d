// SPDX-License-Identifier: BSD-3-Clause
// The report of a run: one self-contained HTML page (3-D view, charts, figures, numbers) that opens
// offline, and the JSON from which the page is made.
#pragma once

#include <cstddef>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "plot/figure.hpp"
#include "problem/planning_problem.hpp"
#include "result/text_table.hpp"
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

/// A frame of an animation, with the pose of the robot at that time in the 3-D view.
struct ReportFrame {
    std::string caption;
    Png image;
    std::string series = {};  ///< frames of one series are played one after the other
    std::optional<PathPoint> believed = {};     ///< the belief; none: no robot is drawn
    std::optional<Eigen::Vector3d> truth = {};  ///< true camera centre, world frame [m]
    Color color = kInk;                         ///< colour of the robot
};

struct ReportTable {
    std::string title;
    std::vector<std::pair<std::string, std::string>> rows;  ///< label, value with unit
};

/// A table of several columns.
struct ReportTextTable {
    std::string title;
    TextTable table;
    std::string note = {};  ///< below the table
};

/// The content of the page. Empty members are not shown.
struct ReportData {
    std::string title;
    std::string subtitle;     ///< one sentence: what was done
    std::string commandLine;  ///< the command as typed
    std::string version = PHOTONAV_VERSION;
    nlohmann::json result = nlohmann::json::object();  ///< content of result.json
    std::string config;                                ///< complete config as YAML
    DrawnMesh mesh;
    DrawnVoxels voxels;
    std::vector<DrawnTree> trees;
    std::vector<DrawnPath> paths;  ///< the result first, then paths for comparison
    Eigen::Vector3d start = Eigen::Vector3d::Zero();  ///< world frame [m]
    Eigen::Vector3d goal = Eigen::Vector3d::Zero();   ///< world frame [m]
    Eigen::Vector2d fieldOfView{1.2217, 0.84};        ///< full angles of the camera, horizontal
                                                      ///< and vertical [rad]
    std::vector<ReportView> views;
    std::vector<PlanProgress> progress;
    std::vector<ReportFigure> figures;
    std::vector<ReportFrame> frames;  ///< frames of the animation, in their order
    std::vector<ReportTable> tables;
    std::vector<ReportTextTable> textTables;
    nlohmann::json flight;  ///< flightLogJson() of a flight to play in the 3-D view; null: none
};

/// A length as text: "0.537 m"; below 0.1 m in millimetres, "3.75 mm".
std::string lengthText(double metres);

/// Full angles of a camera, horizontal and vertical [rad].
Eigen::Vector2d fieldOfView(const Camera& camera);

/// The content of report.json, from which the page is drawn. Large arrays are base64 of
/// little-endian float32, uint32 or uint8; pictures are PNG files as data URIs (base64).
std::string reportJson(const ReportData& data);

/// Reads a report.json.
/// @throws InputError naming file and reason if the file is missing, incomplete, or not a report of
///         this version of photonav's format
std::string readReportJson(const std::filesystem::path& file);

/// Reads the report.json of a result folder.
/// @throws InputError as readReportJson() does, and for a folder without a report.json
std::string readReportOf(const std::filesystem::path& folder);

/// The HTML page.
/// @param content content of report.json, from reportJson() or readReportJson()
std::string reportPage(std::string_view content);

/// Writes the HTML page. An earlier file is replaced only when the new one is complete.
/// @param content content of report.json, from reportJson() or readReportJson()
/// @throws InputError if the file cannot be written
void writeReport(const std::filesystem::path& file, std::string_view content);

/// A figure of the page, and the name of its files in the result folder.
struct NamedFigure {
    std::string name;  ///< without ending
    std::string caption;
    Figure figure;
};

/// Writes a figure as <name>.png, <name>.svg and <name>.pdf into a result folder.
/// @return the PNG
Png writeFigure(const std::filesystem::path& folder, const std::string& name, const Figure& figure);

/// Writes the figures, config.yaml (unless the report has no config), report.json and report.html,
/// and adds the figures to the report. result.json is not written here: the command writes it last,
/// so that a folder with a result.json is complete.
void writeResultFolder(const std::filesystem::path& folder, ReportData& report,
                       const std::vector<NamedFigure>& figures);

}  // namespace photonav
