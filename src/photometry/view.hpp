// SPDX-License-Identifier: BSD-3-Clause
// Views predicted from a map: the interface between maps and everything that uses views.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "geometry/camera.hpp"
#include "geometry/types.hpp"

namespace photonav {

/// A predicted (or measured) image with its depth, both camera.height x camera.width.
struct View {
    ImageF intensity;  ///< grey value in [0, 1], proportional to the stored 8-bit value
    ImageF depth;      ///< z of the surface in the camera frame [m]; 0: no surface, unknown
};

/// The 8-bit level of a grey value in [0, 1], as cameras and image files hold it: the nearest one.
inline std::uint8_t greyLevel(float grey) {
    return static_cast<std::uint8_t>(std::lrint(255.F * std::clamp(grey, 0.F, 1.F)));
}

/// A model of the world from which views can be rendered. Implementations: MeshRenderer,
/// VoxelRenderer, or your own.
class ViewSource {
  public:
    virtual ~ViewSource() = default;

    /// Predicts the noise-free, anti-aliased view from a camera pose; resizes `view` as needed.
    /// Thread-safe and deterministic: views from the same pose are bit-identical.
    virtual void render(const Camera& camera, const Pose& T_c_w, View& view) const = 0;
};

/// Whether a pixel, which is not at the border, and its four neighbours have depth.
inline bool hasDepthAround(const View& view, unsigned u, unsigned v) {
    const ImageF& d = view.depth;
    return d[v][u] > 0.F && d[v][u - 1] > 0.F && d[v][u + 1] > 0.F && d[v - 1][u] > 0.F &&
           d[v + 1][u] > 0.F;
}

/// Whether a recorded image is black, as with a covered lens: its mean grey value is below 0.02.
bool isBlack(const ImageF& image);

/// Applies the camera's point spread: a 3x3 binomial filter of the intensity. Edges become about
/// three pixels wide, so that central differences approximate their gradients. Every renderer does
/// this as its last step unless Camera::hasPointSpread is false. Pixels with an invalid neighbour
/// (depth 0) keep their value, the image is extrapolated linearly beyond its border, and a constant
/// image stays bit-identical.
/// @throws std::invalid_argument when intensity and depth differ in size
void applyPointSpread(View& view);

}  // namespace photonav
