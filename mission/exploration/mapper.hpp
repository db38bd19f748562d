// SPDX-License-Identifier: BSD-3-Clause
// Fuses images into the robot's own map, with depth from a sensor or from the motion of one camera.
#pragma once

#include <optional>

#include "depth/monocular_depth.hpp"
#include "exploration/keyframe_choice.hpp"
#include "exploration/online_map.hpp"

namespace photonav {

/// With a depth sensor or a stereo camera, keyframes are fused. With a single camera, the reference
/// images of depth filters are fused, once the robot has moved far enough for their depths to
/// converge.
class Mapper {
  public:
    /// @param map must outlive the mapper
    Mapper(const Config& config, OnlineMap& map);

    /// Adds a tracked image.
    /// @param shown view of the map from the believed pose
    /// @param isNeeded the robot waits for its map to grow
    /// @return the change of the map, after which the plan must be updated; nothing if no update is
    ///         needed. With a single camera, an empty change is returned if the robot waits
    ///         although nothing was fused.
    std::optional<MapChange> add(const TrackedFrame& tracked, const View& image, const View& shown,
                                 bool isNeeded);

    int keyframes() const { return keyframes_; }  ///< number of images fused so far

  private:
    std::optional<MapChange> addKeyframe(const TrackedFrame& tracked, const View& image,
                                         const View& shown, bool isNeeded);
    std::optional<MapChange> addToFilter(const TrackedFrame& tracked, const View& image,
                                         const View& shown, bool isNeeded);

    Camera camera_;
    OnlineMap& map_;
    KeyframeChoice choice_;
    std::optional<MonocularDepth> depth_;  // of a camera without a depth sensor
    int reference_ = 0;                    // number of the reference image's pose in the map
    int keyframes_ = 0;
};

}  // namespace photonav
