// SPDX-License-Identifier: BSD-3-Clause
#include "simulation/camera_noise.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <opencv2/imgproc.hpp>
#include <optional>
#include <vector>

#include "photometry/opencv_image.hpp"

namespace photonav {
namespace {

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

ImageF blurred(const ImageF& image, double sigma) {
    const int side = 2 * static_cast<int>(std::ceil(3. * sigma)) + 1;
    ImageF result(image.getHeight(), image.getWidth());
    cv::GaussianBlur(asMat(image), asMat(result), {side, side}, sigma, sigma, cv::BORDER_REPLICATE);
    return result;
}

}  // namespace

ImageF takePicture(const ImageF& ideal, const CameraNoiseOptions& options, std::mt19937_64& random,
                   const IsStopped& isStopped) {
    ImageF image = options.blur > 0. ? blurred(ideal, options.blur) : ideal;
    const double cx = 0.5 * (image.getWidth() - 1.);
    const double cy = 0.5 * (image.getHeight() - 1.);
    const double corner = cx * cx + cy * cy;
    const double steps = options.bits > 0 ? std::ldexp(1., options.bits) - 1. : 0.;
    std::normal_distribution<double> normal;
    for (unsigned v = 0; v < image.getHeight(); ++v) {
        throwIfStopped(isStopped);
        for (unsigned u = 0; u < image.getWidth(); ++u) {
            const double radius = (u - cx) * (u - cx) + (v - cy) * (v - cy);
            const double light = std::max(0., options.exposure.gain * image[v][u] *
                                                  (1. - options.vignetting * radius / corner));
            // Hundreds of electrons: the Poisson distribution is normal.
            const double shot = std::sqrt(light * options.electronsAtWhite);
            const double electrons = std::hypot(shot, options.readNoise) * normal(random);
            double grey = light + electrons / options.electronsAtWhite + options.exposure.offset;
            grey = std::clamp(grey, 0., 1.);
            if (steps > 0.) grey = std::round(grey * steps) / steps;
            image[v][u] = static_cast<float>(grey);
        }
    }
    return image;
}

ImageNoise assumedNoise(const PhotometricOptions& options) {
    // Correlation exp(-d^2 / 4 s^2) of a Gaussian kernel of s pixels sums to 4 pi s^2 pixels.
    const double area = 1. / options.scale;
    std::vector<float> kernel{1.F};
    if (options.scale > 0. && area > 1.) {
        kernel = unitPowerKernel(std::sqrt(area / (4. * std::numbers::pi)));
    }
    const auto sigma = static_cast<float>(options.sigma);
    return [kernel, sigma](ImageF& image, std::mt19937_64& random, const IsStopped& isStopped) {
        std::normal_distribution<float> normal(0.F, sigma);
        const auto border = static_cast<int>(kernel.size()) - 1;
        cv::Mat pixels = asMat(image);
        cv::Mat1f noise(pixels.rows + border, pixels.cols + border);
        for (int v = 0; v < noise.rows; ++v) {
            throwIfStopped(isStopped);
            std::generate_n(noise[v], noise.cols, [&] { return normal(random); });
        }
        cv::Mat1f smooth;
        cv::sepFilter2D(noise, smooth, CV_32F, kernel, kernel);
        // Only where the kernel lies inside.
        pixels += smooth(cv::Rect(border / 2, border / 2, pixels.cols, pixels.rows));
    };
}

ImageNoise realNoise(const CameraNoiseOptions& options, const WanderingExposure& wandering) {
    return [options, wandering, state = std::optional<double>{}](
               ImageF& image, std::mt19937_64& random, const IsStopped& isStopped) mutable {
        std::normal_distribution<double> normal;
        const double c = wandering.correlation;
        state = state ? c * *state + std::sqrt(1. - c * c) * normal(random) : normal(random);
        CameraNoiseOptions now = options;
        now.exposure.gain *= 1. + wandering.gainSigma * std::clamp(*state, -2., 2.);
        image = takePicture(image, now, random, isStopped);
    };
}

void addDepthNoise(ImageF& depth, const DepthNoiseOptions& options, std::mt19937_64& random,
                   const IsStopped& isStopped) {
    std::normal_distribution<double> normal;
    std::bernoulli_distribution missing(options.missing);
    for (unsigned i = 0; i < depth.getSize(); ++i) {
        if (i % depth.getWidth() == 0) throwIfStopped(isStopped);
        const double z = depth.bitmap[i];
        const double noisy = z + options.sigmaAtOneMetre * z * z * normal(random);
        depth.bitmap[i] =
            z > 0. && !missing(random) && noisy > 0. ? static_cast<float>(noisy) : 0.F;
    }
}

}  // namespace photonav
