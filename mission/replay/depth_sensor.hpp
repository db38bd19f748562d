// SPDX-License-Identifier: BSD-3-Clause
// Estimates the noise of a recording's depth sensor from its depth images.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "recording/recording.hpp"

namespace photonav {

/// Estimator of the noise of depth images. On a plane of any slope, inverse depth is linear along
/// an image row: its second differences are due to noise and rounding.
class DepthNoise {
  public:
    /// Adds the pixels of a depth image [m], without those at edges of surfaces, where depth
    /// changes by more than 3 % from pixel to pixel.
    void add(const ImageF& depth);

    /// Standard deviation of depth at 1 m, if noise grows with depth squared [m]; 0 without pixels.
    double atOneMetre() const;
    /// Standard deviation of depth, over all pixels [m]; 0 without pixels.
    double overall() const;

  private:
    // Absolute second differences of inverse depth [1/m], and the same times depth squared [m].
    std::vector<float> relative_, absolute_;
};

/// Statistics of a few depth images of a recording.
struct DepthLook {
    std::optional<double> median;  ///< median depth [m]; 0: no depth; nothing: no usable image
    DepthNoise noise;
};
/// Evaluates about five images, spread over a recording.
DepthLook lookAtDepth(const Recording& recording);

/// The systematic error of depth: a wrong scale, or depth images that are not registered to the
/// colour images. It is the same in every image, so that no residual shows it.
struct DepthError {
    double relative = 0.;    ///< error of an estimated motion as a share of this motion
    bool isAssumed = false;  ///< true: the recording does not state it
};

/// The systematic depth error of a recording: `depth_error` of camera.yaml, if it is there. Else it
/// is assumed from the noise: 0 for rendered depth and depth from stereo; for a depth sensor the
/// error of unregistered depth, the largest one known of such sensors.
DepthError depthErrorOf(const Recording& recording, const DepthNoise& noise);

}  // namespace photonav
