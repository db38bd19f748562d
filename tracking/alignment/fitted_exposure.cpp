// SPDX-License-Identifier: BSD-3-Clause
#include "alignment/fitted_exposure.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <vector>

namespace photonav {
namespace {

using Eigen::Matrix2d;
using Eigen::Vector2d;

constexpr unsigned kBlock = 8;                  // edge [pixels]
constexpr float kBlack = 1.5F / 255.F;          // clipped below
constexpr float kWhite = 1.F - kBlack;          // clipped above
constexpr double kLeastBlockSigma = 1. / 255.;  // of a block's mean [grey value]
constexpr double kCauchy = 2.385;               // residual at which weights are a half [sigma]
constexpr int kRounds = 10;                     // of weights
constexpr double kByChance = 9.;                // squared difference [variances]
constexpr double kGainSigma = 0.1;              // of the change from image to image
constexpr double kOffsetSigma = 0.003;
constexpr double kMostChange = 2.;  // factor on the gain from image to image

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

double robustSigmaOf(const std::vector<BlockMeans>& blocks, const Vector2d& exposure) {
    std::vector<double> residuals;
    residuals.reserve(blocks.size());
    for (const BlockMeans& b : blocks) {
        residuals.push_back(std::abs(b.observed - exposure[0] * b.predicted - exposure[1]));
    }
    const auto middle = residuals.begin() + static_cast<std::ptrdiff_t>(residuals.size() / 2);
    std::nth_element(residuals.begin(), middle, residuals.end());
    return std::max(kLeastBlockSigma, 1.4826 * *middle);
}

}  // namespace

Exposure fittedExposure(const ImageF& observed, const View& predicted, const Exposure& last) {
    if (observed.getSize() != predicted.intensity.getSize() ||
        observed.getWidth() != predicted.intensity.getWidth()) {
        throw std::invalid_argument("exposure: image and view differ in size");
    }
    const std::vector<BlockMeans> blocks = blockMeans(observed, predicted);
    if (blocks.empty()) return last;
    const Vector2d before{last.gain, last.offset};
    const Matrix2d prior =
        Vector2d(1. / (kGainSigma * kGainSigma), 1. / (kOffsetSigma * kOffsetSigma)).asDiagonal();
    Vector2d exposure = before;
    Matrix2d information = prior;
    for (int round = 0; round < kRounds; ++round) {
        const double sigma = robustSigmaOf(blocks, exposure);
        information = prior;
        Vector2d right = Vector2d::Zero();
        for (const BlockMeans& b : blocks) {
            const Vector2d a{b.predicted, 1.};
            const double residual = b.observed - a.dot(exposure);
            const double weight = 1. / (1. + std::pow(residual / (kCauchy * sigma), 2));
            information += weight / (sigma * sigma) * a * a.transpose();
            right += weight / (sigma * sigma) * (b.observed - a.dot(before)) * a;
        }
        exposure = before + information.ldlt().solve(right);
    }
    const Vector2d change = exposure - before;
    const double factor = exposure[0] / last.gain;
    const bool isPlausible = factor < kMostChange && factor * kMostChange > 1.;
    const bool isChance = change.dot(information * change) < kByChance;
    return isPlausible && !isChance ? Exposure{exposure[0], exposure[1]} : last;
}

}  // namespace photonav
