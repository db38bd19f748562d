// SPDX-License-Identifier: BSD-3-Clause
// Which images of a depth sensor become part of the map while the robot flies on.
#pragma once

#include <optional>

#include "config/explore_config.hpp"
#include "estimation/tracked_frame.hpp"
#include "photometry/view.hpp"

namespace photonav {

class KeyframeChoice {
  public:
    explicit KeyframeChoice(const ExploreConfig& config) : config_(config) {}

    /// Whether an image should be fused: it is far from the last one fused, or much of it is new.
    /// An image that the map contradicts is not.
    /// @param shown view of the map from the believed pose
    bool isKeyframe(const TrackedFrame& tracked, const View& image, const View& shown) const;
    /// Whether an image may be fused at all: it is not black, and the map does not contradict it.
    bool isUsable(const TrackedFrame& tracked, const View& image) const;

    void fused(const Pose& T_c_w) { T_last_w_ = T_c_w; }

  private:
    double shareNew(const View& image, const View& shown) const;

    ExploreConfig config_;
    std::optional<Pose> T_last_w_;
};

}  // namespace photonav
