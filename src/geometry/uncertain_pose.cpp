// SPDX-License-Identifier: BSD-3-Clause
#include "geometry/uncertain_pose.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "geometry/se3.hpp"

namespace photonav {

namespace {

/// A 3x3 matrix with a row and a column of zeros, because four doubles fill vector registers.
using Padded = Eigen::Matrix4d;

/// A covariance by its blocks [P, R; R^T, S]; P and S are symmetric.
struct Blocks {
    Padded P = Padded::Zero();
    Padded R = Padded::Zero();
    Padded S = Padded::Zero();

    Blocks() = default;
    explicit Blocks(const Matrix6& m) {
        P.topLeftCorner<3, 3>() = m.topLeftCorner<3, 3>();
        R.topLeftCorner<3, 3>() = m.topRightCorner<3, 3>();
        S.topLeftCorner<3, 3>() = m.bottomRightCorner<3, 3>();
    }

    Matrix6 matrix() const {
        Matrix6 m;
        m.topLeftCorner<3, 3>() = P.topLeftCorner<3, 3>();
        m.topRightCorner<3, 3>() = R.topLeftCorner<3, 3>();
        m.bottomLeftCorner<3, 3>() = R.topLeftCorner<3, 3>().transpose();
        m.bottomRightCorner<3, 3>() = S.topLeftCorner<3, 3>();
        return m;
    }
};

Padded symmetricSum(const Padded& M) { return M + M.transpose(); }

/// tr(A^T B)
double dot(const Padded& A, const Padded& B) { return A.cwiseProduct(B).sum(); }

Matrix6 transport(const Matrix6& Ad, const Matrix6& covariance) {
    const Matrix6 carried = Ad * covariance * Ad.transpose();
    return 0.5 * (carried + carried.transpose());
}

/// BF14's A and B terms, multiplied out and collected by products: 9 instead of the 36 of the
/// formula as printed. Note <<A, B>> = <<A>><<B>> + <<BA>>: a sum.
Blocks collectedFourthOrderTerms(const Blocks& a, const Blocks& b) {
    const double sa = a.S.trace(), ra = a.R.trace(), pa = a.P.trace();
    const double sb = b.S.trace(), rb = b.R.trace(), pb = b.P.trace();
    const Padded aRt = a.R.transpose();
    const Padded bRt = b.R.transpose();
    const auto addToDiagonal = [](Padded& M, double x) { M.diagonal().head<3>().array() += x; };

    Blocks f;
    f.S = 5. / 12. * (symmetricSum(a.S * b.S) - sa * b.S - sb * a.S);
    addToDiagonal(f.S, 0.25 * (sa * sb - dot(a.S, b.S)));

    const Padded aLeft = 1. / 12. * a.R + 0.25 * aRt;
    const Padded bLeft = 1. / 12. * b.R + 0.25 * bRt;
    const Padded aRight = 1. / 6. * a.R + 1. / 3. * aRt;
    const Padded bRight = 1. / 6. * b.R + 1. / 3. * bRt;
    f.R.noalias() = a.S * bLeft;
    f.R.noalias() += bRight * a.S;
    f.R.noalias() += b.S * aLeft;
    f.R.noalias() += aRight * b.S;
    f.R -= sa * (1. / 6. * b.R + 0.25 * bRt) + sb * (1. / 6. * a.R + 0.25 * aRt) +
           5. / 12. * (ra * b.S + rb * a.S);
    addToDiagonal(f.R, 0.25 * (sa * rb + sb * ra - dot(b.R, a.S) - dot(a.R, b.S)));

    Padded half = -5. / 12. * (ra * b.R + rb * a.R);
    half.noalias() += 1. / 3. * a.S * b.P;
    half.noalias() += 1. / 3. * b.S * a.P;
    half.noalias() += a.R * Padded(5. / 12. * bRt + 1. / 12. * b.R);
    half.noalias() += aRt * Padded(0.25 * b.R + 1. / 12. * bRt);
    f.P = symmetricSum(half) - 5. / 12. * (sa * b.P + sb * a.P) - 0.25 * (pb * a.S + pa * b.S);
    addToDiagonal(f.P, 0.25 * (sa * pb + sb * pa - dot(a.S, b.P) - dot(a.P, b.S)) +
                           0.5 * (ra * rb - dot(a.R, b.R)));
    return f;
}

/// Whether the LDL^T pivots of m are positive once the diagonal is raised by 1e-12 of the largest
/// variance of its block, in units of its own: m^2 and rad^2 do not mix. NaN is not.
bool isPositiveSemidefinite(const Matrix6& m) {
    constexpr double kTolerance = 1e-12;
    constexpr double kTiny = 1e-290;  // keeps an all-zero block solvable
    const double shiftP = kTolerance * std::max({m(0, 0), m(1, 1), m(2, 2)}) + kTiny;
    const double shiftS = kTolerance * std::max({m(3, 3), m(4, 4), m(5, 5)}) + kTiny;
    Matrix6 a = m;
    bool positive = true;
    for (int k = 0; k < 6; ++k) {
        const double pivot = a(k, k) + (k < 3 ? shiftP : shiftS);
        positive = positive && pivot > 0.;
        const double inverse = 1. / pivot;
        for (int j = k + 1; j < 6; ++j) {
            const double factor = a(j, k) * inverse;
            for (int i = j; i < 6; ++i) a(i, j) -= factor * a(i, k);
        }
    }
    return positive;
}

}  // namespace

Matrix6 fourthOrderTerms(const Matrix6& first, const Matrix6& second) {
    return collectedFourthOrderTerms(Blocks(first), Blocks(second)).matrix();
}

CompoundedCovariance compoundCovariance(const Matrix6& adjointMotion, const Matrix6& motion,
                                        const Matrix6& prior, PropagationOrder order) {
    const Matrix6 carried = transport(adjointMotion, prior);
    const Matrix6 second = motion + carried;
    if (order == PropagationOrder::second) return {second, false};

    constexpr double kMaxVariance = kFourthOrderMaxRotationSigma * kFourthOrderMaxRotationSigma;
    if (motion.diagonal().tail<3>().sum() <= kMaxVariance &&
        carried.diagonal().tail<3>().sum() <= kMaxVariance) {
        const Matrix6 fourth = second + fourthOrderTerms(motion, carried);
        if (isPositiveSemidefinite(fourth)) return {fourth, false};
    }
    return {second, true};
}

UncertainPose compound(const UncertainPose& T_c_b, const UncertainPose& T_b_a,
                       PropagationOrder order) {
    return {T_c_b.mean * T_b_a.mean,
            compoundCovariance(adjoint(T_c_b.mean), T_c_b.covariance, T_b_a.covariance, order)
                .covariance};
}

Matrix6 inOtherFrame(const Matrix6& covariance, const Pose& T_b_a) {
    return transport(adjoint(T_b_a), covariance);
}

UncertainPose inverse(const UncertainPose& T_b_a) {
    const Pose T_a_b = T_b_a.mean.inverse();
    return {T_a_b, inOtherFrame(T_b_a.covariance, T_a_b)};
}

Matrix6 updateCovariance(const Matrix6& covariance, const Matrix6& information) {
    // Gaussian elimination of [1 + covariance information | covariance] with partial pivoting, by
    // whole rows, which fill vector registers.
    constexpr int kColumns = 12;
    alignas(64) double a[6][kColumns];
    for (int i = 0; i < 6; ++i) {
        for (int j = 0; j < 6; ++j) a[i][j] = i == j ? 1. : 0.;
        for (int k = 0; k < 6; ++k) {
            for (int j = 0; j < 6; ++j) a[i][j] += covariance(k, i) * information(j, k);
        }
        for (int j = 0; j < 6; ++j) a[i][6 + j] = covariance(j, i);
    }
    for (int k = 0; k < 6; ++k) {
        int pivot = k;
        for (int i = k + 1; i < 6; ++i) {
            if (std::abs(a[i][k]) > std::abs(a[pivot][k])) pivot = i;
        }
        if (pivot != k) std::swap(a[pivot], a[k]);
        const double inverse = 1. / a[k][k];
        for (int i = k + 1; i < 6; ++i) {
            const double factor = a[i][k] * inverse;
            for (int j = 0; j < kColumns; ++j) a[i][j] -= factor * a[k][j];
        }
    }
    Matrix6 x;
    for (int k = 5; k >= 0; --k) {
        double row[6];
        for (int j = 0; j < 6; ++j) row[j] = a[k][6 + j];
        for (int i = k + 1; i < 6; ++i) {
            for (int j = 0; j < 6; ++j) row[j] -= a[k][i] * x(j, i);
        }
        const double inverse = 1. / a[k][k];
        for (int j = 0; j < 6; ++j) x(j, k) = row[j] * inverse;
    }
    return 0.5 * (x + x.transpose());
}

Vector6 deviation(const Pose& T_c_w, const Pose& T_mean_w) {
    const Pose T_c_mean = T_c_w * T_mean_w.inverse();
    Vector6 e = logSE3(T_c_mean);
    e.head<3>() = T_c_mean.translation();
    return e;
}

Matrix6 transported(const Matrix6& covariance, const Vector6& e) {
    Vector6 turn = Vector6::Zero();
    turn.tail<3>() = e.tail<3>();
    Matrix6 J = leftJacobian(turn);
    J.topLeftCorner<3, 3>() = expSE3(turn).linear();
    return J * covariance * J.transpose();
}

bool isCovariance(const Matrix6& matrix) {
    if (!matrix.allFinite()) return false;
    const double scale = matrix.cwiseAbs().maxCoeff();
    const double asymmetry = (matrix - matrix.transpose()).cwiseAbs().maxCoeff();
    return asymmetry <= 1e-12 * scale && isPositiveSemidefinite(matrix);
}

double weightedTrace(const Matrix6& covariance, double characteristicLength) {
    return covariance.diagonal().head<3>().sum() +
           characteristicLength * characteristicLength * covariance.diagonal().tail<3>().sum();
}

}  // namespace photonav
