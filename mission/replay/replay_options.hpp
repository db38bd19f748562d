// SPDX-License-Identifier: BSD-3-Clause
// Options for tracking a recorded flight.
#pragma once

#include <optional>
#include <string>

#include "recording/recording.hpp"

namespace photonav {

inline constexpr int kLeastWidth = 24;       ///< least value of ReplayOptions::maxWidth [pixels]
inline constexpr double kStartSigma = 0.05;  ///< default of ReplayOptions::startSigma [m], [rad]

/// Exactly one of `mapFile` and `odometry` must be given.
struct ReplayOptions : RecordingOptions {
    std::string mapFile;      ///< localise in this textured octree (.ot), mesh or scene
    bool odometry = false;    ///< track from image to image, without a map
    std::string calibration;  ///< file that gives the scale and least sigmas not given below
    std::string start;        ///< "x,y,z,qx,qy,qz,qw": camera pose of the first frame, in the map's
                              ///< world (z up) [m]; empty: the true pose
    /// Standard deviation of the start pose, per axis [m] and [rad]. Only in a map: the start of
    /// odometry is exact.
    std::optional<double> startSigma;
    double sigma = 0.02;               ///< standard deviation of image noise, grey values in [0, 1]
    std::optional<double> scale;       ///< factor on the information of an alignment; none: 1
    std::optional<double> leastSigma;  ///< least standard deviation of an aligned position [m];
                                       ///< none: 0
    std::optional<double> leastSigmaRotation;  ///< least standard deviation of an aligned rotation
                                               ///< [rad]; none: 0
    double minOverlap = 0.2;  ///< least share of the image's pixels that the model must cover
    /// Images are halved until they are at most this wide [pixels], at least kLeastWidth. None: 320
    /// in a map, one halving in odometry.
    std::optional<int> maxWidth;
    bool exposure = true;  ///< estimate gain and offset of every image
    /// Standard deviations of the recording's true poses, per axis: position [m] and rotation
    /// [rad]. They count where errors are compared with covariances.
    double truthSigma = 0., truthSigmaRotation = 0.;
};

}  // namespace photonav
