// SPDX-License-Identifier: BSD-3-Clause
// Estimates the pose of a recording's depth camera relative to its colour camera.
#pragma once

#include <functional>
#include <string>

#include "estimation/depth_calibration.hpp"
#include "io/interrupted.hpp"
#include "recording/recording.hpp"

namespace photonav {

struct DepthRegistration {
    Sequence sequence;  ///< the recording's sequence, with the calibrated depth camera
    DepthCalibration calibration;
    std::size_t pairs = 0;       ///< image pairs used for the calibration
    std::size_t unreadable = 0;  ///< frames left out because an image of theirs cannot be used
    bool isInterrupted = false;
};

/// Selects image pairs whose camera positions are a twentieth of the mean depth apart, measured by
/// visual odometry, and calibrates the depth camera on these pairs. Recorded poses are not needed.
/// The initial value is the depth camera of the dataset's camera.yaml (or `cameraFile`), else the
/// colour camera.
/// @param isStopped asked before every image
/// @param progress called after every image with the number of processed and of all images
/// @throws InputError for a recording without depth images, or with too little motion for
///         DepthCalibrator::kLeastPairs pairs; of the first image that cannot be used, if most
///         cannot
DepthRegistration registerDepth(
    const RecordingOptions& options, const IsStopped& isStopped = {},
    const std::function<void(std::size_t done, std::size_t all)>& progress = {});

}  // namespace photonav
