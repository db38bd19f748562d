// SPDX-License-Identifier: BSD-3-Clause
// Depth images from a flight with one camera.
#pragma once

#include "depth/depth_filter.hpp"

namespace photonav {

struct MonocularOptions {
    DepthFilterOptions filter;
    double maxShift = 0.3;  ///< from the reference [its median depth]
    double maxTurn = 0.6;   ///< [rad]
    int minImages = 10;     ///< that a reference is compared with, if it does not turn away
    /// Share of pixels of which something must be known by then, or the reference is given up: a
    /// blank image, or a camera that does not move. Without one depth it has ten times as long.
    double fruitful = 0.01;
};

/// One depth filter after the other: images are shown to the latest reference until the camera has
/// moved on from it, or it has turned out to be worth nothing; that image is the next reference.
class MonocularDepth {
  public:
    explicit MonocularDepth(const Camera& camera, const MonocularOptions& options = {});

    /// @return the filter that this image ends, if it ends one
    /// @throws std::invalid_argument for an image of another size than the camera's
    std::optional<DepthFilter> add(const ImageF& image, const Pose& T_c_w);

    /// Whether the last image added has become the reference.
    bool isAtReference() const { return filter_ && images_ == 0; }
    int givenUp() const { return givenUp_; }  ///< references that were worth nothing

    /// The last one, if it has seen anything; begins anew.
    std::optional<DepthFilter> finish();

  private:
    bool hasMovedOn(const Pose& T_c_w) const;
    bool isFruitless() const;

    Camera camera_;
    MonocularOptions options_;
    std::optional<DepthFilter> filter_;
    int images_ = 0;  ///< that filter_ has seen, without its own
    int givenUp_ = 0;
};

}  // namespace photonav
