// SPDX-License-Identifier: BSD-3-Clause
// The dense photometric Jacobian of a view and its Fisher information.
#pragma once

#include "photometry/view.hpp"

namespace photonav {

/// How the image gradient at a pixel is computed.
enum class GradientStencil {
    central,  ///< central differences over three pixels, for views with a point spread
    square    ///< differences over the square of 2 x 2 pixels to the right and below, valid at its
              ///< centre; half as wide, for views without a point spread
};

struct PhotometricOptions {
    double sigma = 0.02;  ///< standard deviation of the image noise, grey values in [0, 1]
    double scale = 1.0;   ///< factor on the information, because neighbouring pixels are correlated
    int stride = 1;       ///< use every stride-th row and column, scaled by stride^2
    double depthJump = 0.05;   ///< relative second difference of inverse depth that is an occlusion
    double saturation = 1e-3;  ///< grey values within this of 0 or 1 are saturated: such a pixel
                               ///< does not respond to motion and is left out
    GradientStencil gradient = GradientStencil::central;
};

/// Fisher information of the camera pose from one view, in the camera frame, for the left
/// perturbation T_c_w = exp(xi^) mean:
///     Lambda = scale / sigma^2 * sum J^T J,   J = grad I * dpi/dp * [1 | -p^]
/// (the paper's eqs. (19) and (20)). The gradient is the gradient of the predicted image
/// (`options.gradient`); a border of one pixel is left out. A pixel is used if it and its four
/// neighbours have depth, none of them lies across a depth discontinuity, and it is not saturated.
/// Nothing is stored per pixel. Sums are single precision within 16 rows and double across them,
/// with rotations about a point in view, so that the trace of the inverse is accurate to six
/// digits.
Matrix6 photometricInformation(const View& view, const Camera& camera,
                               const PhotometricOptions& options = {});

/// The row J of one pixel; zero if the pixel is not used. For single pixels:
/// photometricInformation() sums over a view several times faster.
Vector6 pixelJacobian(const View& view, const Camera& camera, unsigned u, unsigned v,
                      const PhotometricOptions& options = {});

/// Contribution of every pixel to the information about a direction d: (J d)^2 * scale / sigma^2
/// per pixel. The image sums to d^T Lambda d (stride 1).
/// @param direction twist (rho, phi) in the camera frame, for example Vector6::Unit(0)
ImageF contributionImage(const View& view, const Camera& camera, const Vector6& direction,
                         const PhotometricOptions& options = {});

/// Sum over all six directions, rotations weighted by the mean depth so that units agree [1/m^2].
ImageF contributionImage(const View& view, const Camera& camera,
                         const PhotometricOptions& options = {});

}  // namespace photonav
