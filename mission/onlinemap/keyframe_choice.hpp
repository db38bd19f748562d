// SPDX-License-Identifier: BSD-3-Clause
// Selects the images that are fused into the map while the robot flies.
#pragma once

#include <map>
#include <optional>

#include "config/explore_config.hpp"
#include "estimation/tracked_frame.hpp"
#include "geometry/camera.hpp"
#include "photometry/view.hpp"

namespace photonav {

class KeyframeChoice {
  public:
    KeyframeChoice(const ExploreConfig& config, const Camera& camera)
        : config_(config), camera_(camera) {}

    /// Whether an image should be fused: it is usable, and it is the first one, far from the last
    /// keyframe, or shows many surfaces (ExploreConfig::keyframe...) that are missing in the map
    /// and in the keyframes that the map is still to show.
    /// @param shown view of the map from the believed pose
    bool isKeyframe(const TrackedFrame& tracked, const View& image, const View& shown) const;
    /// Whether an image may be fused: it is not black, and its alignment was accepted. A rejected
    /// image is usable, too, if the map shows too little for an alignment or is out of date.
    bool isUsable(const TrackedFrame& tracked, const View& image) const;

    /// The image becomes a keyframe.
    /// @param number tells keyframes apart @param T_c_w its pose
    void add(int number, const View& image, const Pose& T_c_w);
    /// The map shows a keyframe. Other numbers do nothing.
    void setFused(int number) { notInMap_.erase(number); }

  private:
    struct Keyframe {
        ImageF depth;
        Pose T_c_w;
    };

    double shareNew(const View& image, const View& shown, const Pose& T_c_w) const;
    bool isSurfaceOf(const Keyframe& keyframe, const Eigen::Vector3d& p_w) const;

    ExploreConfig config_;
    Camera camera_;
    std::optional<Pose> T_last_w_;
    std::map<int, Keyframe> notInMap_;  // while a second thread fuses them
};

}  // namespace photonav
