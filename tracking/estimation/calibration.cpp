// SPDX-License-Identifier: BSD-3-Clause
#include "estimation/calibration.hpp"

#include <array>
#include <cmath>
#include <stdexcept>
#include <vector>

#include "alignment/residual_covariance.hpp"
#include "geometry/constants.hpp"

namespace photonav {
namespace {

Matrix6 covarianceOf(const AlignmentError& error, double scale, double leastSigma,
                     double leastSigmaRotation) {
    return withLeastSigma((scale * error.information).inverse(), leastSigma, leastSigmaRotation);
}

/// Mean of -2 log likelihood per degree of freedom, without the constant.
/// @param covariance of an error
template <class Covariance>
double misfit(std::span<const AlignmentError> errors, const Covariance& covariance) {
    double sum = 0.;
    for (const AlignmentError& e : errors) {
        const Eigen::LLT<Matrix6> factor(covariance(e));
        if (factor.info() != Eigen::Success) return kInfinity;
        const Matrix6 L = factor.matrixL();
        sum += factor.matrixL().solve(e.xi).squaredNorm() + 2. * L.diagonal().array().log().sum();
    }
    return sum / (6. * static_cast<double>(errors.size()));
}

double misfit(std::span<const AlignmentError> errors, double scale, double translation,
              double rotation) {
    return misfit(errors, [=](const AlignmentError& e) {
        return covarianceOf(e, scale, translation, rotation);
    });
}

void requireEnough(std::span<const AlignmentError> errors) {
    if (errors.size() < 20) throw std::invalid_argument("calibrate: fewer than 20 alignments");
}

/// 1 + 2 sum of the autocorrelation, summed until it is no longer positive: the number of images
/// that inform of a mean as much as one would if errors were independent.
double correlationTime(std::span<const AlignmentError> errors, const Calibration& c) {
    std::vector<Vector6> white;
    for (const AlignmentError& e : errors) {
        const Matrix6 covariance = covarianceOf(e, c.scale, c.leastSigma, c.leastSigmaRotation);
        white.push_back(covariance.llt().matrixL().solve(e.xi));
    }
    double time = 1.;
    for (std::size_t lag = 1; lag < white.size() / 2; ++lag) {
        double product = 0., square = 0.;
        for (std::size_t i = 0; i + lag < white.size(); ++i) {
            product += white[i].dot(white[i + lag]);
            square += white[i].squaredNorm();
        }
        if (product <= 0.) break;
        time += 2. * product / square;
    }
    return time;
}

/// Coordinate descent over logarithms, each step halved until a percent or so.
void descend(std::span<const AlignmentError> errors, std::array<double, 3>& parameters, int first,
             int end) {
    double best = misfit(errors, parameters[0], parameters[1], parameters[2]);
    for (double factor = 4.; factor > 1.01; factor = std::sqrt(factor)) {
        for (bool improved = true; improved;) {
            improved = false;
            for (int i = first; i < end; ++i) {
                for (const double by : {factor, 1. / factor}) {
                    std::array<double, 3> trial = parameters;
                    trial[i] *= by;
                    const double m = misfit(errors, trial[0], trial[1], trial[2]);
                    if (m >= best - 1e-9) continue;
                    best = m;
                    parameters = trial;
                    improved = true;
                }
            }
        }
    }
}

/// The scale, and the errors themselves as least sigmas.
std::array<double, 3> startOf(std::span<const AlignmentError> errors, double scale) {
    std::array<double, 3> start = {scale, 0., 0.};
    for (const AlignmentError& e : errors) {
        start[1] += e.xi.head<3>().squaredNorm();
        start[2] += e.xi.tail<3>().squaredNorm();
    }
    const double n = 3. * static_cast<double>(errors.size());
    start[1] = std::sqrt(start[1] / n);
    start[2] = std::sqrt(start[2] / n);
    return start;
}

}  // namespace

double neesPerDof(std::span<const AlignmentError> errors, double scale, double leastSigma,
                  double leastSigmaRotation) {
    double sum = 0.;
    for (const AlignmentError& e : errors) {
        const Matrix6 covariance = covarianceOf(e, scale, leastSigma, leastSigmaRotation);
        sum += e.xi.dot(covariance.ldlt().solve(e.xi)) / 6.;
    }
    return sum / static_cast<double>(errors.size());
}

Calibration calibrate(std::span<const AlignmentError> errors) {
    requireEnough(errors);
    Calibration result;
    result.neesBefore = neesPerDof(errors);
    // Without least sigmas the most likely scale is the one that makes the NEES one.
    result.scale = 1. / result.neesBefore;
    std::array<double, 3> withLeastSigmas = startOf(errors, 1.);
    descend(errors, withLeastSigmas, 0, 3);
    constexpr double kWorthwhile = 0.05;  // misfit per degree of freedom
    if (misfit(errors, withLeastSigmas[0], withLeastSigmas[1], withLeastSigmas[2]) <
        misfit(errors, result.scale, 0., 0.) - kWorthwhile) {
        result.scale = withLeastSigmas[0];
        result.leastSigma = withLeastSigmas[1];
        result.leastSigmaRotation = withLeastSigmas[2];
    }
    result.correlationTime = correlationTime(errors, result);
    result.neesAfter =
        neesPerDof(errors, result.scale, result.leastSigma, result.leastSigmaRotation);
    return result;
}

Calibration calibrateLeastSigma(std::span<const AlignmentError> errors, double scale) {
    requireEnough(errors);
    std::array<double, 3> withLeastSigmas = startOf(errors, scale);
    descend(errors, withLeastSigmas, 1, 3);
    Calibration result{scale, withLeastSigmas[1], withLeastSigmas[2]};
    result.neesBefore = neesPerDof(errors, scale);
    result.neesAfter = neesPerDof(errors, scale, withLeastSigmas[1], withLeastSigmas[2]);
    return result;
}

std::optional<double> calibrateDepthError(std::span<const AlignmentError> errors, double counted) {
    requireEnough(errors);
    constexpr double kLeast = 1e-3, kStep = 1.05;
    double best = 0., least = kInfinity;
    for (double share = 0.; share <= 1.; share = std::max(kLeast, kStep * share)) {
        const double m = misfit(errors, [&](const AlignmentError& e) -> Matrix6 {
            const Matrix6 without =
                e.information.inverse() - covarianceByScale(counted, e.sinceKeyframe);
            return without + covarianceByScale(share, e.sinceKeyframe) +
                   1e-14 * Matrix6::Identity();  // rounding of the difference
        });
        if (m < least) best = share;
        least = std::min(least, m);
    }
    if (least == kInfinity) return {};
    return best;
}

AlignmentOptions photographOptions(double blur) {
    AlignmentOptions options;
    options.measureCovariance = true;
    options.blur = blur;
    options.modelErrors.blur = kBlurError;
    return options;
}

AlignmentOptions realCameraOptions(double blur) {
    AlignmentOptions options = photographOptions(blur);
    options.exposure = {.gainSigma = 0.1, .offsetSigma = 0.003};
    options.modelErrors.light = kLightError;
    return options;
}

}  // namespace photonav
