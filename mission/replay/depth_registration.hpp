// SPDX-License-Identifier: BSD-3-Clause
// Where the depth camera of a recording sits beside its colour camera.
#pragma once

#include <functional>
#include <string>

#include "estimation/depth_calibration.hpp"
#include "recording/recording.hpp"

namespace photonav {

struct DepthRegistration {
    Sequence sequence;  ///< of the recording, with the depth camera found
    DepthCalibration calibration;
    std::size_t pairs = 0;  ///< of images that it rests on
    bool isInterrupted = false;
};

/// Pairs images that are a twentieth of the mean depth apart, by visual odometry, and calibrates
/// the depth camera on them. Poses are not needed. It starts at the depth camera that the dataset's
/// camera.yaml (or `cameraFile`) knows, else at the colour camera.
/// @param progress is called with the images done and all there are
/// @throws InputError for a recording that cannot be used: without depth images, or with too little
///         motion for DepthCalibrator::kLeastPairs
DepthRegistration registerDepth(
    const RecordingOptions& options, const std::function<bool()>& isStopped = {},
    const std::function<void(std::size_t done, std::size_t all)>& progress = {});

}  // namespace photonav
