// SPDX-License-Identifier: BSD-3-Clause
// What the depth images of a recording say about the sensor that took them.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "recording/recording.hpp"

namespace photonav {

/// The noise of depth images. Along their rows, inverse depth is linear on a plane, whatever its
/// slope: noise and rounding are what bends it.
class DepthNoise {
  public:
    /// Pixels at the edges of surfaces, where depth steps by more than 3 %, are left out.
    void add(const ImageF& depth);

    /// Standard deviation at a depth of 1 m, of noise that grows with depth squared [m]; 0 where
    /// nothing was added.
    double atOneMetre() const;
    /// Standard deviation, over all depths [m]; 0 where nothing was added.
    double overall() const;

  private:
    std::vector<float> relative_, absolute_;  // bends over depth squared [1/m], bends [m]
};

/// A look at a few images of a recording.
struct DepthLook {
    std::optional<double> median;  ///< [m]; 0: no depth; nothing: none of the images can be used
    DepthNoise noise;
};
DepthLook lookAtDepth(const Recording& recording);

/// What depth gets wrong in the same way in every image, as a share of the motion between two
/// images: a wrong scale, depth images that do not fit the colour images. No residual shows it.
struct DepthError {
    double relative = 0.;
    bool isAssumed = false;  ///< the recording does not say
};

/// As `depth_error` of camera.yaml says. Without it, the noise decides: rendered depth is exact;
/// for that of a sensor the error of depth that is not registered is assumed, the largest that
/// sensors are known to have.
DepthError depthErrorOf(const Recording& recording, const DepthNoise& noise);

}  // namespace photonav
