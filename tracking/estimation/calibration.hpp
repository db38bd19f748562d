// SPDX-License-Identifier: BSD-3-Clause
// The scale of the information and the least standard deviations that fit recorded errors.
#pragma once

#include <span>

#include "alignment/alignment.hpp"
#include "alignment/coarse_to_fine.hpp"

namespace photonav {

/// One alignment whose truth is known.
struct AlignmentError {
    Vector6 xi = Vector6::Zero();           ///< deviation() of the true pose from the estimated
    Matrix6 information = Matrix6::Zero();  ///< with factor 1, full rank
};

/// NEES per degree of freedom, mean over the samples: 1 when covariances are consistent, above when
/// they are overconfident.
/// @param scale factor on every information matrix
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
    double neesBefore = 0.;  ///< per degree of freedom, without least sigmas and with scale 1
                             ///< (calibrateLeastSigma: the scale)
    double neesAfter = 0.;
};

/// The scale and the least sigmas under which the errors are most likely (Gaussian). When a scale
/// alone is nearly as likely, the least sigmas are 0.
/// @param errors in the order of the images
/// @throws std::invalid_argument below 20 samples
Calibration calibrate(std::span<const AlignmentError> errors);

/// The least sigmas alone, with this scale: for maps of cells, whose errors repeat from image to
/// image, so that a scale which describes one alignment would be averaged away by the next.
/// @throws std::invalid_argument below 20 samples
Calibration calibrateLeastSigma(std::span<const AlignmentError> errors, double scale);

/// Options for images that the model did not make: covariances follow from their residuals.
/// @param blur point spread of the images, standard deviation [pixels]
AlignmentOptions photographOptions(double blur = kAreaBlur);

/// The same for a camera with automatic exposure, which is estimated.
AlignmentOptions realCameraOptions(double blur = kAreaBlur);

}  // namespace photonav
