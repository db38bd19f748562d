// SPDX-License-Identifier: BSD-3-Clause
// Calibrates the covariances of alignments: fits the scale of the information and least standard
// deviations to recorded errors.
#pragma once

#include <optional>
#include <span>

#include "alignment/alignment.hpp"
#include "alignment/coarse_to_fine.hpp"

namespace photonav {

/// The error of one alignment with known ground truth.
struct AlignmentError {
    Vector6 xi = Vector6::Zero();           ///< deviation() of the true pose from the estimate
    Matrix6 information = Matrix6::Zero();  ///< of the image, with scale 1; of full rank
    Pose sinceKeyframe = Pose::Identity();  ///< T_c_k, for alignments to a keyframe
};

/// NEES per degree of freedom, mean over the samples: 1 if covariances are consistent, larger if
/// they are overconfident.
/// @param scale factor on every information matrix
/// @param leastSigma,leastSigmaRotation see Calibration
double neesPerDof(std::span<const AlignmentError> errors, double scale = 1., double leastSigma = 0.,
                  double leastSigmaRotation = 0.);

struct Calibration {
    double scale = 1.;               ///< for AlignmentOptions::informationScale
    double leastSigma = 0.;          ///< for TrustOptions [m]; 0 where the errors need none
    double leastSigmaRotation = 0.;  ///< [rad]
    /// Number of consecutive images whose errors are correlated: the integrated autocorrelation of
    /// the whitened errors, 1 when every image errs in its own way. A filter that averages images
    /// must divide the scale by it. (calibrateLeastSigma does not measure it.)
    double correlationTime = 1.;
    /// neesPerDof() without least sigmas and with scale 1 (by calibrateLeastSigma(): with its
    /// scale).
    double neesBefore = 0.;
    double neesAfter = 0.;  ///< neesPerDof() with this calibration
};

/// The scale and the least sigmas of maximum likelihood for Gaussian errors. If a scale alone is
/// nearly as likely, the least sigmas are 0.
/// @param errors in the order of the images
/// @throws std::invalid_argument below 20 samples
Calibration calibrate(std::span<const AlignmentError> errors);

/// The least sigmas of maximum likelihood with a given scale. For maps of cells, whose errors
/// repeat from image to image: if a scale accounted for them, a filter would average them out over
/// several images.
/// @throws std::invalid_argument below 20 samples
Calibration calibrateLeastSigma(std::span<const AlignmentError> errors, double scale);

/// The relative error of depth (ModelErrors::depthScale) of maximum likelihood, for alignments to
/// keyframes: what depth gets wrong shows as an error in proportion to the motion.
/// @param counted the relative error that the information of `errors` contains
/// @return in [0, 1]; nothing if the information of an error is smaller than `counted` allows
/// @throws std::invalid_argument below 20 samples
std::optional<double> calibrateDepthError(std::span<const AlignmentError> errors, double counted);

/// By how much rendered views of textures, with texels from 0.15 to 3 pixels wide, are sharper than
/// AreaSensor's with the point spread added: 0.04 to 0.11, root mean square over poses [pixels^2].
inline constexpr double kBlurError = 0.1;

/// Standard deviation of each term of the gain over an image (ModelErrors::light): a few percent of
/// the light, as a correction leaves of a lens's vignetting. Over a whole image the pixels decide:
/// with 0.1 poses are the same. Where the model covers a small part of the image, the field cannot
/// be told from the pose, and this says how far the pose may follow it.
inline constexpr double kLightError = 0.03;

/// Options for images that were not rendered from the model: covariances follow from the residuals.
/// @param blur point spread of the images, standard deviation [pixels]
AlignmentOptions photographOptions(double blur = kAreaBlur);

/// As photographOptions(), for a camera with automatic exposure: gain and offset are estimated.
AlignmentOptions realCameraOptions(double blur = kAreaBlur);

}  // namespace photonav
