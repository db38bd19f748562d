// SPDX-License-Identifier: BSD-3-Clause
// Images with captions, side by side.
#pragma once

#include <string>
#include <vector>

#include "geometry/types.hpp"
#include "photometry/view.hpp"
#include "plot/figure.hpp"

namespace photonav {

struct CaptionedImage {
    std::string caption;
    Picture picture;
};

inline constexpr Color kUnknownColor{24, 44, 92};  ///< colour of pixels without a value

/// A grey picture.
/// @param scale factor that maps the image's values to [0, 1]
Picture greyPicture(const ImageF& image, double scale = 1.);

/// A predicted view. Pixels without a surface have kUnknownColor.
Picture predictedPicture(const View& predicted);

/// Difference of grey values that has the brightest colour, in all figures and pages.
inline constexpr double kFullDifference = 0.25;

/// |predicted - observed| in the colours of viridis, up to kFullDifference. Pixels without a
/// predicted surface have kUnknownColor.
Picture differencePicture(const ImageF& observed, const View& predicted);

/// The contribution of each pixel (see contributionImage()) as colour over the darkened grey image.
/// Its square root is drawn, scaled to the 99.5th percentile, so that weak pixels remain visible.
/// @throws std::invalid_argument if the sizes differ or the images are empty
Picture contributionPicture(const ImageF& intensity, const ImageF& contribution);

/// A grey picture and a contributionPicture() with pixel axes and colour bars. Every pixel is drawn
/// as a square of a whole number of pixels.
/// @throws std::invalid_argument if the images are empty
Figure greyFigure(const std::string& title, const ImageF& image);
Figure contributionFigure(const std::string& title, const ImageF& intensity,
                          const ImageF& contribution);

/// Rows of images of equal width, with captions.
/// @param width width of an image [px]
/// @throws std::invalid_argument without images
Figure imagesFigure(const std::vector<std::vector<CaptionedImage>>& rows, double width = 480.);

}  // namespace photonav
