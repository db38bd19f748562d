// SPDX-License-Identifier: BSD-3-Clause
// Recordings in ROS 1 bags.
#pragma once

#include "recording/recording.hpp"

namespace photonav {

/// Whether a path is one of a bag: a file that begins as bags do, or is called one.
bool isBagRecording(const std::string& path);

/// All frames of a bag, in the recorded world.
/// @throws InputError as readBagSequence(), and for options that bags do not have
Recording readBagRecording(const RecordingOptions& options);

}  // namespace photonav
