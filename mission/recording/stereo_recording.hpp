// SPDX-License-Identifier: BSD-3-Clause
// Recordings of a stereo camera (EuRoC layout) as images with depth.
#pragma once

#include "recording/recording.hpp"

namespace photonav {

/// All frames of the dataset, rectified, in the recorded world.
/// @throws InputError for a dataset that cannot be used, and for options that mean nothing for it
Recording readStereoRecording(const RecordingOptions& options);

}  // namespace photonav
