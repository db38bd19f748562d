// SPDX-License-Identifier: BSD-3-Clause
#include "alignment/shared_gradients.hpp"

#include <algorithm>
#include <cmath>

#include "geometry/eigensystem.hpp"

namespace photonav {
namespace {

constexpr double kByChance = 3.;      // standard deviations
constexpr double kNoGradient = 1e-9;  // variance of a gradient that makes J^T J invertible
/// Squared standard deviation of a tile's share below which its weight does not grow.
constexpr double kClear = 0.1;
constexpr double kSurelyTexture = 2.;  // gradients, squared, relative to those of image noise
constexpr double kMostOfOneTile = 0.5;

/// Variance of v^T (shared - kappa model) v over as many tiles, each an independent draw.
double scatterAlong(const Vector6& v, const std::vector<GradientTile>& tiles, double kappa) {
    double variance = 0.;
    for (const GradientTile& tile : tiles) {
        const double left = TileMotion(tile).squared(tile.shared - kappa * tile.model, v);
        variance += left * left;
    }
    return variance;
}

/// The part of kappa that is not by chance; at most 1.
double certainly(double kappa, double variance) {
    const double chance = kByChance * kByChance * variance;
    if (kappa <= 0. || kappa * kappa <= chance) return 0.;
    return std::min(1., kappa - chance / kappa);
}

}  // namespace

SharedSlope sharedSlope(const std::vector<GradientTile>& tiles) {
    Matrix6 model = Matrix6::Zero(), shared = Matrix6::Zero();
    for (const GradientTile& tile : tiles) {
        const TileMotion motion(tile);
        model += motion.squared(tile.model + kNoGradient * Eigen::Matrix2d::Identity());
        shared += motion.squared(tile.shared);
    }
    auto [kappa, V] = eigensystem(shared, model);
    if (tiles.empty() || !V.allFinite()) return {};
    for (int i = 0; i < 6; ++i) {
        kappa[i] = certainly(kappa[i], scatterAlong(V.col(i), tiles, kappa[i]));
    }
    return {V * kappa.asDiagonal() * V.transpose() * model, kappa.minCoeff()};
}

std::optional<SharedTexture> sharedTexture(const std::vector<GradientTile>& tiles, double sigma,
                                           bool isModelNoisy) {
    const double noise = 2. * sigma * sigma;  // of central differences
    const auto weight = [&](const GradientTile& tile) {
        const double model = tile.model.trace(), ofNoise = 2. * noise * tile.pixels;
        if (isModelNoisy && model < kSurelyTexture * ofNoise) return 0.;
        return 1. / (kClear * std::max(model, tile.observed - ofNoise) + noise);
    };
    double model = 0., shared = 0.;
    for (const GradientTile& tile : tiles) {
        model += weight(tile) * tile.model.trace();
        shared += weight(tile) * tile.shared.trace();
    }
    if (!(model > 0.)) return {};
    const double share = shared / model;
    double variance = 0.;  // by leaving out one tile at a time
    for (const GradientTile& tile : tiles) {
        const double part = weight(tile) * tile.model.trace() / model;
        if (part > kMostOfOneTile) return {};
        const double rest = tile.shared.trace() - share * tile.model.trace();
        variance += std::pow(weight(tile) * rest / model / (1. - part), 2);
    }
    return SharedTexture{share, std::sqrt(variance)};
}

}  // namespace photonav
