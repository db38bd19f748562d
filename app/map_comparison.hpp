// SPDX-License-Identifier: BSD-3-Clause
// How well a map predicts the images it was made from.
#pragma once

#include <string>

#include "pictures.hpp"
#include "view.hpp"

namespace photonav {

/// Differences of a predicted and an observed view, over the pixels where both are known.
struct ViewDifference {
    double meanIntensity = 0.;    ///< mean absolute, grey values in [0, 1]
    double medianIntensity = 0.;  ///< median absolute
    double contrast = 0.;   ///< mean absolute deviation of the observed image from its median over
                            ///< the same pixels: what predicting the best uniform grey would cost
    double meanDepth = 0.;  ///< mean absolute [m]
    double medianDepth = 0.;  ///< median absolute [m]
    double predicted = 0.;    ///< fraction of all pixels at which the map has a surface
};

/// @throws std::invalid_argument unless both views have the same size
ViewDifference compareViews(const View& observed, const View& predicted);

/// Observed, predicted and absolute difference side by side, each with its caption. Where nothing
/// is predicted, the picture is blue.
/// @param caption what this view is, for the first picture
Png comparisonPng(const View& observed, const View& predicted, const std::string& caption);

}  // namespace photonav
