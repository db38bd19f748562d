// SPDX-License-Identifier: BSD-3-Clause
// Depth images from the images of one moving camera.
#pragma once

#include "depth/depth_filter.hpp"

namespace photonav {

struct MonocularOptions {
    DepthFilterOptions filter;
    // The next reference is begun when the camera has moved by one of these from the present one.
    double maxShift = 0.3;  ///< distance, in units of the reference's median depth
    double maxTurn = 0.6;   ///< angle [rad]
    int minImages = 10;     ///< least number of images per reference, unless the camera has turned
    /// Share of pixels whose variance must have halved after minImages; otherwise the reference is
    /// given up, because the image is blank or the camera does not move. A reference without any
    /// converged depth is given up after ten times as many images.
    double minNarrowed = 0.01;
};

/// Runs one depth filter after the other. Each image updates the filter of the latest reference
/// image, until the camera has moved away from the reference or the reference is given up. The
/// image at which this happens becomes the next reference.
class MonocularDepth {
  public:
    explicit MonocularDepth(const Camera& camera, const MonocularOptions& options = {});

    /// Adds an image with the camera pose T_c_w.
    /// @return the filter of the last reference, if this image becomes the next reference and the
    ///        last one was not given up
    /// @throws std::invalid_argument for an image of another size than the camera's
    std::optional<DepthFilter> add(const ImageF& image, const Pose& T_c_w);

    /// Whether the last image added has become the reference.
    bool isAtReference() const { return filter_ && images_ == 0; }
    int givenUp() const { return givenUp_; }  ///< number of references given up

    /// The filter of the present reference; none if no image has updated it. The next image becomes
    /// a new reference.
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
