// SPDX-License-Identifier: BSD-3-Clause
#include "alignment/fitted_gain.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <vector>

namespace photonav {
namespace {

constexpr unsigned kBlock = 8;                  // edge [pixels]
constexpr float kBlack = 1.5F / 255.F;          // clipped below
constexpr float kWhite = 1.F - kBlack;          // clipped above
constexpr double kLeastBlockSigma = 1. / 255.;  // of a block's mean [grey value]
constexpr double kCauchy = 2.385;               // residual at which weights are a half [sigma]
constexpr int kRounds = 10;                     // of weights
constexpr double kGainByChance = 9.;            // squared difference [variances]
constexpr double kGainSigma = 0.1;              // of the change from image to image
constexpr double kMostChange = 2.;              // factor on the gain from image to image

struct BlockMeans {
    double observed, predicted;
};

/// Means of a block; none: a pixel is not predicted, or clipped.
bool meansOf(const ImageF& observed, const View& predicted, unsigned v0, unsigned u0,
             BlockMeans& means) {
    means = {0., 0.};
    for (unsigned v = v0; v < v0 + kBlock; ++v) {
        for (unsigned u = u0; u < u0 + kBlock; ++u) {
            const float grey = observed[v][u];
            if (!(predicted.depth[v][u] > 0.F) || grey < kBlack || grey > kWhite) return false;
            means.observed += grey;
            means.predicted += predicted.intensity[v][u];
        }
    }
    means.observed /= kBlock * kBlock;
    means.predicted /= kBlock * kBlock;
    return true;
}

std::vector<BlockMeans> blockMeans(const ImageF& observed, const View& predicted) {
    std::vector<BlockMeans> blocks;
    BlockMeans means{};
    for (unsigned v = 0; v + kBlock <= observed.getHeight(); v += kBlock) {
        for (unsigned u = 0; u + kBlock <= observed.getWidth(); u += kBlock) {
            if (meansOf(observed, predicted, v, u, means)) blocks.push_back(means);
        }
    }
    return blocks;
}

double robustSigmaOf(const std::vector<BlockMeans>& blocks, double gain) {
    std::vector<double> residuals;
    residuals.reserve(blocks.size());
    for (const BlockMeans& b : blocks) {
        residuals.push_back(std::abs(b.observed - gain * b.predicted));
    }
    const auto middle = residuals.begin() + static_cast<std::ptrdiff_t>(residuals.size() / 2);
    std::nth_element(residuals.begin(), middle, residuals.end());
    return std::max(kLeastBlockSigma, 1.4826 * *middle);
}

}  // namespace

double fittedGain(const ImageF& observed, const View& predicted, double last) {
    if (observed.getHeight() != predicted.intensity.getHeight() ||
        observed.getWidth() != predicted.intensity.getWidth()) {
        throw std::invalid_argument("gain: image and view differ in size");
    }
    const std::vector<BlockMeans> blocks = blockMeans(observed, predicted);
    if (blocks.empty()) return last;
    double change = 0., information = 0.;
    for (int round = 0; round < kRounds; ++round) {
        const double sigma = robustSigmaOf(blocks, last + change);
        double right = 0.;
        information = 1. / (kGainSigma * kGainSigma);
        for (const BlockMeans& b : blocks) {
            const double residual = b.observed - (last + change) * b.predicted;
            const double weight = 1. / (1. + std::pow(residual / (kCauchy * sigma), 2));
            information += weight * b.predicted * b.predicted / (sigma * sigma);
            right += weight * b.predicted * (b.observed - last * b.predicted) / (sigma * sigma);
        }
        change = right / information;
    }
    const double factor = (last + change) / last;
    const bool isPlausible = factor < kMostChange && factor * kMostChange > 1.;
    const bool isChance = change * change * information < kGainByChance;
    return isPlausible && !isChance ? last + change : last;
}

}  // namespace photonav
