// SPDX-License-Identifier: BSD-3-Clause
// Disparities to a small fraction of a pixel, by least squares.
#pragma once

#include <opencv2/core.hpp>

namespace photonav {

/// A disparity whose block has less texture than fixes it to this standard deviation may as well be
/// that of the next pixel, and is none [pixels].
inline constexpr double kMostDisparitySigma = 1.;

/// Refines the disparities of two rectified images by least squares (B. Lucas, T. Kanade, An
/// Iterative Image Registration Technique, 1981). In a block the disparity is a linear function
/// D(u, v) of the pixel: the one that minimises the squared differences between the left image and
/// the right one moved by D, but for an offset between the two. The disparity of the middle pixel
/// is D there: on a slanted surface, too, it does not depend on where in the block the texture is.
/// The contrast of the images may differ by a factor, which is that of all matched pixels.
/// @param left,right CV_32F, of the same size
/// @param block edge of a block, odd [pixels]
/// @param noise standard deviation of the images' noise, above 0, in the unit of their grey values
/// @param[in,out] disparity CV_32F [pixels]: found by matching, right to a pixel, 0 where there is
///        none. Afterwards refined; 0 where that would be more than a pixel away, or where the
///        block's texture does not determine it (kMostDisparitySigma)
void refineDisparities(const cv::Mat& left, const cv::Mat& right, int block, double noise,
                       cv::Mat& disparity);

}  // namespace photonav
