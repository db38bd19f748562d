// SPDX-License-Identifier: BSD-3-Clause
// What a motion past a view is worth to the *map*: the objective of active reconstruction, beside
// the pose uncertainty that this project plans for.
#pragma once

#include "photometric.hpp"

namespace photonav {

struct MapUncertaintyOptions {
    double priorSigma =
        0.3;                 ///< standard deviation of log depth before the look: 30 % of the depth
    double baseline = 0.25;  ///< way between the two images that a depth is measured from [m]
};

/// What fraction of the map's variance in sight a short motion takes away, for any direction of it:
/// flying along the unit vector t (camera frame) leaves 1 - t^T M t.
///
/// Per pixel, with j = grad I^T dpi/dp (1x3) the response of its grey value to translation, the
/// log depth is measured from two images `baseline` apart with information q = (baseline j t)^2 /
/// (2 sigma^2), so that 1 / (1 + priorSigma^2 q) of its variance is left: parallax times the
/// gradient along the epipolar line, over the noise of two images. The sum over pixels is kept as
/// one matrix by interpolating each of them in cos^2 of the angle between t and j:
///     M = 1/n sum g / (1 + g) u u^T,   g = priorSigma^2 baseline^2 |j|^2 / (2 sigma^2),
///     u = j / |j|,
/// exact along and across the gradient, and too pessimistic in between. n counts all pixels of the
/// image: what has no texture, no surface, or lies across a depth discontinuity stays uncertain.
///
/// This is the objective of Forster, Pizzoli and Scaramuzza, Appearance-based active, monocular,
/// dense reconstruction for micro aerial vehicles (RSS 2014): the expected variance of the depth
/// given texture and motion. They carry a depth filter per pixel along a trajectory; here every
/// view is judged on its own, against the same prior, so that it can be a cost per metre.
Eigen::Matrix3d mapCertainty(const View& view, const Camera& camera,
                             const PhotometricOptions& photometric = {},
                             const MapUncertaintyOptions& options = {});

}  // namespace photonav
