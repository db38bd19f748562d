// SPDX-License-Identifier: BSD-3-Clause
// Chooses what is fused into the robot's own map, with depth from a sensor or from the motion of
// one camera.
#pragma once

#include <optional>

#include "depth/monocular_depth.hpp"
#include "estimation/map_errors.hpp"
#include "onlinemap/keyframe_choice.hpp"
#include "onlinemap/online_map.hpp"

namespace photonav {

/// With a depth sensor or a stereo camera, keyframes are fused. With a single camera, the reference
/// images of depth filters are fused, once the robot has moved far enough for their depths to
/// converge.
///
/// It keeps the errors of the map, which the tracker uses, and does not touch the map itself: that
/// may be in use by another thread.
class Mapper {
  public:
    /// @param known what the robot knows at take-off; null: nothing. It is taken to be as exact as
    ///        a map of an exploration.
    explicit Mapper(const Config& config, const TexturedOcTree* known = nullptr);

    /// Considers a tracked image. If its pose becomes a keyframe, it is added to errors().
    /// @param shown view of the map from the believed pose
    /// @param isNeeded the robot waits for its map to grow
    /// @return how the image changes the map, after which the plan must be updated; nothing if no
    ///         update is needed. With a single camera, an input without a keyframe is returned if
    ///         the robot waits although there is nothing to fuse.
    std::optional<MapInput> choose(const TrackedFrame& tracked, const View& image,
                                   const View& shown, bool isNeeded);

    /// A chosen image is in the map that the tracker is about to use: the surfaces of its keyframe
    /// are added to errors().
    void setFused(const MapInput& fused);

    int keyframes() const { return keyframes_; }  ///< number of keyframes chosen so far
    const std::shared_ptr<MapErrors>& errors() const { return errors_; }

  private:
    using Keyframe = MapInput::Keyframe;
    void addKnown(const TexturedOcTree& known, const Place& start);
    std::optional<Keyframe> chooseImage(const TrackedFrame& tracked, const View& image,
                                        const View& shown, bool isNeeded);
    std::optional<Keyframe> addToFilter(const TrackedFrame& tracked, const View& image);

    Camera camera_;
    std::shared_ptr<MapErrors> errors_;
    KeyframeChoice choice_;
    std::optional<MonocularDepth> depth_;  // of a camera without a depth sensor
    double range_;                         // depths beyond are not fused [m]
    int reference_ = 0;                    // number of the reference image's pose in the map
    int keyframes_ = 0;
};

}  // namespace photonav
