// SPDX-License-Identifier: BSD-3-Clause
// Image pyramids: images at half the size, and the point spread at each level.
#pragma once

#include <vector>

#include "geometry/camera.hpp"
#include "render/area_sensor.hpp"

namespace photonav {

/// Least width and height of a level of a pyramid [pixels].
inline constexpr unsigned kMinSide = 12;

/// The camera of an image at half the size: pixel (u, v) covers columns 2u, 2u + 1 and rows 2v, 2v
/// + 1; an odd last row or column is dropped.
Camera halved(const Camera& camera);

/// Point spread of rendered views, standard deviation [pixels]: the spread of applyPointSpread(),
/// and about the area of a pixel by the interpolation of textures (measured against AreaSensor).
inline constexpr double kRenderedBlur = 0.7638;

/// Widens the point spread of an image by kernels of 3 x 3 pixels, as many as it takes; borders
/// repeat.
/// @param variance of the additional spread [pixels^2]; the image stays as it is below 0
ImageF widened(const ImageF& image, double variance);

/// Standard deviation of noise after widened(), divided by that before. Correlated noise is reduced
/// less than white noise.
/// @param variance of the additional spread [pixels^2]
/// @param scale inverse of the area over which the noise is correlated [1/pixels], as if it had
///        been smoothed by a Gaussian; see PhotometricOptions::scale
double noiseAfterWidening(double variance, double scale);

/// Mean square of the image content that is finer than a map's cells, noise included [grey
/// value^2]. The texture of cells (means over their area, interpolated between their centres) is
/// the texture of the surface, smoothed with variance 1/12 + 1/6 of the squared edge.
/// @param cellSize edge of a cell [m]; 0: no cells, and the result is 0
/// @param depth mean depth of the view [m]
double finerThan(double cellSize, double depth, const Camera& camera, const ImageF& image);

/// The image at half the size, as sharp as a view rendered at that size. The binomial filter of 8
/// taps (variance 7/4) turns the point spread of the large image (variance 1/2 of its pixels) into
/// pixel average and point spread of the small one (variance 1/4 + 4 * 1/2). Borders repeat.
ImageF halvedAsRendered(const ImageF& image);

/// Point spread after halvedAsRendered(), standard deviation [pixels of the small image].
/// kRenderedBlur stays kRenderedBlur.
/// @param blur point spread of the large image, standard deviation [pixels of the large image]
double blurAfterHalving(double blur);
/// The inverse, for variances: point spread before halvedAsRendered() [pixels^2 of the large
/// image]. Negative for an image sharper than one can be after halving.
/// @param variance point spread of the small image [pixels^2 of the small image]
double blurVarianceBeforeHalving(double variance);

}  // namespace photonav
