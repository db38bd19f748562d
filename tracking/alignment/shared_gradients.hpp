// SPDX-License-Identifier: BSD-3-Clause
// Which of a model's gradients the image has as well. A model that is made of images has their
// noise, whose gradients look like texture.
#pragma once

#include <vector>

#include "geometry/types.hpp"

namespace photonav {

/// Sums over a tile of the image, small enough that a motion of the camera moves all of its pixels
/// alike.
struct GradientTile {
    double x = 0., y = 0.;                             ///< centre, normalised coordinates
    double inverseDepth = 0.;                          ///< mean [1/m]
    Eigen::Matrix2d model = Eigen::Matrix2d::Zero();   ///< g g^T, of the model's gradients
    Eigen::Matrix2d shared = Eigen::Matrix2d::Zero();  ///< symmetric part of g o^T, o the image's
};

/// The image responds to a displacement x of the camera as the model's J does to M x:
///     M = (J^T J)^-1 J^T J_o,
/// J_o by the gradients of the image. Noise of model and image is independent, so that J^T J_o is
/// the sum over the texture alone, whatever the variance of the noise, which may differ from pixel
/// to pixel (the method of instrumental variables). In the directions v that are conjugate in both
/// matrices M is diagonal. There kappa = v^T J^T J_o v / v^T J^T J v is limited to 1 (images are
/// sharper than maps), and to what chance does not give: with its variance s^2, by the scatter of
/// the tiles,
///     kappa - (z s)^2 / kappa,   z = 3,
/// so that noise has no response at all, and texture loses next to nothing.
/// @return M; xi of the columns is the left perturbation of the camera's pose
Matrix6 sharedSlope(const std::vector<GradientTile>& tiles);

}  // namespace photonav
