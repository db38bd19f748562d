// SPDX-License-Identifier: BSD-3-Clause
#include "alignment/alignment.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <array>
#include <cmath>

#include "alignment/residual_covariance.hpp"

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
        if (open[i]) names.emplace_back(kAxes.at(i));
    }
    return names;
}

Matrix6 covarianceWithoutPrior(const Spectrum& s) {
    const Vector6 variance = s.values.cwiseMax(1.).cwiseInverse();
    const Matrix6 V = s.unit.asDiagonal() * s.directions;
    return V * variance.asDiagonal() * V.transpose();
}

bool isAtLimit(double gain, double most) { return gain > 0.999 * most || gain * most < 1.001; }

}  // namespace

std::string describe(const Alignment& a, const TrustOptions& options) {
    switch (a.verdict) {
        case Verdict::converged:
            return "converged";
        case Verdict::degenerate:
            if (a.openDirections.size() == kAxes.size()) return "degenerate along all axes";
            return fmt::format("degenerate along {}", fmt::join(a.openDirections, ", "));
        case Verdict::lostOverlap:
            return fmt::format("lost: overlap {:.2f} below {:.2f}", a.overlap, options.minOverlap);
        case Verdict::lostResidual:
            return fmt::format("lost: {:.0f} % of the image unexplained, residual {:.3f}",
                               100. * a.residual.unexplainedCoarse(), a.residual.rms);
        case Verdict::lostImplausible:
            return "lost: the best pose is not one that the prior allows";
        case Verdict::lostExposure:
            return fmt::format("lost: brightness would have to change by a factor of {:.2f}",
                               a.exposure.gain);
        case Verdict::lostDivergence:
            break;
    }
    return fmt::format("lost: no minimum after {} iterations", a.iterations);
}

PoseEquations poseEquations(const NormalEquations& equations, const PhotometricOptions& options,
                            const std::optional<ExposurePrior>& prior, const Exposure& exposure) {
    const double weight = options.scale / (options.sigma * options.sigma);
    PoseEquations p;
    p.information = weight * equations.AtA.topLeftCorner<6, 6>();
    p.right = weight * equations.Atr.head<6>();
    if (!prior) return p;
    const Eigen::Vector2d known = prior->information();
    const Eigen::Vector2d atLeast =
        known.cwiseMax(Eigen::Vector2d::Constant(1. / (kExposureSigma * kExposureSigma)));
    Eigen::Matrix2d ofExposure = weight * equations.AtA.bottomRightCorner<2, 2>();
    ofExposure.diagonal() += atLeast;
    const Eigen::Matrix2d inverse = ofExposure.inverse();
    const Eigen::Vector2d right =
        weight * equations.Atr.tail<2>() - known.cwiseProduct(ExposurePrior::difference(exposure));
    const Eigen::Matrix<double, 2, 6> coupling = weight * equations.AtA.bottomLeftCorner<2, 6>();
    p.exposureOfPose = inverse * coupling;
    p.exposureRight = inverse * right;
    p.information -= coupling.transpose() * p.exposureOfPose;
    p.right -= coupling.transpose() * p.exposureRight;
    p.information = 0.5 * (p.information + p.information.transpose()).eval();
    return p;
}

Spectrum spectrum(const Matrix6& information, double meanDepth) {
    Spectrum s;
    s.unit << Eigen::Vector3d::Constant(meanDepth), Eigen::Vector3d::Ones();
    const Eigen::SelfAdjointEigenSolver<Matrix6> solver(s.unit.asDiagonal() * information *
                                                        s.unit.asDiagonal());
    s.values = solver.eigenvalues();
    s.directions = solver.eigenvectors();
    return s;
}

Vector6 imageStep(const Spectrum& s, const Vector6& right, double minEigenvalue, double damping) {
    const double raise = damping * s.values.mean();
    Vector6 along = s.directions.transpose() * s.unit.cwiseProduct(right);
    for (int i = 0; i < 6; ++i)
        along[i] = s.values[i] > minEigenvalue ? along[i] / (s.values[i] + raise) : 0.;
    return s.unit.cwiseProduct(s.directions * along);
}

Vector6 posteriorStep(const Spectrum& s, const PoseEquations& equations, const Vector6& e,
                      const Matrix6& P, double damping) {
    Matrix6 information = equations.information;
    information.diagonal() += damping * s.values.mean() * s.unit.cwiseAbs2().cwiseInverse();
    const Matrix6 left = Matrix6::Identity() + P * information;
    return left.partialPivLu().solve(P * equations.right - e);
}

void conclude(Alignment& a, const NormalEquations& equations, std::size_t pixels,
              const MeasuredInformation& image, double sigma, double finer,
              bool isExposureEstimated, const std::optional<Matrix6>& prior,
              const TrustOptions& options) {
    a.overlap = equations.count / static_cast<double>(pixels);
    a.residual = statisticsOf(equations, a.exposure);
    a.residual.finer = finer;
    a.meanDepth = equations.meanInverseDepth > 0. ? 1. / equations.meanInverseDepth : 1.;
    a.information = image.equations.information;
    const Spectrum s = spectrum(a.information, a.meanDepth);
    a.eigenvalues = s.values;
    a.directions = s.directions;
    const Matrix6 covariance = prior ? posteriorCovariance(*prior, a.information, image.repeating)
                                     : covarianceWithoutPrior(s);
    a.covariance = withLeastSigma(covariance, options.leastSigma, options.leastSigmaRotation);
    const double least = 1. / (options.openSigma * options.openSigma);
    const int open = static_cast<int>((s.values.array() < least).count());
    a.openDirections = axesOf(s.directions, open);

    const double noise = options.residualSigmas * sigma;
    if (a.overlap < options.minOverlap) {
        a.verdict = Verdict::lostOverlap;
    } else if (a.residual.rms > noise && a.residual.unexplainedCoarse() > options.maxUnexplained) {
        a.verdict = Verdict::lostResidual;
    } else if (isExposureEstimated && isAtLimit(a.exposure.gain, options.maxGain)) {
        a.verdict = Verdict::lostExposure;
    } else if (!isLost(a.verdict)) {
        a.verdict = open > 0 ? Verdict::degenerate : Verdict::converged;
    }
}

Matrix6 withLeastSigma(const Matrix6& covariance, double translation, double rotation) {
    if (!(translation > 0. || rotation > 0.)) return covariance;
    constexpr double kNegligible = 1e-6;  // of the one that is not given [m], [rad]
    Vector6 least;
    least << Eigen::Vector3d::Constant(std::max(translation, kNegligible)),
        Eigen::Vector3d::Constant(std::max(rotation, kNegligible));
    return larger(covariance, least.cwiseAbs2().asDiagonal());
}

double squaredDistance(const Vector6& e, const Matrix6& covariance) {
    Matrix6 raised = covariance;
    for (int block = 0; block < 6; block += 3) {  // m^2 and rad^2 do not mix
        auto diagonal = raised.diagonal().segment<3>(block);
        diagonal.array() += 1e-6 * diagonal.maxCoeff() + 1e-18;
    }
    return e.dot(raised.ldlt().solve(e));
}

}  // namespace photonav
