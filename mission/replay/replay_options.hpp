// SPDX-License-Identifier: BSD-3-Clause
// Which recorded flight to track, and how.
#pragma once

#include <optional>
#include <string>

#include "recording/recording.hpp"

namespace photonav {

inline constexpr int kLeastWidth = 24;       ///< of the images that are tracked [pixels]
inline constexpr double kStartSigma = 0.05;  ///< in a map, when nothing else is said [m], [rad]

/// Either `mapFile` or `odometry`.
struct ReplayOptions : RecordingOptions {
    std::string mapFile;      ///< localise in this textured octree (.ot), mesh or scene
    bool odometry = false;    ///< instead: no map, from image to image
    std::string calibration;  ///< file with the scale and least sigmas that are not given below
    std::string start;        ///< "x,y,z,qx,qy,qz,qw" of the first frame's camera, in the map's
                              ///< world (z up); empty: the ground truth's
    /// Standard deviation of the start, per axis [m] and [rad]; only in a map: odometry is exact
    /// where it begins.
    std::optional<double> startSigma;
    double sigma = 0.02;                       ///< image noise, grey values in [0, 1]
    std::optional<double> scale;               ///< factor on the measured information; none: 1
    std::optional<double> leastSigma;          ///< least standard deviations of an alignment [m]
    std::optional<double> leastSigmaRotation;  ///< [rad]; none: 0
    double minOverlap = 0.2;  ///< least share of the image's pixels that the model must explain
    /// Images are halved until they are as wide [pixels]; by default 320 in a map, once in
    /// odometry.
    std::optional<int> maxWidth;  ///< at least kLeastWidth
    bool exposure = true;         ///< estimate gain and offset of every image
};

}  // namespace photonav
