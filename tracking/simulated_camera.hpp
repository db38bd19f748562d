// SPDX-License-Identifier: BSD-3-Clause
// A camera in a simulated world: noisy images at a rate, late, and sometimes not at all.
#pragma once

#include <cstdint>
#include <deque>
#include <functional>
#include <optional>
#include <random>

#include "camera_noise.hpp"
#include "photometric.hpp"

namespace photonav {

/// Adds the noise of one exposure to the noise-free image.
using ImageNoise = std::function<void(ImageF& image, std::mt19937_64& random)>;

/// The noise that PhotometricOptions describe: Gaussian with standard deviation sigma, over an area
/// of 1 / scale pixels correlated. `scale` says that neighbouring pixels are not independent; with
/// noise like this an image is worth what Lambda says. Independent pixels for a scale of 1 or more.
ImageNoise assumedNoise(const PhotometricOptions& options);

/// How the exposure of a camera wanders that sets it by itself: a first-order Gauss-Markov process.
struct WanderingExposure {
    double gainSigma = 0.1;  ///< standard deviation of the gain about 1, cut off at twice as much
    double correlation = 0.95;  ///< of the gains of consecutive images
};

/// The noise of a real camera, image by image, times a gain that wanders. A copy has an exposure of
/// its own, from where the original's is.
ImageNoise realNoise(const CameraNoiseOptions& options = {},
                     const WanderingExposure& wandering = {});

struct SimulatedCameraOptions {
    double period = 0.25;        ///< between exposures [s]
    double latency = 0.;         ///< from the exposure to the image being there [s]
    double dropRate = 0.;        ///< share of the frames that never arrive
    double blackRate = 0.;       ///< share of the frames that are black
    double blackoutStart = 0.;   ///< all frames taken from here on [s] ...
    double blackoutLength = 0.;  ///< ... for as long as this are black [s]
};

/// An image and when it was taken.
struct TakenImage {
    double time = 0.;  ///< of the exposure [s]
    ImageF image;
};

/// Deterministic for a seed.
class SimulatedCamera {
  public:
    /// @param world what there really is; must outlive the camera
    /// @throws std::invalid_argument for a period that is not positive, a negative latency
    SimulatedCamera(const ViewSource& world, const Camera& camera, ImageNoise noise,
                    const SimulatedCameraOptions& options, std::uint64_t seed);

    /// Takes an image when it is time to.
    /// @return whether one was taken (it may be dropped all the same)
    bool expose(double time, const Pose& T_c_w);

    /// The next image that has arrived by now, oldest first.
    std::optional<TakenImage> receive(double time);

    /// Images never dropped, noise-free view included: for recording.
    const View& lastView() const { return view_; }
    const ImageF& lastImage() const { return image_; }

  private:
    bool isBlack(double time);

    const ViewSource& world_;
    Camera camera_;
    ImageNoise noise_;
    SimulatedCameraOptions options_;
    std::mt19937_64 random_;
    double next_ = 0.;  // exposure [s]
    View view_;
    ImageF image_;
    std::deque<TakenImage> onTheWay_;
};

}  // namespace photonav
