// SPDX-License-Identifier: BSD-3-Clause
#include "alignment/alignment.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "alignment/residual_covariance.hpp"
#include "geometry/eigensystem.hpp"

namespace photonav {

std::string describe(const Alignment& a, const TrustOptions& options) {
    switch (a.verdict) {
        case Verdict::converged:
            return "converged";
        case Verdict::degenerate:
            if (a.openDirections.size() == kTwistAxes.size()) return "degenerate along all axes";
            return fmt::format("degenerate along {}", fmt::join(a.openDirections, ", "));
        case Verdict::lostOverlap:
            return fmt::format("lost: overlap {:.2f} below {:.2f}", a.overlap, options.minOverlap);
        case Verdict::lostResidual:
            return fmt::format("lost: {:.0f} % of the image unexplained, residual {:.3f}",
                               100. * a.residual.unexplainedCoarse(), a.residual.rms);
        case Verdict::lostTexture:
            return fmt::format("lost: {:.0f} % of the texture is where the model has it",
                               100. * std::max(0., a.residual.texture->share));
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
    p.rhs = weight * equations.Atr.head<6>();
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
    p.exposureRhs = inverse * right;
    p.information -= coupling.transpose() * p.exposureOfPose;
    p.rhs -= coupling.transpose() * p.exposureRhs;
    p.information = 0.5 * (p.information + p.information.transpose()).eval();
    return p;
}

Spectrum spectrum(const Matrix6& information, double meanDepth) {
    Spectrum s;
    s.unit << Eigen::Vector3d::Constant(meanDepth), Eigen::Vector3d::Ones();
    const auto [values, vectors] =
        eigensystem(s.unit.asDiagonal() * information * s.unit.asDiagonal());
    s.values = values;
    s.directions = vectors;
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
    return left.partialPivLu().solve(P * equations.rhs - e);
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
