// SPDX-License-Identifier: BSD-3-Clause
// How much of a view's information does not come from how edges are sampled.
#pragma once

#include <vector>

#include "alignment/gradient_tile.hpp"
#include "geometry/camera.hpp"

namespace photonav {

/// A camera at the same pose, whose pixels lie half a pixel to the left of and a quarter above
/// those of the given one. Most edges jump at other places there.
Camera betweenPixels(const Camera& camera);

/// The image of betweenPixels(), interpolated at the pixels of the given camera. The last row and
/// column are repeated.
ImageF atPixels(const ImageF& between);

/// The certain share of a view's information about the pose, in the direction in which it is
/// smallest. If the camera moves along a straight edge, the image does not change. But an edge of
/// cells jumps from pixel to pixel, and sampled gradients are not exactly across it, as if there
/// were some texture along it.
/// - The view is rendered again by betweenPixels(), and interpolated by atPixels(). Texture has the
///   same gradients in both views, but jumps are elsewhere. So the information is J^T J_r, where
///   J_r has the gradients of the second view (method of instrumental variables, as in
///   sharedSlope()).
/// - Along smooth edges both views have the same small gradients. Over the tiles that an edge
///   crosses, their squares add up to at most 3.4 % of the larger eigenvalues of sum g g^T,
///   however oblique the edge is. So 4 % of the larger eigenvalue of every tile is subtracted, in
///   all directions.
/// What is left is called certain.
/// @param tiles of the view, and of the second view as the image
/// @return in [0, 1]; 0 if there is a direction without information
double certainShare(const std::vector<GradientTile>& tiles);

}  // namespace photonav
