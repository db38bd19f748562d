// SPDX-License-Identifier: BSD-3-Clause
// Reads recordings of a stereo camera (EuRoC layout) as images with depth.
#pragma once

#include "recording/recording.hpp"

namespace photonav {

/// All frames of the dataset, as rectified images of the left camera with depth, in the recorded
/// world.
/// @throws InputError for a dataset that cannot be used, and for options that do not apply to it
Recording readStereoRecording(const RecordingOptions& options);

}  // namespace photonav
