// SPDX-License-Identifier: BSD-3-Clause
// The covariance of an alignment from the scatter of its residuals, and from errors of the model
// that residuals do not show.
#pragma once

#include <optional>
#include <vector>

#include "alignment/alignment.hpp"

namespace photonav {

/// Standard deviations of errors that repeat from image to image: the pose absorbs them, so that no
/// residual shows them, and no number of images averages them out.
struct ModelErrors {
    /// Of the image's content, smooth over the image: what calibration leaves of the distortion of
    /// a lens, and how rendered views differ from what a sensor averages [pixels].
    double displacement = 0.05;
    /// Of the variance by which images are blurrier than rendered views; eliminated as the exposure
    /// is (withoutBlur()), and smooth over the image where it is not the same everywhere
    /// [pixels^2].
    double blur = 0.;
    double surface = 0.;     ///< of the surfaces along their normals [m]
    double depthScale = 0.;  ///< relative, of a depth sensor's scale and registration
};

/// The information of an image about the pose: left perturbation, camera frame.
struct MeasuredInformation {
    PoseEquations equations;  ///< information 0 in directions that the image leaves open
    /// Part of the covariance that repeats from image to image; very large in open directions.
    Matrix6 repeating = Matrix6::Zero();
};

/// With A_b and g_b the normal equations of block b at the minimum, H = sum A_b, and x the step to
/// the minimum of the image alone,
///     C = H^-1 (sum s_b s_b^T) H^-1 + C_repeating,   s_b = (1 - A_b H^-1)^-1 (g_b - A_b x).
/// This is the variance by leaving out one block at a time ("jackknife", the cluster-robust "CR3"):
/// blocks count as independent, the pixels of a block need not be. It follows from the residuals,
/// however large they are and whatever they come from, and needs no noise of the image. The
/// exposure is eliminated first.
///
/// A gain that varies slowly over the image (vignetting, shading, another light) repeats from image
/// to image. Its variance is what the gains of neighbouring blocks have in common.
/// @param prior of the exposure; none: the exposure is fixed
/// @param camera of the comparison
/// @param toModel motion since the model's own image, whose depth it has (keyframes); else identity
MeasuredInformation measuredInformation(const std::vector<ImageBlock>& blocks,
                                        const PhotometricOptions& photometric,
                                        const std::optional<ExposurePrior>& prior,
                                        const ModelErrors& errors, const Camera& camera,
                                        const Pose& toModel);

/// The same when the image responds to a displacement x as J does to M x (measuredSlope()).
MeasuredInformation respondingBy(const Matrix6& M, const MeasuredInformation& image);

/// In the directions in which both covariances are diagonal, the smaller variance of each.
/// @param b positive definite
Matrix6 smaller(const Matrix6& a, const Matrix6& b);
/// The larger variance of each.
Matrix6 larger(const Matrix6& a, const Matrix6& b);

/// Posterior covariance. An image never makes a belief better than its repeating errors allow:
/// fused again and again, they would seem to average out.
Matrix6 posteriorCovariance(const Matrix6& prior, const Matrix6& information,
                            const Matrix6& repeating);

}  // namespace photonav
