// SPDX-License-Identifier: BSD-3-Clause
// The share of a model's gradients that the image has as well. A model that was made of images
// contains their noise, whose gradients look like texture.
#pragma once

#include <vector>

#include "geometry/types.hpp"

namespace photonav {

/// Sums of gradients over a tile of the image. A tile is so small that a motion of the camera moves
/// all of its pixels by the same vector.
struct GradientTile {
    double x = 0., y = 0.;                            ///< centre, normalised coordinates
    double inverseDepth = 0.;                         ///< mean [1/m]
    Eigen::Matrix2d model = Eigen::Matrix2d::Zero();  ///< sum of g g^T, g gradient of the model
    /// Symmetric part of the sum of g o^T, o gradient of the image.
    Eigen::Matrix2d shared = Eigen::Matrix2d::Zero();
};

/// The slope M of the image relative to the model: the image responds to a displacement x of the
/// camera as the model's J does to M x,
///     M = (J^T J)^-1 J^T J_o,
/// where J_o has the gradients of the image. The noises of model and image are independent, so that
/// J^T J_o is the sum over the texture alone for any variance of the noise, which may differ from
/// pixel to pixel (method of instrumental variables). In the directions v that are conjugate in
/// both matrices M is diagonal, with the values kappa = v^T J^T J_o v / v^T J^T J v. With s^2 the
/// variance of kappa by the scatter of the tiles, kappa is replaced by
///     kappa - (z s)^2 / kappa,   z = 3,
/// so that noise has no response at all and texture loses next to nothing. It is limited to 1,
/// because images are sharper than maps.
/// @return M; rows and columns refer to the left perturbation (rho, phi) of the camera pose
Matrix6 sharedSlope(const std::vector<GradientTile>& tiles);

}  // namespace photonav
