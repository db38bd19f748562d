// SPDX-License-Identifier: BSD-3-Clause
// Gaussian distributions: random draws of twists, and the largest standard deviation.
#pragma once

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <random>

#include "geometry/eigensystem.hpp"
#include "geometry/types.hpp"

namespace photonav {

/// A square root of a covariance: a matrix A with A A^T = covariance. The covariance may be
/// singular.
inline Matrix6 rootOf(const Matrix6& covariance) {
    const auto [variances, axes] = eigensystem(covariance);
    return axes * variances.cwiseMax(0.).cwiseSqrt().asDiagonal();
}

/// The largest standard deviation in any direction: the square root of the largest eigenvalue of a
/// covariance, in its units.
template <typename Covariance>
double largestSigma(const Eigen::MatrixBase<Covariance>& covariance) {
    const Eigen::SelfAdjointEigenSolver<typename Covariance::PlainObject> solver(
        covariance, Eigen::EigenvaluesOnly);
    return std::sqrt(std::max(0., solver.eigenvalues().maxCoeff()));
}

/// A random twist drawn from N(0, root root^T).
inline Vector6 draw(const Matrix6& root, std::mt19937_64& random) {
    std::normal_distribution<double> normal;
    Vector6 z;
    for (double& component : z) component = normal(random);
    return root * z;
}

}  // namespace photonav
