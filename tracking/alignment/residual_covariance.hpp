// SPDX-License-Identifier: BSD-3-Clause
// The covariance of an alignment from the scatter of its residuals, and from errors of the model
// that the residuals do not contain.
#pragma once

#include <optional>
#include <vector>

#include "alignment/repeating_errors.hpp"

namespace photonav {

/// The blocks of an image that was compared with a model.
struct ComparedBlocks {
    std::vector<ImageBlock> blocks;
    Camera camera;      ///< of the level at which they were compared
    Exposure exposure;  ///< at which they were compared
};

/// The information of an image about the pose: left perturbation, camera frame.
struct MeasuredInformation {
    PoseEquations
        equations;  ///< the information is 0 in directions that the image does not observe
    /// Part of the covariance that repeats from image to image; very large in such directions.
    Matrix6 repeating = Matrix6::Zero();
};

/// The information of an image by its residuals. With A_b and g_b the normal equations of block b
/// at the minimum, H = sum A_b, and x the step to the minimum of the image alone, the covariance is
///     C = n/(n-7) H^-1 (sum s_b s_b^T) H^-1 + C_repeating,  s_b = (1 - A_b H^-1)^-1 (g_b - A_b x).
/// This is the variance by leaving out one block at a time ("jackknife", the cluster-robust "CR3").
/// Blocks count as independent; the pixels of a block may be correlated. It follows from residuals
/// of any size and cause, and does not depend on an assumed image noise. Exposure and light field
/// (LightField) are eliminated first. A direction about which one block has at least nine tenths of
/// the information counts as not observed: such a block fits nearly exactly, wherever it leads.
/// Errors that repeat from image to image: scatterOfRepeatingErrors().
///
/// Blocks are not independent if an object has moved since the model was made: all of its blocks
/// lead to the same wrong pose. The pose is estimated a second time with weights by which every
/// textured block counts alike. A difference beyond chance is added to the covariance, as an error
/// that repeats.
/// @param prior of the exposure; none: the exposure is fixed
/// @param errors used in C_repeating
/// @param toModel motion T_c_k since the keyframe that is the model; identity for maps
MeasuredInformation measuredInformation(const ComparedBlocks& image,
                                        const PhotometricOptions& photometric,
                                        const std::optional<ExposurePrior>& prior,
                                        const ModelErrors& errors, const Pose& toModel);

/// Corrects the information by the slope M of measuredSlope(): the image responds to a displacement
/// x of the camera as J does to M x.
MeasuredInformation respondingBy(const Matrix6& M, const MeasuredInformation& image);

/// Combines two covariances: in the directions in which both are diagonal, takes the smaller
/// variance of each direction.
/// @param b positive definite
Matrix6 smaller(const Matrix6& a, const Matrix6& b);
/// As smaller(), with the larger variance of each direction.
Matrix6 larger(const Matrix6& a, const Matrix6& b);

/// Posterior covariance after an image. It is not reduced below the errors that repeat from image
/// to image: fused several times, they would otherwise seem to average out.
/// @param information of the image
/// @param repeating covariance of the errors that repeat, MeasuredInformation::repeating
Matrix6 posteriorCovariance(const Matrix6& prior, const Matrix6& information,
                            const Matrix6& repeating);

}  // namespace photonav
