// SPDX-License-Identifier: BSD-3-Clause
// How well a map predicts the images it was made from.
#pragma once

#include <optional>

#include "alignment/normal_equations.hpp"
#include "photometry/view.hpp"

namespace photonav {

/// Differences of a predicted and an observed view, over the pixels where both are known.
struct ViewDifference {
    // These three: none where nothing is predicted.
    std::optional<double> meanIntensity;    ///< mean absolute, grey values in [0, 1]
    std::optional<double> medianIntensity;  ///< median absolute
    std::optional<double>
        contrast;  ///< mean absolute deviation of the observed image from its median over
                   ///< the same pixels: what predicting the best uniform grey would cost
    std::optional<double> meanDepth;    ///< mean absolute [m]; none without observed depth
    std::optional<double> medianDepth;  ///< median absolute [m]
    double predicted = 0.;              ///< fraction of all pixels at which the map has a surface
};

/// A predicted image with the gain and offset of an observed one, to be compared with it.
void expose(ImageF& predicted, const Exposure& exposure);

/// @throws std::invalid_argument unless both views have the same size
ViewDifference compareViews(const View& observed, const View& predicted);

}  // namespace photonav
