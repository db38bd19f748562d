// SPDX-License-Identifier: BSD-3-Clause
// The grid of poses within a prior at which a search compares views.
#pragma once

#include <vector>

#include "geometry/camera.hpp"
#include "geometry/types.hpp"

namespace photonav {

/// Largest standard deviation of a prior, as motion of the image, for which a single start suffices
/// [pixels].
inline constexpr double kBasinSigma = 6.;

/// Spacing of the views that a search compares, unless they would be too many [pixels].
inline constexpr double kSearchSpacing = 8.;

/// Spacing of the views that the search of a prior compares, as motion of the image [pixels]. The
/// number of views is limited, so that the spacing grows with a wide prior.
/// @param covariance of the prior, camera frame
/// @param depth mean depth of the view [m]
double searchSpacing(const Matrix6& covariance, const Camera& camera, double depth);

/// Largest spacing at which a search covers the prior [pixels]. With a larger one, the true pose
/// can be outside the basins of convergence of both neighbouring views.
inline constexpr double kWidestSearchSpacing = 2. * kBasinSigma;

/// Image motion over the uncertainty of a prior: principal axes [twist per pixel] and standard
/// deviations [pixels].
struct ImageMotion {
    Matrix6 axes;
    Vector6 sigmas;
};

/// @param covariance of the prior, camera frame
/// @param depth mean depth of the view [m]
ImageMotion imageMotionOf(const Matrix6& covariance, const Camera& camera, double depth);

/// Points of a grid within an ellipsoid, its centre included [pixels].
/// @param sigmas ImageMotion::sigmas
std::vector<Vector6> placesWithin(const Vector6& sigmas);

}  // namespace photonav
