// SPDX-License-Identifier: BSD-3-Clause
// The noise of a real camera, and of a real depth sensor.
#pragma once

#include <random>

#include "alignment/normal_equations.hpp"
#include "photometry/view.hpp"

namespace photonav {

/// Defaults: a small machine-vision camera indoors.
struct CameraNoiseOptions {
    double blur = 0.4;  ///< standard deviation of defocus, on top of the point spread [pixels]
    double vignetting = 0.03;         ///< share of the light lost in the corners, after correction
    Exposure exposure;                ///< gain and offset against the exposure of the model
    double electronsAtWhite = 5000.;  ///< signal of grey value 1, for the Poisson noise
    double readNoise = 10.;           ///< standard deviation [electrons]
    int bits = 8;                     ///< of the converter; 0: not quantised
};

/// The image that a camera makes of an ideal one: blurred, vignetted, exposed, with shot and read
/// noise, clipped to [0, 1] and quantised, in this order.
ImageF takePicture(const ImageF& ideal, const CameraNoiseOptions& options, std::mt19937_64& random);

/// Depth as a structured-light or stereo camera measures it: the error of inverse depth does not
/// depend on depth.
struct DepthNoiseOptions {
    double sigmaAtOneMetre = 0.0015;  ///< standard deviation, growing with depth squared [m]
    double missing = 0.02;            ///< share of pixels without a measurement
};
void addDepthNoise(ImageF& depth, const DepthNoiseOptions& options, std::mt19937_64& random);

}  // namespace photonav
