// SPDX-License-Identifier: BSD-3-Clause
// Fuses images into the robot's own map, by a depth sensor or by the motion of one camera.
#pragma once

#include <optional>

#include "depth/monocular_depth.hpp"
#include "exploration/keyframe_choice.hpp"
#include "exploration/own_map.hpp"

namespace photonav {

/// Fuses keyframes of a camera with depth. Of a camera without, the reference images of its depth
/// filters are fused, once the robot has moved far enough for their depths to have converged.
class Mapper {
  public:
    /// @param map must outlive it
    Mapper(const Config& config, OwnMap& map);

    /// An image was tracked.
    /// @param shown view of the map from the believed pose
    /// @param isNeeded the robot waits for its map to grow
    /// @return what changed in the map, for a new plan; empty while the robot waits for its map
    ///         although nothing changed; none: no new plan is needed
    std::optional<MapChange> add(const TrackedFrame& tracked, const View& image, const View& shown,
                                 bool isNeeded);

    int keyframes() const { return keyframes_; }  ///< fused so far

  private:
    std::optional<MapChange> addKeyframe(const TrackedFrame& tracked, const View& image,
                                         const View& shown, bool isNeeded);
    std::optional<MapChange> addToFilter(const TrackedFrame& tracked, const View& image,
                                         const View& shown, bool isNeeded);

    Camera camera_;
    OwnMap& map_;
    KeyframeChoice choice_;
    std::optional<MonocularDepth> depth_;  // of a camera without a depth sensor
    int reference_ = 0;                    // number of the pose of its reference
    int keyframes_ = 0;
};

}  // namespace photonav
