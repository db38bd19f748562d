// SPDX-License-Identifier: BSD-3-Clause
// The report of a run: one self-contained HTML page (3-D view, charts, figures, numbers) that opens
// offline, and the JSON it is made of.
#pragma once

#include <cstddef>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

#include "figures.hpp"
#include "pictures.hpp"
#include "scene.hpp"
#include "textured_octree.hpp"

namespace photonav {

/// Textured triangles of the 3-D view, in w [m].
struct ReportMesh {
    std::vector<float> positions;         ///< 9 per triangle
    std::vector<float> uv;                ///< 6 per triangle; v downward, textures repeat
    std::vector<std::uint32_t> textures;  ///< 1 per triangle, index into `images`
    std::vector<Png> images;
};

/// Grey cubes of the 3-D view, in w [m].
struct ReportVoxels {
    std::vector<float> centers;      ///< 3 per voxel
    std::vector<std::uint8_t> grey;  ///< 1 per voxel
    double size = 0.0;               ///< edge length [m]
};

/// What the camera would see at a point of the first path.
struct ReportView {
    std::size_t point = 0;  ///< index into paths[0].points
    Png image;
    Png contribution;  ///< see contributionPng(); may be empty
};

/// State of the search when its best cost changed (and at its end).
struct ReportProgress {
    std::size_t vertices = 0;
    double seconds = 0.0;
    double cost = 0.0;
    std::size_t views = 0;
};

struct ReportFigure {
    std::string caption;
    Png image;
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
    std::string version;
    nlohmann::json result = nlohmann::json::object();  ///< result.json of the run
    std::string config;                                ///< YAML, complete
    ReportMesh mesh;
    ReportVoxels voxels;
    std::vector<DrawnTree> trees;
    std::vector<DrawnPath> paths;  ///< the answer first, then what it is compared with
    Eigen::Vector3d start = Eigen::Vector3d::Zero();
    Eigen::Vector3d goal = Eigen::Vector3d::Zero();
    Eigen::Vector2d fieldOfView{1.2217, 0.84};  ///< of the camera, full angles, horizontal and
                                                ///< vertical [rad]
    std::vector<ReportView> views;
    std::vector<ReportProgress> progress;
    std::vector<ReportFigure> figures;
    std::vector<ReportFigure> frames;  ///< one after the other, as an animation
    std::vector<ReportTable> tables;
};

/// The scene as the page draws it: textures as PNG of at most 2048 pixels a side.
ReportMesh makeReportMesh(const Scene& scene);

/// The voxels as the page draws them. Beyond `limit`, eight neighbours become one of twice the size
/// and their mean grey value, until they are few enough.
/// @param size edge length [m]
ReportVoxels makeReportVoxels(const std::vector<Eigen::Vector3f>& centers,
                              const std::vector<std::uint8_t>& grey, double size,
                              std::size_t limit = 400000);

/// The occupied cells of a map with the mean grey value of their faces (0.5 where never observed).
ReportVoxels makeReportVoxels(const TexturedOcTree& map);

/// Large arrays as base64 of little-endian float32, uint32 or uint8, pictures as base64 of PNG.
nlohmann::json toJson(const ReportData& data);

/// Reads what toJson() gave and a run wrote as report.json.
/// @throws InputError naming file and key if it is missing, cut or not ours
ReportData readReportData(const std::filesystem::path& file);

/// Writes the page, whole or not at all.
/// @throws InputError if it cannot be written
void writeReport(const std::filesystem::path& file, const ReportData& data);

}  // namespace photonav
