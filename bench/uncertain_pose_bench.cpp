// SPDX-License-Identifier: BSD-3-Clause
// Compounding and update of 6x6 covariances against the formulas as printed, in plain Eigen.
#include <fmt/format.h>

#include "bench_arguments.hpp"
#include "geometry/se3.hpp"
#include "geometry/uncertain_pose.hpp"
#include "min_time.hpp"

using namespace photonav;

namespace {

using Eigen::Matrix3d;

Matrix3d bracket(const Matrix3d& A) { return A - A.trace() * Matrix3d::Identity(); }
Matrix3d bracket(const Matrix3d& A, const Matrix3d& B) {
    return bracket(A) * bracket(B) + bracket(Matrix3d(B * A));
}

Matrix6 secondOrder(const Matrix6& Ad, const Matrix6& S1, const Matrix6& prior) {
    return S1 + Ad * prior * Ad.transpose();
}

/// BF14 eq. (55) as printed.
Matrix6 fourthOrder(const Matrix6& Ad, const Matrix6& S1, const Matrix6& prior) {
    const Matrix6 S2 = Ad * prior * Ad.transpose();
    const auto A = [](const Matrix6& S) {
        const Matrix3d coupling = S.topRightCorner<3, 3>();
        Matrix6 a = Matrix6::Zero();
        a.topLeftCorner<3, 3>() = bracket(Matrix3d(S.bottomRightCorner<3, 3>()));
        a.bottomRightCorner<3, 3>() = a.topLeftCorner<3, 3>();
        a.topRightCorner<3, 3>() = bracket(Matrix3d(coupling + coupling.transpose()));
        return a;
    };
    const Matrix3d P1 = S1.topLeftCorner<3, 3>(), P2 = S2.topLeftCorner<3, 3>();
    const Matrix3d R1 = S1.topRightCorner<3, 3>(), R2 = S2.topRightCorner<3, 3>();
    const Matrix3d F1 = S1.bottomRightCorner<3, 3>(), F2 = S2.bottomRightCorner<3, 3>();
    const Matrix3d R1t = R1.transpose(), R2t = R2.transpose();
    Matrix6 B;
    B.topLeftCorner<3, 3>() =
        bracket(F1, P2) + bracket(R1t, R2) + bracket(R1, R2t) + bracket(P1, F2);
    B.topRightCorner<3, 3>() = bracket(F1, R2t) + bracket(R1t, F2);
    B.bottomLeftCorner<3, 3>() = B.topRightCorner<3, 3>().transpose();
    B.bottomRightCorner<3, 3>() = bracket(F1, F2);
    const Matrix6 A1 = A(S1), A2 = A(S2);
    return S1 + S2 + 0.25 * B +
           (A1 * S2 + S2 * A1.transpose() + A2 * S1 + S1 * A2.transpose()) / 12.;
}

Matrix6 update(const Matrix6& covariance, const Matrix6& information) {
    const Matrix6 system = Matrix6::Identity() + covariance * information;
    return system.partialPivLu().solve(covariance);
}

constexpr int kCases = 64;

std::vector<Matrix6> covariances(double scale) {
    std::vector<Matrix6> all;
    for (int i = 0; i < kCases; ++i) {
        const Matrix6 root = scale * Matrix6::Random();
        all.push_back(root * root.transpose());
    }
    return all;
}

}  // namespace

int main(int argc, char** argv) {
    const BenchArguments arguments(argc, argv, "uncertain_pose_bench");
    const std::vector<Matrix6> motion = covariances(0.03);
    const std::vector<Matrix6> prior = covariances(0.1);
    const std::vector<Matrix6> information = covariances(1e3);
    std::vector<Matrix6> Ad;
    for (int i = 0; i < kCases; ++i) Ad.push_back(adjoint(expSE3(Vector6::Random())));

    double sink = 0.;
    const auto time = [&](const auto& call) {
        return 1e3 * minMicroseconds(50, 5000, [&](int i) { sink += call(i % kCases)(2, 4); });
    };
    const auto ours = [&](PropagationOrder order) {
        return time([&](int i) {
            return compoundCovariance(Ad[i], motion[i], prior[i], order).covariance;
        });
    };
    const double second = ours(PropagationOrder::second);
    const double fourth = ours(PropagationOrder::fourth);
    const double updated = time([&](int i) { return updateCovariance(prior[i], information[i]); });
    const double plainSecond = time([&](int i) { return secondOrder(Ad[i], motion[i], prior[i]); });
    const double plainFourth = time([&](int i) { return fourthOrder(Ad[i], motion[i], prior[i]); });
    const double plainUpdate = time([&](int i) { return update(prior[i], information[i]); });

    double difference = 0.;
    for (int i = 0; i < kCases; ++i) {
        const Matrix6 plain = fourthOrder(Ad[i], motion[i], prior[i]);
        const Matrix6 fast =
            compoundCovariance(Ad[i], motion[i], prior[i], PropagationOrder::fourth).covariance;
        difference = std::max(difference, (fast - plain).norm() / plain.norm());
    }
    fmt::print("per call (checksum {:.6g}, fourth orders differ by {:.0e})\n", sink, difference);
    for (const auto& [name, mine, plain] : {std::tuple{"second order", second, plainSecond},
                                            {"fourth order, guarded", fourth, plainFourth},
                                            {"update", updated, plainUpdate}}) {
        fmt::print("  {:22} {:6.0f} ns   plain Eigen {:6.0f} ns   {:4.1f}x\n", name, mine, plain,
                   plain / mine);
    }
}
