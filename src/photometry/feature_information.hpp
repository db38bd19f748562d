// SPDX-License-Identifier: BSD-3-Clause
// Information models for a camera that tracks corners: baselines to the photometric model.
#pragma once

#include <vector>

#include "photometry/view.hpp"

namespace photonav {

struct FeatureOptions {
    double threshold = 0.02;  ///< threshold of the FAST detector: least difference between a corner
                              ///< and the circle around it, grey values in [0, 1]
    double pixelSigma = 1.;   ///< standard deviation of a tracked corner, each axis [px]
    double referenceCount = 10;  ///< number of corners at which featurePenalty() is 1/2
};

/// A corner of a view: pixel and depth of its surface in the camera frame [m].
struct Feature {
    double u = 0., v = 0., depth = 0.;
};

/// FAST corners (9 of 16 pixels, non-maximum suppression; Rosten and Drummond 2006) that lie on a
/// surface. A straight edge has none, however strong.
std::vector<Feature> visibleFeatures(const View& view, const FeatureOptions& options = {});

/// Fisher information of the camera pose from the corners' reprojection errors, camera frame, left
/// perturbation (rho, phi), known map:
///     Lambda = 1 / pixelSigma^2 * sum J^T J,   J = d pi / d p * [1 | -p^]   (2x6)
/// This is the pose's part of the bundle adjustment by which Achtelik, Lynen, Weiss, Chli and
/// Siegwart (Motion- and uncertainty-aware path planning for micro aerial vehicles, 2014) evaluate
/// a view.
Matrix6 reprojectionInformation(const std::vector<Feature>& features, const Camera& camera,
                                const FeatureOptions& options = {});

/// Penalty in (0, 1] of a view with `count` corners: 1 / (1 + count / referenceCount).
/// Sadat, Chutskoff, Jungic, Wawerla and Vaughan (Feature-rich path planning for robust navigation
/// of MAVs with mono-SLAM, 2014) score a view by the number of its features; how the score enters a
/// cost per metre is our choice: decreasing, convex, finite without features.
double featurePenalty(std::size_t count, const FeatureOptions& options = {});

}  // namespace photonav
