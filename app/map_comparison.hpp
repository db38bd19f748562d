// SPDX-License-Identifier: BSD-3-Clause
// How well a map predicts the images it was made from.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "canvas.hpp"
#include "view.hpp"

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

/// @throws std::invalid_argument unless both views have the same size
ViewDifference compareViews(const View& observed, const View& predicted);

/// A picture on a sheet, with what it is.
struct Panel {
    std::string caption;
    std::vector<Color> pixels;  ///< row by row
    int columns = 0;
};

inline constexpr Color kNothingKnown{24, 44, 92};  ///< of pixels of which nothing can be said

/// An image as it is.
Panel imagePanel(const ImageF& image, const std::string& caption);

/// A predicted view; where nothing is predicted, the picture is blue.
Panel predictedPanel(const View& predicted, const std::string& caption);

/// Observed, predicted and absolute difference.
/// @param caption what this view is, for the first picture
std::vector<Panel> comparisonPanels(const View& observed, const View& predicted,
                                    const std::string& caption);

/// All panels of equal width, in rows.
/// @param width of one panel [pixels]
Png panelsPng(const std::vector<std::vector<Panel>>& rows, double width = 480.);

}  // namespace photonav
