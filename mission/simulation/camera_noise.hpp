// SPDX-License-Identifier: BSD-3-Clause
// Image noise, as the planner assumes it or as of a real camera, and noise of a depth sensor.
#pragma once

#include <functional>
#include <random>

#include "alignment/normal_equations.hpp"
#include "io/interrupted.hpp"
#include "photometry/photometric.hpp"
#include "photometry/view.hpp"

namespace photonav {

/// Noise model of a real camera. Defaults: a small machine-vision camera indoors.
struct CameraNoiseOptions {
    double blur = 0.4;  ///< standard deviation of defocus, in addition to the point spread [pixels]
    double vignetting = 0.03;         ///< share of the light that is lost in the corners
    Exposure exposure;                ///< gain and offset relative to the model's exposure
    double electronsAtWhite = 5000.;  ///< signal of grey value 1, for shot noise [electrons]
    double readNoise = 10.;           ///< standard deviation of read noise [electrons]
    int bits = 8;                     ///< resolution of the converter; 0: not quantised
};

/// The image that a camera takes of an ideal image: blur, vignetting, gain, shot and read noise,
/// offset, clipping to [0, 1] and quantisation are applied in this order.
/// @param isStopped asked at every row @throws Interrupted when it returns true
ImageF takePicture(const ImageF& ideal, const CameraNoiseOptions& options, std::mt19937_64& random,
                   const IsStopped& isStopped = {});

/// Adds the noise of one exposure to the noise-free image. Very large images take seconds:
/// `isStopped` is asked now and then; when it returns true, Interrupted is thrown.
using ImageNoise =
    std::function<void(ImageF& image, std::mt19937_64& random, const IsStopped& isStopped)>;

/// The noise that PhotometricOptions assume: Gaussian with standard deviation sigma, correlated
/// over an area of 1 / scale pixels, so that photometricInformation() is the true information of an
/// image. Pixels are independent for a scale of 1 or more.
ImageNoise assumedNoise(const PhotometricOptions& options);

/// The varying gain of a camera with automatic exposure: a first-order Gauss-Markov process.
struct WanderingExposure {
    double gainSigma = 0.1;     ///< standard deviation of the gain about 1, clipped at two sigma
    double correlation = 0.95;  ///< correlation of the gains of consecutive images
};

/// The noise of a real camera with varying gain, for a sequence of images. A copy of the result
/// continues from the present gain, independently of the original.
ImageNoise realNoise(const CameraNoiseOptions& options = {},
                     const WanderingExposure& wandering = {});

/// Noise of a structured-light or stereo camera: the standard deviation of inverse depth does not
/// depend on depth.
struct DepthNoiseOptions {
    double sigmaAtOneMetre = 0.0015;  ///< standard deviation at 1 m; grows with depth squared [m]
    double missing = 0.02;            ///< share of pixels without a measurement
};
/// Adds noise to a depth image [m]; missing measurements become 0.
/// @param isStopped asked at every row @throws Interrupted when it returns true
void addDepthNoise(ImageF& depth, const DepthNoiseOptions& options, std::mt19937_64& random,
                   const IsStopped& isStopped = {});

}  // namespace photonav
