// SPDX-License-Identifier: BSD-3-Clause
// Writes a replay as tables and trajectories for other programs.
#pragma once

#include <filesystem>
#include <vector>

#include "dataset/belief_trajectory.hpp"
#include "replay/replay_errors.hpp"

namespace photonav {

/// The beliefs of all tracked frames.
std::vector<StampedBelief> beliefsOf(const ReplayRun& run);

/// Writes frames.csv (one row per frame), trajectory.tum, .kitti, .cov and .ov (tracked frames),
/// and groundtruth.tum (all frames with a true pose, if there are any). All poses are those of the
/// camera, in the same world.
/// @throws InputError for a file that cannot be written
void writeReplayTables(const std::filesystem::path& folder, const ReplayRun& run,
                       const ReplayErrors& errors);

}  // namespace photonav
