// SPDX-License-Identifier: BSD-3-Clause
#include "simulation/simulated_camera.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>
#include <utility>
#include <vector>

namespace photonav {
namespace {

constexpr double kTimeSlack = 1e-9;                       // of sums of time steps [s]
constexpr std::uint64_t kDepthSeed = 0x9e3779b97f4a7c15;  // for random numbers of its own

/// Weights of a Gaussian kernel of one dimension whose squares sum to one: white noise keeps its
/// variance.
std::vector<float> unitPowerKernel(double sigma) {
    const int reach = std::max(1, static_cast<int>(std::ceil(4. * sigma)));
    std::vector<float> kernel;
    double power = 0.;
    for (int i = -reach; i <= reach; ++i) {
        const double weight = std::exp(-0.5 * i * i / (sigma * sigma));
        kernel.push_back(static_cast<float>(weight));
        power += weight * weight;
    }
    for (float& weight : kernel) weight /= static_cast<float>(std::sqrt(power));
    return kernel;
}

/// Convolution along rows, transposed: twice gives the convolution with the kernel's square. Only
/// where the kernel lies inside.
ImageF convolvedTransposed(const ImageF& image, const std::vector<float>& kernel) {
    const unsigned columns = image.getWidth() - static_cast<unsigned>(kernel.size()) + 1;
    ImageF result(columns, image.getHeight());
    for (unsigned v = 0; v < image.getHeight(); ++v) {
        for (unsigned u = 0; u < columns; ++u) {
            float sum = 0.F;
            for (unsigned k = 0; k < kernel.size(); ++k) sum += kernel[k] * image[v][u + k];
            result[u][v] = sum;
        }
    }
    return result;
}

}  // namespace

ImageNoise assumedNoise(const PhotometricOptions& options) {
    // Correlation exp(-d^2 / 4 s^2) of a Gaussian kernel of s pixels sums to 4 pi s^2 pixels.
    const double area = 1. / options.scale;
    std::vector<float> kernel{1.F};
    if (options.scale > 0. && area > 1.) {
        kernel = unitPowerKernel(std::sqrt(area / (4. * std::numbers::pi)));
    }
    const auto sigma = static_cast<float>(options.sigma);
    return [kernel, sigma](ImageF& image, std::mt19937_64& random) {
        std::normal_distribution<float> normal(0.F, sigma);
        const auto border = static_cast<unsigned>(kernel.size()) - 1;
        ImageF noise(image.getHeight() + border, image.getWidth() + border);
        for (unsigned i = 0; i < noise.getSize(); ++i) noise.bitmap[i] = normal(random);
        if (border > 0) noise = convolvedTransposed(convolvedTransposed(noise, kernel), kernel);
        for (unsigned i = 0; i < image.getSize(); ++i) image.bitmap[i] += noise.bitmap[i];
    };
}

ImageNoise realNoise(const CameraNoiseOptions& options, const WanderingExposure& wandering) {
    return [options, wandering, state = std::optional<double>{}](ImageF& image,
                                                                 std::mt19937_64& random) mutable {
        std::normal_distribution<double> normal;
        const double c = wandering.correlation;
        state = state ? c * *state + std::sqrt(1. - c * c) * normal(random) : normal(random);
        CameraNoiseOptions now = options;
        now.exposure.gain *= 1. + wandering.gainSigma * std::clamp(*state, -2., 2.);
        image = takePicture(image, now, random);
    };
}

SimulatedCamera::SimulatedCamera(const ViewSource& world, const Camera& camera, ImageNoise noise,
                                 const SimulatedCameraOptions& options, std::uint64_t seed)
    : sensor_(world),
      camera_(camera),
      noise_(std::move(noise)),
      options_(options),
      random_(seed),
      depthRandom_(seed ^ kDepthSeed) {
    if (!(options.period > 0.) || !(options.latency >= 0.)) {
        throw std::invalid_argument("simulated camera: no period, or negative latency");
    }
    if (options.depth != DepthSensor::stereo) return;
    const DistortedCamera left{camera, Eigen::Vector4d::Zero(), Pose::Identity(), {}};
    DistortedCamera right = left;
    right.T_b_c.translation().x() = options.baseline;
    stereo_.emplace(left, right, options.stereo);
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
    if (noise_) noise_(exposed.image, random_);
    const bool isBlackNow = isBlack(time);
    if (isBlackNow) exposed.image = view.intensity = 0.F;
    const bool isDropped = std::bernoulli_distribution(options_.dropRate)(random_);
    if (isDropped) return exposed;
    measureDepth(T_c_w, view);
    view.intensity = exposed.image;
    onTheWay_.push_back({time, std::move(view)});
    return exposed;
}

/// Replaces the true depth of an ideal view by the measured one.
void SimulatedCamera::measureDepth(const Pose& T_c_w, View& view) {
    switch (options_.depth) {
        case DepthSensor::none:
            view.depth.resize(0, 0);
            return;
        case DepthSensor::rgbd:
            return addDepthNoise(view.depth, options_.depthNoise, depthRandom_);
        case DepthSensor::stereo:
            (*stereo_)({pictureOf(view.intensity), rightImage(T_c_w)}, view);
    }
}

/// A picture of the pair.
vpImage<unsigned char> SimulatedCamera::pictureOf(ImageF ideal) {
    if (options_.pairNoise) options_.pairNoise(ideal, depthRandom_);
    vpImage<unsigned char> bytes(ideal.getHeight(), ideal.getWidth());
    std::transform(ideal.bitmap, ideal.bitmap + ideal.getSize(), bytes.bitmap, greyLevel);
    return bytes;
}

vpImage<unsigned char> SimulatedCamera::rightImage(const Pose& T_c_w) {
    View view;
    Pose T_r_l = Pose::Identity();
    T_r_l.translation().x() = -options_.baseline;
    sensor_.render(camera_, T_r_l * T_c_w, view);
    return pictureOf(std::move(view.intensity));
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
