// SPDX-License-Identifier: BSD-3-Clause
#include "jacobian_check.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "alignment.hpp"
#include "se3.hpp"

namespace photonav {
namespace {

constexpr double kRelevant = 0.02;    // information, in units of the prior's: less changes nothing
constexpr double kSuspicious = 1e-3;  // share of the largest eigenvalue that J may be wrong by
constexpr double kLongest = 0.1;      // walk [mean depths, rad]
constexpr double kAside = 0.02;       // share of a claim that others need to be walked along
constexpr int kTurns = 5;             // walks along a direction, each from where the last one led
constexpr double kLeastChange = 0.5;  // of what was told; true claims are at 0.9 to 1.2
constexpr double kNothing = 1e-4;     // of the same
constexpr double kLeastSeen = 0.8;    // of the pixels: what is no longer in view is not the same

/// What J claims to tell, in coordinates w of the pose, xi = L w, in which the prior is 1.
class Claims {
  public:
    Claims(const Matrix6& AtA, const std::optional<Matrix6>& prior, double depth) {
        const Spectrum s = spectrum(AtA, depth);
        unit_ = s.unit;
        most_ = s.values[5];
        Matrix6 P = unit_.cwiseAbs2().asDiagonal();
        // A prior may be certain of some directions: by as little as does not matter, it is not.
        if (prior) P = *prior + 1e-10 * P;
        L_ = P.llt().matrixL();
        const Eigen::SelfAdjointEigenSolver<Matrix6> solver(L_.transpose() * AtA * L_);
        told_ = solver.eigenvalues();
        directions_ = L_ * solver.eigenvectors();
    }

    bool isSuspicious(int i) const {
        return told_[i] > kRelevant &&
               told_[i] < kSuspicious * most_ * std::pow(length(along(i)), 2);
    }

    /// Displacement along direction i: one standard deviation by the claim, but not too far.
    double step(int i) const {
        return std::min(1. / std::sqrt(told_[i]), kLongest / length(along(i)));
    }
    Vector6 along(int i) const { return directions_.col(i); }
    double told(int i) const { return told_[i]; }
    /// [mean depths, rad]
    double length(const Vector6& xi) const { return xi.cwiseQuotient(unit_).norm(); }

    /// What brings the image back, along other directions that are told at least about as loudly.
    Vector6 aside(int i, const Vector6& right) const {
        Vector6 w = directions_.transpose() * right;
        for (int k = 0; k < 6; ++k) {
            w[k] = k != i && told_[k] > kAside * told_[i] ? w[k] / told_[k] : 0.;
        }
        return directions_ * w;
    }

    /// 1 - n n^T in the coordinates of the prior, for the direction n of a displacement.
    Matrix6 without(const Vector6& xi) const {
        const Vector6 n = L_.triangularView<Eigen::Lower>().solve(xi).normalized();
        return Matrix6::Identity() -
               (L_ * n) * L_.transpose().triangularView<Eigen::Upper>().solve(n).transpose();
    }

  private:
    Vector6 unit_;  // (depth x 3, 1 x 3)
    double most_;   // eigenvalue, in those units
    Matrix6 L_;
    Vector6 told_;
    Matrix6 directions_;
};

using Walk = std::function<NormalEquations(const Pose& T_away_here)>;

/// Where a walk along direction i ends, if what is seen there is the same, and not less.
std::optional<Vector6> findSame(const Claims& claims, int i, double side, double count,
                                const Walk& walk) {
    const double told = std::pow(claims.step(i), 2) * claims.told(i);
    Pose T_away_here = expSE3(side * claims.step(i) * claims.along(i));
    NormalEquations seen = walk(T_away_here);
    for (int turn = 1; turn < kTurns && seen.loss > kNothing * told; ++turn) {
        T_away_here = expSE3(claims.aside(i, seen.Atr.head<6>())) * T_away_here;
        seen = walk(T_away_here);
    }
    const bool isSame = seen.loss < kLeastChange * told && seen.count > kLeastSeen * count;
    if (!isSame) return {};
    return logSE3(T_away_here);
}

/// A direction along which nothing changes, though it should. The loudest first: the others are
/// mixed with it where they are told about as loudly.
std::optional<Vector6> findFalse(const Claims& claims, double count, const Walk& walk) {
    for (int i = 6; i-- > 0;) {
        if (!claims.isSuspicious(i)) continue;
        const auto ahead = findSame(claims, i, 1., count, walk);
        if (ahead && findSame(claims, i, -1., count, walk)) return ahead;
    }
    return {};
}

}  // namespace

Matrix6 verifiedDirections(const NormalEquations& here, const std::optional<Matrix6>& prior,
                           const Walk& walk) {
    const Matrix6 AtA = here.AtA.topLeftCorner<6, 6>();
    Matrix6 M = Matrix6::Identity();
    for (int k = 0; k < 6; ++k) {
        const Claims claims(M.transpose() * AtA * M, prior, 1. / here.meanInverseDepth);
        const auto xi = findFalse(claims, here.count, walk);
        if (!xi) break;
        M = M * claims.without(*xi);
    }
    return M;
}

}  // namespace photonav
