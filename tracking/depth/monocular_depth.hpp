// SPDX-License-Identifier: BSD-3-Clause
// Depth images from a flight with one camera.
#pragma once

#include "depth/depth_filter.hpp"

namespace photonav {

struct MonocularOptions {
    DepthFilterOptions filter;
    double maxShift = 0.3;  ///< from the reference [its median depth]
    double maxTurn = 0.6;   ///< [rad]
    int minImages = 10;     ///< compared with a reference, unless the camera turns away
    /// Share of pixels whose depth variance must have halved by then; otherwise the reference is
    /// given up, because the image is blank or the camera does not move. A reference without any
    /// converged depth is given up after ten times as many images.
    double minNarrowed = 0.01;
};

/// Runs one depth filter after the other. Each image updates the filter of the latest reference,
/// until the camera has moved away from the reference or the reference is given up. That image
/// becomes the next reference.
class MonocularDepth {
  public:
    explicit MonocularDepth(const Camera& camera, const MonocularOptions& options = {});

    /// @return the filter of the last reference, if this image becomes the next one and the last
    ///        one was not given up
    /// @throws std::invalid_argument for an image of another size than the camera's
    std::optional<DepthFilter> add(const ImageF& image, const Pose& T_c_w);

    /// Whether the last image added has become the reference.
    bool isAtReference() const { return filter_ && images_ == 0; }
    int givenUp() const { return givenUp_; }  ///< number of references given up

    /// The filter of the present reference, if it was updated at all. The next image begins a new
    /// one.
    std::optional<DepthFilter> finish();

  private:
    bool hasMovedOn(const Pose& T_c_w) const;
    bool isUninformative() const;

    Camera camera_;
    MonocularOptions options_;
    std::optional<DepthFilter> filter_;
    int images_ = 0;  ///< that have updated filter_
    int givenUp_ = 0;
};

}  // namespace photonav
