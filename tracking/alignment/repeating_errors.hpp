// SPDX-License-Identifier: BSD-3-Clause
// Errors of the model that repeat from image to image, and their effect on an alignment.
#pragma once

#include <vector>

#include "alignment/alignment.hpp"

namespace photonav {

class LightField;

/// Standard deviations of errors that repeat from image to image. The pose absorbs them, so that
/// they do not appear in the residuals, and they do not average out over many images.
struct ModelErrors {
    /// Displacement of the image content, smooth over the image: remaining lens distortion after
    /// calibration, and the difference between rendered views and the average over a sensor's
    /// pixels [pixels].
    double displacement = 0.05;
    /// Additional variance of the images' point spread compared with rendered views [pixels^2]. Its
    /// mean over the image is eliminated like the exposure (withoutBlur()); its variation over the
    /// image is smooth.
    double blur = 0.;
    /// Gain that varies slowly over the image: vignetting, and light that is not the model's. It is
    /// estimated with the pose (LightField) if the covariance is measured; this is its prior's
    /// standard deviation [share of the light at the edge of the image].
    double light = 0.;
    double surface = 0.;     ///< displacement of the surfaces along their normals [m]
    double depthScale = 0.;  ///< relative error of a depth sensor's scale and registration
};

/// Covariance of a motion whose translation and rotation are wrong by a share of their lengths, in
/// any direction (ModelErrors::depthScale).
Matrix6 covarianceByScale(double share, const Pose& motion);

/// Effect of all errors that repeat but for ModelErrors::depthScale: covariance of the sum of the
/// blocks' Atr.
///
/// Shading that the light field does not follow repeats, too. Its variance is estimated by the
/// covariance of the gains of neighbouring blocks.
/// @param blocks of the image, the light field not eliminated
/// @param light the field that was fitted to them: errors that it explains do no harm
/// @param x the step to the minimum of the image alone: pose (left perturbation), gain, bias
/// @param camera camera of the level at which the blocks were compared
Matrix8 scatterOfRepeatingErrors(const std::vector<ImageBlock>& blocks, const LightField& light,
                                 const Vector8& x, const ModelErrors& errors, const Camera& camera);

}  // namespace photonav
