// SPDX-License-Identifier: BSD-3-Clause
// A recording becomes a textured OctoMap.
#pragma once

#include <functional>
#include <nlohmann/json.hpp>
#include <vector>

#include "dataset/trajectory.hpp"
#include "mapping/map_options.hpp"
#include "mapping/monocular_fusion.hpp"

namespace photonav {

/// readRecording() for a map, after a check of the options.
/// @throws InputError for a recording that cannot be used and an option out of range
Recording openForMap(const MapOptions& options);

/// What was fused, and how long it took.
struct FusedRecording {
    std::size_t frames = 0;                ///< looked at: less than all when stopped
    std::vector<Sequence::Skipped> black;  ///< of these, not fused
    Trajectory trajectory;                 ///< of all of these
    nlohmann::json monocular;  ///< how good its depths are, null when they were recorded
    double loadSeconds = 0.;   ///< images
    double fuseSeconds = 0.;
};

/// Called during the fusion; either may be empty.
struct FusionCalls {
    /// After each frame with the number done and the number there are.
    std::function<void(std::size_t done, std::size_t total)> progress;
    /// With every reference image of monocular depth.
    std::function<void(const MonocularFusion::Reference&)> onReference;
};

/// Fuses all frames into an empty map of the resolution asked for.
/// @param isStopped asked before every frame
/// @throws InputError for images that cannot be used, implausible depths, and cells too small for
///         the recording
FusedRecording fuseRecording(TexturedOcTree& map, const Recording& recording,
                             const MapOptions& options, const std::function<bool()>& isStopped = {},
                             const FusionCalls& calls = {});

}  // namespace photonav
