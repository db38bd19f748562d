// SPDX-License-Identifier: BSD-3-Clause
#include "simulation/simulated_camera.hpp"

#include <algorithm>
#include <stdexcept>
#include <utility>

namespace photonav {
namespace {

constexpr double kTimeSlack = 1e-9;                       // of sums of time steps [s]
constexpr std::uint64_t kDepthSeed = 0x9e3779b97f4a7c15;  // for random numbers of its own
constexpr std::uint64_t kVerticalSeed = 0xd1b54a32d192ed03;

}  // namespace

SimulatedCamera::SimulatedCamera(const ViewSource& world, const Camera& camera, ImageNoise noise,
                                 const SimulatedCameraOptions& options, std::uint64_t seed)
    : sensor_(world),
      camera_(camera),
      noise_(std::move(noise)),
      options_(options),
      random_(seed),
      depthRandom_(seed ^ kDepthSeed),
      verticalRandom_(seed ^ kVerticalSeed) {
    if (!(options.period > 0.) || !(options.latency >= 0.)) {
        throw std::invalid_argument("simulated camera: no period, or negative latency");
    }
    if (options.depth != DepthSensor::stereo) return;
    const DistortedCamera left{camera, Eigen::Vector4d::Zero(), Pose::Identity(), {}};
    DistortedCamera right = left;
    right.T_b_c.translation().x() = options.baseline;
    stereo_.emplace(left, right, options.stereo);
    if (options.projector > 0.) projector_.emplace(camera, options.projector);
}

bool SimulatedCamera::isBlack(double time) {
    const double sinceBlackout = time - options_.blackoutStart;
    const bool isInBlackout = sinceBlackout >= 0. && sinceBlackout < options_.blackoutLength;
    return std::bernoulli_distribution(options_.blackRate)(random_) || isInBlackout;
}

std::optional<Exposed> SimulatedCamera::expose(double time, const Pose& T_c_w) {
    if (time < next_ - kTimeSlack) return {};
    next_ += options_.period;
    View view;
    sensor_.render(camera_, T_c_w, view);
    Exposed exposed{time, T_c_w, view.intensity, view.depth};
    if (noise_) noise_(exposed.image, random_, options_.isStopped);
    const bool isBlackNow = isBlack(time);
    if (isBlackNow) exposed.image = view.intensity = 0.F;
    const bool isDropped = std::bernoulli_distribution(options_.dropRate)(random_);
    if (isDropped) return exposed;
    measureDepth(T_c_w, view);
    view.intensity = exposed.image;
    onTheWay_.push_back({time, std::move(view), measureVertical(T_c_w)});
    return exposed;
}

std::optional<MeasuredVertical> SimulatedCamera::measureVertical(const Pose& T_c_w) {
    if (options_.verticalSigma <= 0.) return {};
    std::normal_distribution<double> normal(0., options_.verticalSigma);
    const Eigen::Vector3d tilt_w(normal(verticalRandom_), normal(verticalRandom_), 0.);
    const Eigen::Vector3d up_w = (Eigen::Vector3d::UnitZ() + tilt_w).normalized();
    return MeasuredVertical{T_c_w.linear() * up_w, options_.verticalSigma};
}

/// Replaces the true depth of an ideal view by the measured one.
void SimulatedCamera::measureDepth(const Pose& T_c_w, View& view) {
    switch (options_.depth) {
        case DepthSensor::none:
            view.depth.resize(0, 0);
            return;
        case DepthSensor::rgbd:
            return addDepthNoise(view.depth, options_.depthNoise, depthRandom_, options_.isStopped);
        case DepthSensor::stereo:
            (*stereo_)(takePair(T_c_w, view), view);
    }
}

/// A picture of the pair.
vpImage<unsigned char> SimulatedCamera::pictureOf(ImageF ideal) {
    if (options_.pairNoise) options_.pairNoise(ideal, depthRandom_, options_.isStopped);
    vpImage<unsigned char> bytes(ideal.getHeight(), ideal.getWidth());
    std::transform(ideal.bitmap, ideal.bitmap + ideal.getSize(), bytes.bitmap, greyLevel);
    return bytes;
}

/// @param left ideal view of the left camera
StereoImages SimulatedCamera::takePair(const Pose& T_c_w, View left) {
    View right;
    Pose T_r_l = Pose::Identity();
    T_r_l.translation().x() = -options_.baseline;
    sensor_.render(camera_, T_r_l * T_c_w, right);
    if (projector_) {
        projector_->illuminate(left, left.depth, 0.);
        projector_->illuminate(right, left.depth, options_.baseline);
    }
    StereoImages pair;
    pair.left = pictureOf(std::move(left.intensity));
    pair.right = pictureOf(std::move(right.intensity));
    return pair;
}

std::optional<CameraFrame> SimulatedCamera::receive(double time) {
    if (onTheWay_.empty() || onTheWay_.front().time + options_.latency > time + kTimeSlack) {
        return std::nullopt;
    }
    CameraFrame frame = std::move(onTheWay_.front());
    onTheWay_.pop_front();
    return frame;
}

}  // namespace photonav
