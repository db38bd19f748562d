// SPDX-License-Identifier: BSD-3-Clause
// The share of a model's gradients that the image has as well: noise of a model that was made of
// images looks like texture, and a scene may have changed since the model was made.
#pragma once

#include <optional>
#include <vector>

#include "alignment/gradient_tile.hpp"
#include "geometry/constants.hpp"

namespace photonav {

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
struct SharedSlope {
    Matrix6 slope = Matrix6::Zero();  ///< M, of the left perturbation (rho, phi) of the camera pose
    double least = 0.;                ///< smallest value of kappa
};
SharedSlope sharedSlope(const std::vector<GradientTile>& tiles);

/// How much of the texture that a model predicts an image shows at the predicted pixels.
struct SharedTexture {
    double share = 0.;         ///< 1: all; 0: image and model are unrelated
    double sigma = kInfinity;  ///< standard deviation of `share` by the scatter of the tiles

    /// Whether the share is larger, or smaller, than a value by more than chance.
    bool isAbove(double value) const { return share - 2. * sigma > value; }
    bool isBelow(double value) const { return share + 2. * sigma < value; }
};

/// The regression of the image's gradients on the model's. Each tile in which the texture exceeds
/// the noise has the same weight, whatever its contrast. (The variance of the whole image is
/// explained by an object of high contrast, even if that has moved and everything else disagrees.)
/// @param sigma standard deviation of the image noise [grey value]
/// @param isModelNoisy tiles whose gradients may be noise as large as the images' are left out
/// @return none: no tile counts, or the share depends on a single one
std::optional<SharedTexture> sharedTexture(const std::vector<GradientTile>& tiles, double sigma,
                                           bool isModelNoisy);

}  // namespace photonav
