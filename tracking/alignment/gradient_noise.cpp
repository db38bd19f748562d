// SPDX-License-Identifier: BSD-3-Clause
#include "alignment/gradient_noise.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>

namespace photonav {
namespace {

constexpr double kMinNoise = 1e-8;    // variance of a gradient, to avoid division by 0
constexpr double kNoiseMargin = 1.2;  // for chance: pure noise then has no information

}  // namespace

/// With (du, dv) = D xi in units of the focal length and with the signs of ViewComparison.
void GradientNoise::add(double x, double y, double w) {
    const Vector6 du{{w, 0., x * w, x * y, x * x + 1., -y}};
    const Vector6 dv{{0., w, y * w, y * y + 1., x * y, x}};
    ofX_ += du * du.transpose();
    ofY_ += dv * dv.transpose();
    ++points_;
}

Matrix8 GradientNoise::subtractFrom(NormalEquations& e, const Eigen::Vector2d& notShared,
                                    double most, const Vector6& unit) const {
    // Two equations a point, six unknowns: of fewer points the noise has no inverse.
    if (points_ < 3. || e.count < 1.) return Matrix8::Identity();
    const auto variance = [&](double sum) {
        return kNoiseMargin * std::clamp(sum / e.count, kMinNoise, most);
    };
    const Matrix6 perPoint =
        (variance(notShared.x()) * ofX_ + variance(notShared.y()) * ofY_) / points_;
    const Matrix6 noise = e.AtA(7, 7) * (unit.asDiagonal() * perPoint * unit.asDiagonal());
    const Eigen::GeneralizedSelfAdjointEigenSolver<Matrix6> solver(e.AtA.topLeftCorner<6, 6>(),
                                                                   noise);
    const Vector6 kept = 1. - solver.eigenvalues().array().max(1.).inverse();
    if (!kept.allFinite()) return Matrix8::Identity();
    Matrix8 D = Matrix8::Identity();
    D.topLeftCorner<6, 6>() =
        solver.eigenvectors() * kept.asDiagonal() * solver.eigenvectors().transpose() * noise;
    e.AtA = D.transpose() * e.AtA * D;
    e.Atr = D.transpose() * e.Atr;
    return D;
}

}  // namespace photonav
