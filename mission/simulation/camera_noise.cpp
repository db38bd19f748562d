// SPDX-License-Identifier: BSD-3-Clause
#include "simulation/camera_noise.hpp"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

namespace photonav {
namespace {

ImageF blurred(const ImageF& image, double sigma) {
    const auto height = static_cast<int>(image.getHeight());
    const auto width = static_cast<int>(image.getWidth());
    const int side = 2 * static_cast<int>(std::ceil(3. * sigma)) + 1;
    ImageF result(image.getHeight(), image.getWidth());
    cv::Mat out(height, width, CV_32F, result.bitmap);
    cv::GaussianBlur(cv::Mat(height, width, CV_32F, image.bitmap), out, {side, side}, sigma, sigma,
                     cv::BORDER_REPLICATE);
    return result;
}

}  // namespace

ImageF takePicture(const ImageF& ideal, const CameraNoiseOptions& options,
                   std::mt19937_64& random) {
    ImageF image = options.blur > 0. ? blurred(ideal, options.blur) : ideal;
    const double cx = 0.5 * (image.getWidth() - 1.);
    const double cy = 0.5 * (image.getHeight() - 1.);
    const double corner = cx * cx + cy * cy;
    const double steps = options.bits > 0 ? std::ldexp(1., options.bits) - 1. : 0.;
    std::normal_distribution<double> normal;
    for (unsigned v = 0; v < image.getHeight(); ++v) {
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

void addDepthNoise(ImageF& depth, const DepthNoiseOptions& options, std::mt19937_64& random) {
    std::normal_distribution<double> normal;
    std::bernoulli_distribution missing(options.missing);
    for (unsigned i = 0; i < depth.getSize(); ++i) {
        const double z = depth.bitmap[i];
        const double noisy = z + options.sigmaAtOneMetre * z * z * normal(random);
        depth.bitmap[i] =
            z > 0. && !missing(random) && noisy > 0. ? static_cast<float>(noisy) : 0.F;
    }
}

}  // namespace photonav
