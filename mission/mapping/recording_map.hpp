// SPDX-License-Identifier: BSD-3-Clause
// Fuses a recording into a textured OctoMap.
#pragma once

#include <functional>
#include <nlohmann/json.hpp>
#include <vector>

#include "dataset/trajectory.hpp"
#include "mapping/map_options.hpp"
#include "mapping/monocular_fusion.hpp"

namespace photonav {

/// Checks the options and reads the tables of the recording by readRecording().
/// @throws InputError for a recording that cannot be used and an option out of range
Recording openForMap(const MapOptions& options);

/// The frames that were fused, and the time it took.
struct FusedRecording {
    std::size_t frames = 0;                ///< processed frames; fewer than all when stopped
    std::vector<Sequence::Skipped> black;  ///< processed frames that are black and were not fused
    Trajectory trajectory;                 ///< camera poses T_w_c of all processed frames
    nlohmann::json monocular;  ///< MonocularFusion::result(); null if depth was recorded
    double loadSeconds = 0.;   ///< wall-clock time of loading images [s]
    double fuseSeconds = 0.;   ///< wall-clock time of fusing them [s]
};

/// Callbacks of fuseRecording(); each may be empty.
struct FusionCalls {
    /// Called after each frame with the number of processed frames and of all frames.
    std::function<void(std::size_t done, std::size_t total)> progress;
    /// Called with every reference image of monocular depth.
    std::function<void(const MonocularFusion::Reference&)> onReference;
};

/// Fuses all frames into a map.
/// @param map empty, with the resolution of the options
/// @param isStopped asked before every frame and, with recorded depth, as FusionOptions::isStopped,
///        which is not used; a part of a frame that is not counted may be in the map, see fuse()
/// @throws InputError for images that cannot be used, for implausible depths, and for cells that
///         are too small for the extent of the recording
FusedRecording fuseRecording(TexturedOcTree& map, const Recording& recording,
                             const MapOptions& options, const IsStopped& isStopped = {},
                             const FusionCalls& calls = {});

}  // namespace photonav
