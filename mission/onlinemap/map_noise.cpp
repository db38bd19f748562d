// SPDX-License-Identifier: BSD-3-Clause
#include "onlinemap/map_noise.hpp"

#include <algorithm>

#include "alignment/gradient_noise.hpp"

namespace photonav {
namespace {

const Vector6 kSigns{{1., 1., -1., -1., 1., 1.}};  // of J's columns in GradientNoise
constexpr unsigned kStride = 4;                    // of the points that stand for all
constexpr double kMinPixels = 1000;                // of an image that is compared

Eigen::Vector2d gradientAt(const ImageF& I, unsigned u, unsigned v) {
    return 0.5 * Eigen::Vector2d(I[v][u + 1] - I[v][u - 1], I[v + 1][u] - I[v - 1][u]);
}

/// Points of a view, and how many pixels they stand for.
struct Points {
    GradientNoise noise;
    double pixels = 0.;
};

Points pointsOf(const View& view, const Camera& camera) {
    Points points;
    for (unsigned v = 1; v + 1 < camera.height; v += kStride) {
        for (unsigned u = 1; u + 1 < camera.width; u += kStride) {
            if (!hasDepthAround(view, u, v)) continue;
            points.noise.add((u - camera.cx()) / camera.fx(), (v - camera.cy()) / camera.fy(),
                             1. / view.depth[v][u]);
            points.pixels += kStride * kStride;
        }
    }
    return points;
}

}  // namespace

void MapNoise::observe(const View& map, const ImageF& image, const Camera& camera) {
    double sum = 0., count = 0.;
    for (unsigned v = 1; v + 1 < image.getHeight(); ++v) {
        for (unsigned u = 1; u + 1 < image.getWidth(); ++u) {
            if (!hasDepthAround(map, u, v)) continue;
            const Eigen::Vector2d g = gradientAt(map.intensity, u, v);
            sum += 0.5 * g.dot(g - gradientAt(image, u, v));
            ++count;
        }
    }
    if (count < kMinPixels) return;
    noise_->sum += camera.fx() * camera.fy() * std::max(0., sum / count);
    ++noise_->images;
}

InformationModel MapNoise::model(const Camera& camera, const PhotometricOptions& options) const {
    return [camera, options, noise = noise_](const View& view) -> Matrix6 {
        const Matrix6 information = photometricInformation(view, camera, options);
        if (noise->images == 0 || information.isZero(0.)) return information;
        const Points points = pointsOf(view, camera);
        const double weight = options.scale / (options.sigma * options.sigma);
        NormalEquations equations;
        equations.AtA.topLeftCorner<6, 6>() = information / weight;
        equations.AtA(7, 7) = equations.count = points.pixels;
        const double sum = points.pixels * noise->sum / noise->images;
        const Eigen::Vector2d notShared(sum, sum);
        const double most = camera.fx() * camera.fy() * options.sigma * options.sigma;
        points.noise.subtractFrom(equations, notShared, most, kSigns);
        const Matrix6 left = weight * equations.AtA.topLeftCorner<6, 6>();
        return 0.5 * (left + left.transpose());
    };
}

}  // namespace photonav
