// SPDX-License-Identifier: BSD-3-Clause
// A camera in a simulated world: noisy images at a fixed rate, whose pixels average over their
// area, with depth if it has a depth sensor, with latency and lost images.
#pragma once

#include <cstdint>
#include <deque>
#include <optional>
#include <random>

#include "depth/stereo_depth.hpp"
#include "estimation/observation.hpp"
#include "render/area_sensor.hpp"
#include "simulation/camera_noise.hpp"

namespace photonav {

enum class DepthSensor {
    none,
    rgbd,    ///< depth of every pixel, with DepthNoiseOptions
    stereo,  ///< a second camera to the right, and StereoDepth
};

struct SimulatedCameraOptions {
    DepthSensor depth = DepthSensor::none;
    DepthNoiseOptions depthNoise = {};  ///< rgbd
    double baseline = 0.11;             ///< stereo [m]
    StereoOptions stereo{.halvings = 0, .blockSize = 21};
    /// Noise of the pictures that `stereo` matches: the sensor's own, where that of the images may
    /// stand for errors of a model as well. None: no noise.
    ImageNoise pairNoise = {};
    /// Point spread that the robot states of its images, a defocus by their noise included
    /// [pixels].
    double blur = kAreaBlur;
    /// Of the vertical that is measured with every image [rad]; 0: it is not measured.
    double verticalSigma = 0.;
    double period = 0.25;        ///< between exposures [s]
    double latency = 0.;         ///< from the exposure to the image being there [s]
    double dropRate = 0.;        ///< share of the frames that never arrive
    double blackRate = 0.;       ///< share of the frames that are black
    double blackoutStart = 0.;   ///< all frames taken from here on [s] ...
    double blackoutLength = 0.;  ///< ... for as long as this are black [s]
};

/// An exposure. Its image may arrive late or never.
struct Exposed {
    double time = 0.;               ///< [s]
    Pose T_c_w = Pose::Identity();  ///< true
    ImageF image;                   ///< with noise
    ImageF depth;                   ///< true [m]
};

/// Deterministic for a seed.
class SimulatedCamera {
  public:
    /// @param world the true one; must outlive the camera
    /// @throws std::invalid_argument for a period that is not positive, a negative latency, a
    ///         baseline that is not positive with stereo
    SimulatedCamera(const ViewSource& world, const Camera& camera, ImageNoise noise,
                    const SimulatedCameraOptions& options, std::uint64_t seed);

    /// Takes an image when it is time to. @return nothing when it is not
    std::optional<Exposed> expose(double time, const Pose& T_c_w);

    /// The next image that has arrived by now, oldest first.
    std::optional<CameraFrame> receive(double time);

    const Camera& camera() const { return camera_; }

  private:
    bool isBlack(double time);
    std::optional<MeasuredVertical> measureVertical(const Pose& T_c_w);
    void measureDepth(const Pose& T_c_w, View& view);
    vpImage<unsigned char> pictureOf(ImageF ideal);
    vpImage<unsigned char> rightImage(const Pose& T_c_w);

    AreaSensor sensor_;
    Camera camera_;
    ImageNoise noise_;
    SimulatedCameraOptions options_;
    std::mt19937_64 random_, depthRandom_, verticalRandom_;
    std::optional<StereoDepth> stereo_;
    double next_ = 0.;  // exposure [s]
    std::deque<CameraFrame> onTheWay_;
};

}  // namespace photonav
