// SPDX-License-Identifier: BSD-3-Clause
#include "simulation/camera_noise.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

namespace photonav {

namespace {

/// Gaussian blur along one axis; borders repeat.
void blurAlong(const ImageF& in, ImageF& out, const std::vector<double>& kernel, bool alongRows) {
    const int radius = static_cast<int>(kernel.size() / 2);
    const int width = static_cast<int>(in.getWidth());
    const int height = static_cast<int>(in.getHeight());
    for (int v = 0; v < height; ++v) {
        for (int u = 0; u < width; ++u) {
            double sum = 0.;
            for (int k = -radius; k <= radius; ++k) {
                const int x = alongRows ? std::clamp(u + k, 0, width - 1) : u;
                const int y = alongRows ? v : std::clamp(v + k, 0, height - 1);
                sum += kernel[k + radius] * in[y][x];
            }
            out[v][u] = static_cast<float>(sum);
        }
    }
}

ImageF blurred(const ImageF& image, double sigma) {
    const int radius = static_cast<int>(std::ceil(3. * sigma));
    std::vector<double> kernel;
    double total = 0.;
    for (int k = -radius; k <= radius; ++k) {
        kernel.push_back(std::exp(-0.5 * k * k / (sigma * sigma)));
        total += kernel.back();
    }
    for (double& k : kernel) k /= total;
    ImageF rows(image.getHeight(), image.getWidth());
    ImageF both(image.getHeight(), image.getWidth());
    blurAlong(image, rows, kernel, true);
    blurAlong(rows, both, kernel, false);
    return both;
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
