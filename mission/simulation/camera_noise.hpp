// SPDX-License-Identifier: BSD-3-Clause
// The noise of cameras, as assumed or as of a real one, and of a real depth sensor.
#pragma once

#include <functional>
#include <random>

#include "alignment/normal_equations.hpp"
#include "photometry/photometric.hpp"
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

/// Adds the noise of one exposure to the noise-free image.
using ImageNoise = std::function<void(ImageF& image, std::mt19937_64& random)>;

/// The noise that PhotometricOptions describe: Gaussian with standard deviation sigma, correlated
/// over an area of 1 / scale pixels. `scale` below 1 means that neighbouring pixels are not
/// independent; with this noise the information of an image is Lambda. Independent pixels for a
/// scale of 1 or more.
ImageNoise assumedNoise(const PhotometricOptions& options);

/// The varying gain of a camera with automatic exposure: a first-order Gauss-Markov process.
struct WanderingExposure {
    double gainSigma = 0.1;  ///< standard deviation of the gain about 1, cut off at twice as much
    double correlation = 0.95;  ///< of the gains of consecutive images
};

/// The noise of a real camera, image by image, with a varying gain. A copy varies independently,
/// from the present gain on.
ImageNoise realNoise(const CameraNoiseOptions& options = {},
                     const WanderingExposure& wandering = {});

/// Depth as a structured-light or stereo camera measures it: the error of inverse depth does not
/// depend on depth.
struct DepthNoiseOptions {
    double sigmaAtOneMetre = 0.0015;  ///< standard deviation, growing with depth squared [m]
    double missing = 0.02;            ///< share of pixels without a measurement
};
void addDepthNoise(ImageF& depth, const DepthNoiseOptions& options, std::mt19937_64& random);

}  // namespace photonav
