// SPDX-License-Identifier: BSD-3-Clause
#include "dataset/belief_trajectory.hpp"

#include <fmt/format.h>

#include <string>

#include "io/atomic_file.hpp"

namespace photonav {
namespace {

/// " a11 a12 ... ann", single blanks between them (ov_eval reads no others).
template <class Derived>
std::string upperTriangle(const Eigen::MatrixBase<Derived>& matrix) {
    std::string text;
    for (Eigen::Index i = 0; i < matrix.rows(); ++i) {
        for (Eigen::Index j = i; j < matrix.cols(); ++j) {
            text += fmt::format(" {:.9g}", matrix(i, j));
        }
    }
    return text;
}

}  // namespace

Trajectory meansOf(const std::vector<StampedBelief>& beliefs) {
    Trajectory trajectory;
    for (const auto& [timestamp, T_c_w] : beliefs) {
        trajectory.push_back({timestamp, T_c_w.mean.inverse()});
    }
    return trajectory;
}

void writeCovariances(const std::string& file, const std::vector<StampedBelief>& beliefs) {
    std::string text =
        "# covariance of xi in T_c_w = exp(xi^) mean: world to camera, perturbation on the left, "
        "in the camera frame\n"
        "# order (rho, phi) = (x y z, about x y z), units m and rad; upper triangle by rows\n"
        "# timestamp s11 s12 s13 s14 s15 s16 s22 s23 s24 s25 s26 s33 s34 s35 s36 s44 s45 s46 s55 "
        "s56 s66\n";
    for (const auto& [timestamp, T_c_w] : beliefs) {
        text += fmt::format("{:.6f}{}\n", timestamp, upperTriangle(T_c_w.covariance));
    }
    writeFileAtomically(file, text);
}

void writeOpenVinsTrajectory(const std::string& file, const std::vector<StampedBelief>& beliefs) {
    std::string text =
        "# timestamp(s) tx ty tz qx qy qz qw Pr11 Pr12 Pr13 Pr22 Pr23 Pr33 Pt11 Pt12 Pt13 Pt22 "
        "Pt23 Pt33\n";
    for (const auto& [timestamp, T_c_w] : beliefs) {
        const Pose T_w_c = T_c_w.mean.inverse();
        const Eigen::Quaterniond q(T_w_c.linear());
        const Eigen::Vector3d& p = T_w_c.translation();
        const Eigen::Matrix3d R_w_c = T_w_c.linear();
        const Eigen::Matrix3d position =
            R_w_c * T_c_w.covariance.topLeftCorner<3, 3>() * R_w_c.transpose();
        text += fmt::format("{:.6f} {:.9g} {:.9g} {:.9g} {:.9g} {:.9g} {:.9g} {:.9g}{}{}\n",
                            timestamp, p.x(), p.y(), p.z(), q.x(), q.y(), q.z(), q.w(),
                            upperTriangle(T_c_w.covariance.bottomRightCorner<3, 3>()),
                            upperTriangle(position));
    }
    writeFileAtomically(file, text);
}

}  // namespace photonav
