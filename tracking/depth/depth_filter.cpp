// SPDX-License-Identifier: BSD-3-Clause
#include "depth/depth_filter.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>
#include <utility>

#include "depth/epipolar_search.hpp"
#include "evaluation/averages.hpp"

namespace photonav {
namespace {

void checkSize(const ImageF& image, const Camera& camera) {
    if (image.getWidth() == camera.width && image.getHeight() == camera.height) return;
    throw std::invalid_argument("DepthFilter: an image of another size than the camera's");
}

/// Variance of a uniform distribution of inverse depths.
float priorVariance(const DepthFilterOptions& options) {
    return static_cast<float>(1. / (12. * options.minDepth * options.minDepth));
}

double gaussian(double x, double variance) {
    return std::exp(-0.5 * x * x / variance) / std::sqrt(2. * std::numbers::pi * variance);
}

}  // namespace

DepthFilter::DepthFilter(ImageF reference, const Camera& camera, const Pose& T_r_w,
                         const DepthFilterOptions& options)
    : reference_(std::move(reference)), camera_(camera), T_r_w_(T_r_w), options_(options) {
    checkSize(reference_, camera_);
    const auto middle = static_cast<float>(0.5 / options_.minDepth);
    const Seed unknown{middle, priorVariance(options_), 10.F, 10.F, DepthState::searching};
    seeds_.assign(reference_.getSize(), unknown);
}

void DepthFilter::observe(const ImageF& image, const Pose& T_c_w) {
    checkSize(image, camera_);
    EpipolarSearch search(
        reference_, image, camera_, T_c_w * T_r_w_.inverse(),
        {options_.sigma, options_.matchSigma, options_.minScore, options_.maxSteps});
    const double range = 1. / options_.minDepth;
    for (unsigned v = 0; v < camera_.height; ++v) {
        for (unsigned u = 0; u < camera_.width; ++u) {
            Seed& seed = seeds_[v * camera_.width + u];
            if (seed.state != DepthState::searching) continue;
            const double w = std::clamp<double>(seed.mean, 0., range);
            const double reach = 2. * std::sqrt(seed.variance);
            const EpipolarMatch match =
                search(u, v, std::max(0., w - reach), w, std::min(range, w + reach));
            if (match.outcome == EpipolarMatch::Outcome::undecided) continue;
            if (match.outcome == EpipolarMatch::Outcome::different) {
                seed.b += 1.F;
            } else {
                update(seed, match.w, match.sigma * match.sigma);
            }
            decide(seed);
        }
    }
}

/// The moments of the Gaussian and the Beta distribution that the exact posterior has (Vogiatzis
/// and Hernandez 2011, supplementary material, eq. 18 to 26).
void DepthFilter::update(Seed& seed, double x, double tau2) const {
    const double a = seed.a, b = seed.b, mu = seed.mean, sigma2 = seed.variance;
    const double s2 = 1. / (1. / sigma2 + 1. / tau2);
    const double m = s2 * (mu / sigma2 + x / tau2);
    double c1 = a / (a + b) * gaussian(x - mu, sigma2 + tau2);
    double c2 = b / (a + b) * options_.minDepth;
    const double sum = c1 + c2;
    c1 /= sum;
    c2 /= sum;
    const double f = c1 * (a + 1.) / (a + b + 1.) + c2 * a / (a + b + 1.);
    const double e = (c1 * (a + 1.) * (a + 2.) + c2 * a * (a + 1.)) / ((a + b + 1.) * (a + b + 2.));
    const double mean = c1 * m + c2 * mu;
    const double variance = c1 * (s2 + m * m) + c2 * (sigma2 + mu * mu) - mean * mean;
    seed.mean = static_cast<float>(mean);
    seed.variance = static_cast<float>(std::max(variance, 1e-3 * s2));
    seed.a = static_cast<float>((e - f) / (f - e / f));
    seed.b = static_cast<float>(seed.a * (1. - f) / f);
}

void DepthFilter::decide(Seed& seed) const {
    const double inliers = seed.a / (seed.a + seed.b);
    if (inliers < 1. - options_.maxOutliers) {
        seed.state = DepthState::givenUp;
    } else if (inliers > options_.minInliers &&
               std::sqrt(seed.variance) < options_.converged * seed.mean) {
        seed.state = DepthState::converged;
    }
}

View DepthFilter::view() const {
    View view;
    view.intensity = reference_;
    view.depth.resize(camera_.height, camera_.width, 0.F);
    std::ranges::transform(seeds_, view.depth.bitmap, [](const Seed& seed) {
        return seed.state == DepthState::converged ? 1.F / seed.mean : 0.F;
    });
    return view;
}

double DepthFilter::shareNarrowed() const {
    const float half = 0.5F * priorVariance(options_);
    const auto narrowed = std::count_if(seeds_.begin(), seeds_.end(),
                                        [&](const Seed& seed) { return seed.variance <= half; });
    return static_cast<double>(narrowed) / static_cast<double>(seeds_.size());
}

std::optional<double> DepthFilter::medianDepth() const {
    std::vector<float> inverse;
    for (const Seed& seed : seeds_) {
        if (seed.state == DepthState::converged) inverse.push_back(seed.mean);
    }
    if (inverse.empty()) return {};
    return 1. / median(std::move(inverse), 0.);
}

}  // namespace photonav
