// SPDX-License-Identifier: BSD-3-Clause
#include "flight/arrival.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <numeric>
#include <random>

#include "geometry/eigensystem.hpp"
#include "geometry/se3.hpp"

namespace photonav {
namespace {

constexpr std::size_t kCorrections = 10;  // that are remembered
constexpr double kLeastReduction = 0.1;   // share of the variance of a direction that counts
constexpr int kDraws = 20000;

}  // namespace

PositionBelief bodyPosition(const UncertainPose& T_c_w, const Pose& T_b_c) {
    const Eigen::Vector3d p_c = T_b_c.inverse().translation();
    const Pose T_w_c = T_c_w.mean.inverse();
    // T_w_c exp(-xi^) p_c to first order
    Eigen::Matrix<double, 3, 6> J;
    J << -Eigen::Matrix3d::Identity(), hat(p_c);
    J = T_w_c.linear() * J;
    return {T_w_c * p_c, J * T_c_w.covariance * J.transpose()};
}

double probabilityWithin(const PositionBelief& position, const Eigen::Vector3d& place_w,
                         double radius) {
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(position.covariance);
    const Eigen::Vector3d sigma = solver.eigenvalues().cwiseMax(0.).cwiseSqrt();
    const Eigen::Vector3d offset = solver.eigenvectors().transpose() * (position.mean_w - place_w);
    std::mt19937_64 random(1);
    std::normal_distribution<double> normal;
    int within = 0;
    for (int i = 0; i < kDraws; ++i) {
        const Eigen::Vector3d z(normal(random), normal(random), normal(random));
        within += (offset + sigma.cwiseProduct(z)).norm() <= radius;
    }
    return static_cast<double>(within) / kDraws;
}

std::optional<double> squaredCorrection(const UncertainPose& prior,
                                        const UncertainPose& posterior) {
    const Eigen::LLT<Matrix6> factor(prior.covariance);
    if (factor.info() != Eigen::Success) return {};
    const auto L = factor.matrixL();
    const Matrix6 half = L.solve(prior.covariance - posterior.covariance);
    const Matrix6 reduction = L.solve(Matrix6(half.transpose()));
    const auto [shares, directions] = eigensystem(reduction);
    const Vector6 e = L.solve(deviation(posterior.mean, prior.mean));
    const Vector6 along = directions.transpose() * e;
    double sum = 0.;
    int degrees = 0;
    for (int i = 0; i < 6; ++i) {
        const double share = shares[i];
        if (!(share > kLeastReduction)) continue;
        sum += along[i] * along[i] / share;
        ++degrees;
    }
    if (degrees == 0) return {};
    return sum / degrees;
}

void Corrections::add(const TrackedFrame& frame) {
    if (frame.rejected) return;
    const auto squared = squaredCorrection(frame.predicted, frame.T_c_w);
    if (!squared) return;
    last_.push_back(*squared);
    if (last_.size() > kCorrections) last_.pop_front();
}

double Corrections::varianceFactor() const {
    if (last_.empty()) return 1.;
    const double sum = std::accumulate(last_.begin(), last_.end(), 0.);
    return std::max(1., sum / static_cast<double>(last_.size()));
}

BelievedArrival believedArrival(const UncertainPose& T_c_w, const Pose& T_b_c,
                                const Corrections& corrections, const Eigen::Vector3d& goal_w,
                                double tolerance) {
    PositionBelief position = bodyPosition(T_c_w, T_b_c);
    position.covariance *= corrections.varianceFactor();
    return {position, probabilityWithin(position, goal_w, tolerance)};
}

}  // namespace photonav
