// SPDX-License-Identifier: BSD-3-Clause
// The infrared projector of a stereo camera: it gives texture to uniform surfaces.
#pragma once

#include "photometry/view.hpp"

namespace photonav {

/// Projects a fixed pattern of random dots from the centre of a left camera. Its brightness falls
/// with the square of the distance.
class PatternProjector {
  public:
    /// @param contrast brightest dots relative to the other light, at a depth of 1 m
    PatternProjector(const Camera& camera, double contrast);

    /// Adds the pattern to a view of the left camera, or of a camera to its right. What the
    /// projector does not reach has no pattern.
    /// @param projected true depth in the left camera's view [m]
    /// @param baseline distance of the view's camera from the left camera [m]; 0: the left camera
    void illuminate(View& view, const ImageF& projected, double baseline) const;

  private:
    double focalLength_, contrast_;
    ImageF pattern_;  // in [0, 1], as seen by the left camera
};

}  // namespace photonav
