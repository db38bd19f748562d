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

inline constexpr Color kUnknownColor{24, 44, 92};  ///< of pixels without a value

/// @param scale of the image's values to [0, 1]
Picture greyPicture(const ImageF& image, double scale = 1.);

/// A predicted view; pixels without a surface in kUnknownColor.
Picture predictedPicture(const View& predicted);

/// |predicted - observed| in viridis, pixels without a predicted surface in kUnknownColor.
/// @param full difference of grey values that is drawn in the brightest colour
Picture differencePicture(const ImageF& observed, const View& predicted, double full);

/// The contribution of each pixel (see contributionImage()) as colour over the dimmed grey image.
/// The square root is drawn, scaled to its 99.5th percentile: weak pixels stay visible.
/// @throws std::invalid_argument if the sizes differ or the images are empty
Picture contributionPicture(const ImageF& intensity, const ImageF& contribution);

/// All images of equal width, in rows.
/// @param width of one image [px]
/// @throws std::invalid_argument without images
Figure imagesFigure(const std::vector<std::vector<CaptionedImage>>& rows, double width = 480.);

}  // namespace photonav
