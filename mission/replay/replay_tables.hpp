// SPDX-License-Identifier: BSD-3-Clause
// A replay as tables and trajectories for other programs.
#pragma once

#include <filesystem>
#include <vector>

#include "dataset/belief_trajectory.hpp"
#include "replay/replay_errors.hpp"

namespace photonav {

std::vector<StampedBelief> beliefsOf(const ReplayRun& run);  ///< of the frames tracked

/// Writes frames.csv (a row per frame), trajectory.tum, .kitti, .cov and .ov of the frames tracked,
/// and groundtruth.tum of the frames used, in the same world and of the same camera.
/// @throws InputError for a file that cannot be written
void writeReplayTables(const std::filesystem::path& folder, const ReplayRun& run,
                       const ReplayErrors& errors);

}  // namespace photonav
