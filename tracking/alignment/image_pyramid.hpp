// SPDX-License-Identifier: BSD-3-Clause
// Images at half the size, and half of that.
#pragma once

#include <vector>

#include "geometry/camera.hpp"
#include "render/area_sensor.hpp"

namespace photonav {

inline constexpr unsigned kMinSide = 12;  ///< pixels: smaller images get no level

/// The camera of halved(): pixel (u, v) covers pixels 2u, 2u + 1, 2v, 2v + 1; an odd last row or
/// column is dropped.
Camera halved(const Camera& camera);

/// Point spread of rendered views, standard deviation [pixels]: that of applyPointSpread(), and
/// about a pixel's area again by the interpolation of textures (measured against AreaSensor).
inline constexpr double kRenderedBlur = 0.7638;

/// The image with its point spread widened. A kernel of 3 x 3 pixels; borders repeat.
/// @param variance of the additional spread [pixels^2], at most 0.5: more is taken as that
ImageF widened(const ImageF& image, double variance);

/// Standard deviation of noise after widened(), by that before. Noise correlated over an area of
/// 1 / scale pixels, as if it had been smoothed by a Gaussian, loses less than white noise.
double noiseAfterWidening(double variance, double scale);

/// Mean square of what an image shows finer than a map's cells, noise included. The texture of
/// cells, means over their area interpolated between their centres, is that of the surface smoothed
/// with variance 1/12 + 1/6 of the squared edge.
/// @param cellSize edge [m]; 0: no cells, of which nothing is finer
/// @param depth mean depth of the view [m]
double finerThan(double cellSize, double depth, const Camera& camera, const ImageF& image);

/// Half the size with the sharpness of a view rendered at that size: the binomial filter of 8 taps
/// (variance 7/4) turns the point spread of the large image (variance 1/2 of its pixels) into pixel
/// average and point spread of the small one (variance 1/4 + 4 * 1/2). Borders repeat.
ImageF halvedAsRendered(const ImageF& image);

/// Point spread of halvedAsRendered(), standard deviation [its pixels], by that of the large image
/// [its pixels]. kRenderedBlur stays kRenderedBlur.
double blurAfterHalving(double blur);

}  // namespace photonav
