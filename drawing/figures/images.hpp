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

/// |predicted - observed| in the colours of viridis. Pixels without a predicted surface have
/// kUnknownColor.
/// @param full difference of grey values that has the brightest colour
Picture differencePicture(const ImageF& observed, const View& predicted, double full);

/// The contribution of each pixel (see contributionImage()) as colour over the darkened grey image.
/// Its square root is drawn, scaled to the 99.5th percentile, so that weak pixels remain visible.
/// @throws std::invalid_argument if the sizes differ or the images are empty
Picture contributionPicture(const ImageF& intensity, const ImageF& contribution);

/// Rows of images of equal width, with captions.
/// @param width width of an image [px]
/// @throws std::invalid_argument without images
Figure imagesFigure(const std::vector<std::vector<CaptionedImage>>& rows, double width = 480.);

}  // namespace photonav
