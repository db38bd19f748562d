// SPDX-License-Identifier: BSD-3-Clause
// `photonav replay`: a recorded flight through the tracker.
#pragma once

#include <atomic>
#include <filesystem>
#include <functional>
#include <nlohmann/json.hpp>
#include <string>

#include "report/report.hpp"
#include "runs/replay_source.hpp"

namespace photonav {

inline constexpr int kLeastWidth = 24;       ///< of the images that are tracked [pixels]
inline constexpr double kStartSigma = 0.05;  ///< in a map, when nothing else is said [m], [rad]

struct ReplayOptions : RecordingOptions {
    std::filesystem::path out;  ///< folder for the results; made when missing
    std::string mapFile;        ///< localise in this textured octree (.ot), mesh or scene
    bool odometry = false;      ///< instead: no map, from image to image
    std::string start;          ///< "x,y,z,qx,qy,qz,qw" of the first frame's camera, in the map's
                                ///< world (z up); empty: the ground truth's
    /// Standard deviation of the start, per axis [m] and [rad]; only in a map: odometry is exact
    /// where it begins.
    std::optional<double> startSigma;
    double sigma = 0.02;                     ///< image noise, grey values in [0, 1]
    std::optional<double> scale;             ///< factor on the information
    std::optional<double> floorTranslation;  ///< least standard deviations of an alignment [m]
    std::optional<double> floorRotation;     ///< [rad]; without these three the tracker's defaults:
                                             ///< realCameraOptions(), KeyframeOptions
    double minOverlap = 0.2;  ///< least share of the image's pixels that the model must explain
    /// Images are halved until they are as wide [pixels]; by default 320 in a map, once in
    /// odometry.
    std::optional<int> maxWidth;  ///< at least kLeastWidth
    bool calibrate = false;   ///< also write calibration.yaml: factor and floor that fit the errors
    bool exposure = true;     ///< estimate gain and offset of every image
    std::string commandLine;  ///< for the report

    /// Called after each frame with the number done and the number there are.
    std::function<void(std::size_t done, std::size_t total)> progress;
};

struct ReplayReport {
    nlohmann::json result;  ///< what was written as result.json
    ReportTable summary;    ///< the same in words
    int exitCode = 0;       ///< 1 when lost for good, 130 when interrupted
};

/// Replays a dataset and writes into options.out: result.json, config.yaml (replay_config.hpp),
/// frames.csv (a row per frame), trajectory.tum, trajectory.cov, trajectory.ov and groundtruth.tum
/// (camera to world), errors.png, strips.png, top_view.png and report.html.
/// @param interrupted checked between frames; what is there then is written
/// @throws InputError for a dataset or map that cannot be used, an option out of range and a folder
///         that cannot be written, the last before any work is done
ReplayReport runReplay(const ReplayOptions& options, const std::atomic<bool>& interrupted);

}  // namespace photonav
