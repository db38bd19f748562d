// SPDX-License-Identifier: BSD-3-Clause
// Reads recordings from ROS 1 bags.
#pragma once

#include "recording/recording.hpp"

namespace photonav {

/// Whether a path names a bag: a file that begins with the signature of a bag, or a path that ends
/// in .bag and is no folder.
bool isBagRecording(const std::string& path);

/// All frames of a bag, in the recorded world.
/// @throws InputError as readBagSequence(), and for options that do not apply to bags
Recording readBagRecording(const RecordingOptions& options);

}  // namespace photonav
