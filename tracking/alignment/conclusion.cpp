// SPDX-License-Identifier: BSD-3-Clause
#include "alignment/conclusion.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace photonav {
namespace {

ResidualStatistics statisticsOf(const NormalEquations& e, const Exposure& exposure) {
    ResidualStatistics s;
    if (e.count < 1.) return s;
    const double n = e.count;
    s.mean = e.sum / n;
    s.rms = std::sqrt(e.sumSquares / n);
    const double meanI = e.sumPredicted / n;
    const double g = exposure.gain;
    const double varianceI = e.sumPredictedSquares / n - meanI * meanI;
    const double varianceR = e.sumSquares / n - s.mean * s.mean;
    const double covariance = e.sumPredictedTimesR / n - meanI * s.mean;
    const double variance = varianceR + 2. * g * covariance + g * g * varianceI;  // of the image
    const double both = variance + g * g * varianceI;
    s.explained = variance - e.sumSquares / n;
    // Two uniform images are either equal or unrelated.
    const double without = e.sumSquares > 0. ? 1. : 0.;
    s.unexplained = both > 0. ? std::min(1., e.sumSquares / n / both) : without;
    return s;
}

/// Least squares of residuals that are the variance of the blur times b (BlurSums). The pose is
/// left out: gradients and Laplacian are hardly correlated.
void estimateBlur(const NormalEquations& e, const PhotometricOptions& photometric, Alignment& a) {
    if (!(e.byBlur.btb > 0.) || e.count < 1.) return;
    const double noise = std::max(photometric.sigma * photometric.sigma, e.sumSquares / e.count);
    a.blur = e.byBlur.btr / e.byBlur.btb;
    a.blurSigma = std::sqrt(noise / photometric.scale / e.byBlur.btb);
}

/// Axes that lie most in the space spanned by the first `count` columns: pivots of the projector.
std::vector<std::string> axesOf(const Matrix6& directions, int count) {
    Matrix6 projector = directions.leftCols(count) * directions.leftCols(count).transpose();
    std::array<bool, 6> open = {};
    for (int k = 0; k < count; ++k) {
        Eigen::Index axis = 0;
        projector.diagonal().maxCoeff(&axis);
        open[static_cast<std::size_t>(axis)] = true;
        const Vector6 column = projector.col(axis) / std::sqrt(projector(axis, axis));
        projector -= column * column.transpose();
    }
    std::vector<std::string> names;
    for (std::size_t i = 0; i < open.size(); ++i) {
        if (open[i]) names.emplace_back(kTwistAxes.at(i));
    }
    return names;
}

Matrix6 covarianceWithoutPrior(const Spectrum& s) {
    const Vector6 variance = s.values.cwiseMax(1.).cwiseInverse();
    const Matrix6 V = s.unit.asDiagonal() * s.directions;
    return V * variance.asDiagonal() * V.transpose();
}

bool isAtLimit(double gain, double most) { return gain > 0.999 * most || gain * most < 1.001; }

/// Without open directions.
Verdict verdictOf(const Alignment& a, const AlignmentOptions& options) {
    const TrustOptions& trust = options.trust;
    if (a.overlap < trust.minOverlap) return Verdict::lostOverlap;
    const double noise = trust.residualSigmas * options.photometric.sigma;
    if (a.residual.rms > noise && a.residual.unexplainedCoarse() > trust.maxUnexplained) {
        return Verdict::lostResidual;
    }
    if (options.exposure && isAtLimit(a.exposure.gain, trust.maxGain)) return Verdict::lostExposure;
    return a.verdict;
}

}  // namespace

void conclude(Alignment& a, const LastIterate& last, const AlignmentOptions& options) {
    a.overlap = last.equations.count / static_cast<double>(last.pixels);
    a.residual = statisticsOf(last.equations, a.exposure);
    a.residual.finer = last.finer;
    estimateBlur(last.equations, options.photometric, a);
    const double meanInverseDepth = last.equations.meanInverseDepth;
    a.meanDepth = meanInverseDepth > 0. ? 1. / meanInverseDepth : 1.;
    a.information = last.image.equations.information;
    const Spectrum s = spectrum(a.information, a.meanDepth);
    a.eigenvalues = s.values;
    a.directions = s.directions;
    const TrustOptions& trust = options.trust;
    const Matrix6 covariance =
        last.prior ? posteriorCovariance(*last.prior, a.information, last.image.repeating)
                   : covarianceWithoutPrior(s);
    a.covariance = withLeastSigma(covariance, trust.leastSigma, trust.leastSigmaRotation);
    const double least = 1. / (trust.openSigma * trust.openSigma);
    const int open = static_cast<int>((s.values.array() < least).count());
    a.openDirections = axesOf(s.directions, open);
    a.verdict = verdictOf(a, options);
    if (!isLost(a.verdict)) a.verdict = open > 0 ? Verdict::degenerate : Verdict::converged;
}

}  // namespace photonav
