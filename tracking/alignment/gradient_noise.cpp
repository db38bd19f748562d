// SPDX-License-Identifier: BSD-3-Clause
#include "alignment/gradient_noise.hpp"

#include <algorithm>

#include "geometry/eigensystem.hpp"

namespace photonav {
namespace {

constexpr double kMinNoise = 1e-8;    // variance of a gradient, to avoid division by 0
constexpr double kNoiseMargin = 1.2;  // for chance: pure noise then has no information
// Of V^T N V = 1. Where the points do not determine a pose (one point, points on a line), N has no
// inverse. Its factorisation may then divide by rounding errors and not fail.
constexpr double kMostError = 1e-6;

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
    if (points_ < 1. || e.count < 1.) return Matrix8::Identity();
    const auto variance = [&](double sum) {
        return kNoiseMargin * std::clamp(sum / e.count, kMinNoise, most);
    };
    const Matrix6 perPoint =
        (variance(notShared.x()) * ofX_ + variance(notShared.y()) * ofY_) / points_;
    const Matrix6 noise = e.AtA(7, 7) * (unit.asDiagonal() * perPoint * unit.asDiagonal());
    const auto [ratios, V] = eigensystem(e.AtA.topLeftCorner<6, 6>(), noise);
    const double error = (V.transpose() * noise * V - Matrix6::Identity()).norm();
    if (!(error < kMostError)) return Matrix8::Identity();
    const Vector6 kept = 1. - ratios.array().max(1.).inverse();
    Matrix8 D = Matrix8::Identity();
    D.topLeftCorner<6, 6>() = V * kept.asDiagonal() * V.transpose() * noise;
    e.AtA = D.transpose() * e.AtA * D;
    e.Atr = D.transpose() * e.Atr;
    return D;
}

}  // namespace photonav
