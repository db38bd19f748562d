// SPDX-License-Identifier: BSD-3-Clause
// Depth images from a flight with one camera.
#pragma once

#include "depth_filter.hpp"

namespace photonav {

struct MonocularOptions {
    DepthFilterOptions filter;
    double maxShift = 0.3;  ///< from the reference [its median depth]
    double maxTurn = 0.6;   ///< [rad]
    int minImages = 10;     ///< that a reference is compared with, if it does not turn away
};

/// One depth filter after the other: images are shown to the latest reference until the camera has
/// moved on from it; that image is the next reference.
class MonocularDepth {
  public:
    explicit MonocularDepth(const Camera& camera, const MonocularOptions& options = {});

    /// @return the filter that this image ends, if it ends one
    /// @throws std::invalid_argument for an image of another size than the camera's
    std::optional<DepthFilter> add(const ImageF& image, const Pose& T_c_w);

    /// The last one, if it has seen anything; begins anew.
    std::optional<DepthFilter> finish();

  private:
    bool hasMovedOn(const Pose& T_c_w) const;

    Camera camera_;
    MonocularOptions options_;
    std::optional<DepthFilter> filter_;
    int images_ = 0;  ///< that filter_ has seen, without its own
};

}  // namespace photonav
