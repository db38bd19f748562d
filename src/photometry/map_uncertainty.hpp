// SPDX-License-Identifier: BSD-3-Clause
// How much a motion past a view reduces the uncertainty of the *map*: the objective of active
// reconstruction, a baseline to planning for the uncertainty of the pose.
#pragma once

#include "photometry/photometric.hpp"

namespace photonav {

struct MapUncertaintyOptions {
    /// Standard deviation of log depth before the view: its order of magnitude is known.
    double priorSigma = 1.;
    double baseline = 0.25;  ///< distance between the two images that a depth is measured from [m]
    int stride = 2;          ///< use every stride-th row and column
};

/// How well a short motion measures the depths of the visible surfaces.
struct MapCertainty {
    double share = 0.;  ///< share of the pixels whose depth a motion can measure: motion along the
                        ///< gradient of such a pixel would at least halve the variance of its depth
    Eigen::Matrix3d gain = Eigen::Matrix3d::Zero();  ///< mean over these pixels (see below)

    /// Mean variance of log depth over the image after a motion along the unit vector t (camera
    /// frame), divided by the variance of the prior: 1 if nothing is measured.
    double remainingVariance(const Eigen::Vector3d& t_c) const {
        return 1. - share + share / (1. + t_c.dot(gain * t_c));
    }
};

/// Per pixel, with j = grad I^T dpi/dp (1x3) the response of its grey value to translation, log
/// depth is measured from two images `baseline` apart with information (baseline j t)^2 /
/// (2 sigma^2), so that 1 / (1 + t^T G t) of the prior's variance is left,
///     G = priorSigma^2 baseline^2 / (2 sigma^2) * j^T j:
/// parallax times the gradient along the epipolar line, over the noise of two images. Pixels with
/// tr G >= 1 count, by their mean G; all others (no texture, no surface, a depth discontinuity)
/// stay as uncertain as they were.
///
/// This is the objective of Forster, Pizzoli and Scaramuzza, Appearance-based active, monocular,
/// dense reconstruction for micro aerial vehicles (RSS 2014): the expected variance of the depth
/// given texture and motion. They carry a depth filter per pixel along a trajectory; here every
/// view is evaluated on its own, with the same prior, so that it can be a cost per metre.
MapCertainty mapCertainty(const View& view, const Camera& camera,
                          const PhotometricOptions& photometric = {},
                          const MapUncertaintyOptions& options = {});

}  // namespace photonav
