// SPDX-License-Identifier: BSD-3-Clause
// Selects the images that are fused into the map while the robot flies.
#pragma once

#include <optional>

#include "config/explore_config.hpp"
#include "estimation/tracked_frame.hpp"
#include "photometry/view.hpp"

namespace photonav {

class KeyframeChoice {
  public:
    explicit KeyframeChoice(const ExploreConfig& config) : config_(config) {}

    /// Whether an image should be fused: it is usable, and it is the first one, far from the last
    /// fused image, or shows many surfaces that the map lacks (ExploreConfig::keyframe...).
    /// @param shown view of the map from the believed pose
    bool isKeyframe(const TrackedFrame& tracked, const View& image, const View& shown) const;
    /// Whether an image may be fused: it is not black, and its alignment was accepted. A rejected
    /// image is usable, too, if the map shows too little for an alignment or is out of date.
    bool isUsable(const TrackedFrame& tracked, const View& image) const;

    /// Is to be called after an image was fused. @param T_c_w its pose
    void fused(const Pose& T_c_w) { T_last_w_ = T_c_w; }

  private:
    double shareNew(const View& image, const View& shown) const;

    ExploreConfig config_;
    std::optional<Pose> T_last_w_;
};

}  // namespace photonav
