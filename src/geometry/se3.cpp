// SPDX-License-Identifier: BSD-3-Clause
#include "geometry/se3.hpp"

#include <array>
#include <cmath>

namespace photonav {

namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

/// Below this squared angle the closed forms cancel and the series are exact to the last bits.
constexpr double kSeriesBelow = 0.5;

/// sum_k weight(k) (-x)^k / (2k + first)!, nine terms: the truncation is below 1e-17 at x = 0.5.
template <typename Weight>
double alternatingSeries(double x, int first, Weight weight) {
    double term = 1.;
    for (int i = 2; i <= first; ++i) term /= i;
    double sum = 0.;
    for (int k = 0; k < 9; ++k) {
        sum += weight(k) * term;
        term *= -x / ((2. * k + first + 1.) * (2. * k + first + 2.));
    }
    return sum;
}

double one(int /*k*/) { return 1.; }

/// sin t / t, (1 - cos t) / t^2 and (t - sin t) / t^3 for x = t^2: exp and the left Jacobian of
/// SO(3) are 1 + a phi^ + b phi^ phi^ and 1 + b phi^ + c phi^ phi^.
struct RotationSeries {
    double a, b, c;

    explicit RotationSeries(double x) {
        if (x < kSeriesBelow) {
            a = alternatingSeries(x, 1, one);
            b = alternatingSeries(x, 2, one);
            c = alternatingSeries(x, 3, one);
            return;
        }
        const double t = std::sqrt(x);
        const double half = std::sin(0.5 * t);
        a = std::sin(t) / t;
        b = 2. * half * half / x;
        c = (1. - a) / x;
    }
};

Matrix3d leftJacobianSO3(const Vector3d& phi) {
    const RotationSeries f(phi.squaredNorm());
    const Matrix3d P = hat(phi);
    return Matrix3d::Identity() + f.b * P + f.c * P * P;
}

/// (1 - t/2 cot(t/2)) / t^2, the coefficient of phi^ phi^ in the inverse left Jacobian of SO(3).
double inverseJacobianCoefficient(double x) {
    if (x < kSeriesBelow) {  // |B_2k| x^(k-1) / (2k)!
        constexpr std::array kSeries = {1. / 12.,
                                        1. / 720.,
                                        1. / 30240.,
                                        1. / 1209600.,
                                        1. / 47900160.,
                                        691. / 1307674368000.,
                                        1. / 74724249600.,
                                        3617. / 10670622842880000.,
                                        43867. / 5109094217170944000.};
        double sum = 0.;
        for (std::size_t k = kSeries.size(); k-- > 0;) sum = sum * x + kSeries[k];
        return sum;
    }
    const double half = 0.5 * std::sqrt(x);
    return (1. - half * std::cos(half) / std::sin(half)) / x;
}

Matrix3d leftJacobianInverseSO3(const Vector3d& phi) {
    const Matrix3d P = hat(phi);
    return Matrix3d::Identity() - 0.5 * P + inverseJacobianCoefficient(phi.squaredNorm()) * P * P;
}

/// The off-diagonal block of the left Jacobian, BF14 eq. (102).
Matrix3d jacobianCoupling(const Vector6& xi) {
    const Matrix3d R = hat(xi.head<3>());
    const Matrix3d P = hat(xi.tail<3>());
    const double x = xi.tail<3>().squaredNorm();
    double second = 0.;  // (t^2 + 2 cos t - 2) / (2 t^4)
    double third = 0.;   // (2 t - 3 sin t + t cos t) / (2 t^5)
    if (x < kSeriesBelow) {
        second = alternatingSeries(x, 4, one);
        third = alternatingSeries(x, 5, [](int k) { return k + 1.; });
    } else {
        const double t = std::sqrt(x);
        second = (x + 2. * std::cos(t) - 2.) / (2. * x * x);
        third = (2. * t - 3. * std::sin(t) + t * std::cos(t)) / (2. * t * x * x);
    }
    const Matrix3d PR = P * R;
    const Matrix3d RP = R * P;
    const Matrix3d PRP = PR * P;
    return 0.5 * R + RotationSeries(x).c * (PR + RP + PRP) + second * (P * PR + RP * P - 3. * PRP) +
           third * (PRP * P + P * PRP);
}

Vector3d logSO3(const Matrix3d& C) {
    // The quaternion keeps full precision at 0 and at pi, where the trace and the antisymmetric
    // part of C do not.
    Eigen::Quaterniond q(C);
    if (q.w() < 0.) q.coeffs() *= -1.;
    const double s = q.vec().norm();
    const double angle = 2. * std::atan2(s, q.w());
    return s > 0. ? Vector3d(q.vec() * (angle / s)) : Vector3d::Zero();
}

}  // namespace

