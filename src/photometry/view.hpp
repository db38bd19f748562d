// SPDX-License-Identifier: BSD-3-Clause
// What a camera would see: the one interface between maps and everything that looks at them.
#pragma once

#include "geometry/camera.hpp"
#include "geometry/types.hpp"

namespace photonav {

/// A predicted (or measured) image with its depth, both camera.height x camera.width.
struct View {
    ImageF intensity;  ///< grey value in [0, 1], proportional to the stored 8-bit value
    ImageF depth;      ///< z of the surface in the camera frame [m]; 0: no surface, unknown
};

/// A map that can be looked at. Implementations: MeshRenderer, VoxelRenderer, or your own.
class ViewSource {
  public:
    virtual ~ViewSource() = default;

    /// Predicts the noise-free, anti-aliased view from a camera pose; resizes `view` as needed.
    /// Thread-safe and deterministic: the same pose gives the same bits.
    virtual void render(const Camera& camera, const Pose& T_c_w, View& view) const = 0;
};

/// Whether a recorded image is that of a covered lens: a mean grey value below 5 of 255.
bool isBlack(const ImageF& image);

/// The camera's point spread, applied by every renderer as its last step: a 3x3 binomial filter of
/// the intensity, so that edges are about three pixels wide and their gradients mean something.
/// Pixels with an invalid neighbour (depth 0) keep their value, beyond the border the image goes on
/// linearly, and a constant image stays constant to the bit.
/// @throws std::invalid_argument when intensity and depth differ in size
void applyPointSpread(View& view);

}  // namespace photonav
