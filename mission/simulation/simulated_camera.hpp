// SPDX-License-Identifier: BSD-3-Clause
// A simulated camera: noisy images at a fixed rate, whose pixels average over their area, with
// latency, lost images and, with a depth sensor, depth.
#pragma once

#include <cstdint>
#include <deque>
#include <optional>
#include <random>

#include "depth/stereo_depth.hpp"
#include "estimation/observation.hpp"
#include "render/area_sensor.hpp"
#include "simulation/camera_noise.hpp"
#include "simulation/pattern_projector.hpp"

namespace photonav {

enum class DepthSensor {
    none,
    rgbd,    ///< depth of every pixel with the noise of DepthNoiseOptions
    stereo,  ///< stereo matching (StereoDepth) with a second camera to the right
};

struct SimulatedCameraOptions {
    DepthSensor depth = DepthSensor::none;
    DepthNoiseOptions depthNoise = {};  ///< noise of DepthSensor::rgbd
    double baseline = 0.11;             ///< baseline of DepthSensor::stereo [m]
    double projector =
        0.;  ///< contrast of its PatternProjector, which lights only the pair; 0: none
    StereoOptions stereo{.halvings = 0, .blockSize = 21, .uniqueness = 20, .blur = 2.};
    /// Noise of the images that stereo matching uses: only the noise of the sensor, whereas the
    /// noise of the robot's images may also represent errors of a model. Empty: no noise.
    ImageNoise pairNoise = {};
    /// Standard deviation of the images' point spread, as stated by Robot::blur() [pixels]. It must
    /// include any defocus that the image noise adds.
    double blur = kAreaBlur;
    /// Standard deviation of the vertical measured with every image [rad]; 0: not measured.
    double verticalSigma = 0.;
    double period = 0.25;        ///< time between exposures [s]
    double latency = 0.;         ///< delay from exposure to arrival of an image [s]
    double dropRate = 0.;        ///< share of the images that never arrive
    double blackRate = 0.;       ///< share of the images that are black
    double blackoutStart = 0.;   ///< start of a time in which all images are black [s]
    double blackoutLength = 0.;  ///< length of this time [s]; 0: none
    /// Asked while noise is added to an image; when it returns true, Interrupted is thrown.
    IsStopped isStopped = {};
};

/// An exposure. Its image may arrive late or never.
struct Exposed {
    double time = 0.;               ///< time of the exposure [s]
    Pose T_c_w = Pose::Identity();  ///< true pose
    ImageF image;                   ///< image with noise, grey values in [0, 1]
    ImageF depth;                   ///< true depth [m]
};

/// Takes images of a world. Deterministic for a seed.
class SimulatedCamera {
  public:
    /// @param world the true world; must outlive the camera
    /// @param noise noise of the images; empty: no noise
    /// @throws std::invalid_argument for a period that is not positive, for a negative latency, and
    ///         with stereo for a baseline that is not positive
    SimulatedCamera(const ViewSource& world, const Camera& camera, ImageNoise noise,
                    const SimulatedCameraOptions& options, std::uint64_t seed);

    /// Takes an image if the next exposure is due. @return nothing if it is not
    /// @param time present time [s]; @param T_c_w true pose of the camera
    std::optional<Exposed> expose(double time, const Pose& T_c_w);

    /// Takes out the oldest image that has arrived by `time` [s]; nothing if there is none.
    std::optional<CameraFrame> receive(double time);

    const Camera& camera() const { return camera_; }

  private:
    bool isBlack(double time);
    std::optional<MeasuredVertical> measureVertical(const Pose& T_c_w);
    void measureDepth(const Pose& T_c_w, View& view);
    vpImage<unsigned char> pictureOf(ImageF ideal);
    StereoImages takePair(const Pose& T_c_w, View left);

    AreaSensor sensor_;
    Camera camera_;
    ImageNoise noise_;
    SimulatedCameraOptions options_;
    std::mt19937_64 random_, depthRandom_, verticalRandom_;
    std::optional<StereoDepth> stereo_;
    std::optional<PatternProjector> projector_;
    double next_ = 0.;  // time of the next exposure [s]
    std::deque<CameraFrame> onTheWay_;
};

}  // namespace photonav
