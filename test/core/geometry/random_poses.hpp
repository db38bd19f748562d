// SPDX-License-Identifier: BSD-3-Clause
// Poses and covariances of any size and correlation, by std::rand().
#pragma once

#include "geometry/se3.hpp"

namespace photonav::test {

inline Matrix6 randomCovariance(double rhoSigma, double phiSigma) {
    const Vector6 scale =
        (Vector6() << Eigen::Vector3d::Constant(rhoSigma), Eigen::Vector3d::Constant(phiSigma))
            .finished();
    const Matrix6 root = scale.asDiagonal() * Matrix6::Random();
    return root * root.transpose();
}

inline Pose randomPose() { return expSE3(3. * Vector6::Random()); }

inline bool sameCovariance(const Matrix6& a, const Matrix6& b, double tolerance) {
    return (a - b).norm() <= tolerance * b.norm();
}

}  // namespace photonav::test