Matrix3d hat(const Vector3d& phi) {
    Matrix3d P;
    P << 0., -phi.z(), phi.y(), phi.z(), 0., -phi.x(), -phi.y(), phi.x(), 0.;
    return P;
}

Pose expSE3(const Vector6& xi) {
    const Vector3d rho = xi.head<3>();
    const Vector3d phi = xi.tail<3>();
    const RotationSeries f(phi.squaredNorm());
    const Matrix3d P = hat(phi);
    const Vector3d cross = phi.cross(rho);
    Pose T = Pose::Identity();
    T.linear() += f.a * P + f.b * P * P;
    T.translation() = rho + f.b * cross + f.c * phi.cross(cross);
    return T;
}

Vector6 logSE3(const Pose& T) {
    Vector6 xi;
    xi.tail<3>() = logSO3(T.linear());
    xi.head<3>() = leftJacobianInverseSO3(xi.tail<3>()) * T.translation();
    return xi;
}

Pose interpolate(const Pose& a, const Pose& b, double s) {
    const Eigen::Quaterniond from(a.linear());
    Pose pose = Pose::Identity();
    pose.linear() = from.slerp(s, Eigen::Quaterniond(b.linear())).toRotationMatrix();
    pose.translation() = a.translation() + s * (b.translation() - a.translation());
    return pose;
}

Pose levelPose(const Eigen::Vector3d& p_w, double yaw) {
    Pose T_w_b = Pose::Identity();
    T_w_b.translation() = p_w;
    T_w_b.linear() = Eigen::AngleAxisd(yaw, Eigen::Vector3d::UnitZ()).toRotationMatrix();
    return T_w_b;
}

double yawOf(const Pose& T_w_b) { return std::atan2(T_w_b(1, 0), T_w_b(0, 0)); }

Matrix6 adjoint(const Pose& T) {
    Matrix6 Ad = Matrix6::Zero();
    Ad.topLeftCorner<3, 3>() = T.linear();
    Ad.bottomRightCorner<3, 3>() = T.linear();
    Ad.topRightCorner<3, 3>() = hat(T.translation()) * T.linear();
    return Ad;
}

Matrix6 inRotatedAxes(const Matrix6& matrix, const Eigen::Matrix3d& R) {
    const auto symmetric = [&](const Eigen::Matrix3d& block) -> Eigen::Matrix3d {
        const Eigen::Matrix3d turned = R * block * R.transpose();
        return 0.5 * (turned + turned.transpose());
    };
    Matrix6 turned;
    turned.topLeftCorner<3, 3>() = symmetric(matrix.topLeftCorner<3, 3>());
    turned.bottomRightCorner<3, 3>() = symmetric(matrix.bottomRightCorner<3, 3>());
    turned.topRightCorner<3, 3>() = R * matrix.topRightCorner<3, 3>() * R.transpose();
    turned.bottomLeftCorner<3, 3>() = turned.topRightCorner<3, 3>().transpose();
    return turned;
}

Matrix6 leftJacobian(const Vector6& xi) {
    Matrix6 J = Matrix6::Zero();
    J.topLeftCorner<3, 3>() = leftJacobianSO3(xi.tail<3>());
    J.bottomRightCorner<3, 3>() = J.topLeftCorner<3, 3>();
    J.topRightCorner<3, 3>() = jacobianCoupling(xi);
    return J;
}

Matrix6 leftJacobianInverse(const Vector6& xi) {
    const Matrix3d inverse = leftJacobianInverseSO3(xi.tail<3>());
    Matrix6 J = Matrix6::Zero();
    J.topLeftCorner<3, 3>() = inverse;
    J.bottomRightCorner<3, 3>() = inverse;
    J.topRightCorner<3, 3>() = -inverse * jacobianCoupling(xi) * inverse;
    return J;
}

}  // namespace photonav
