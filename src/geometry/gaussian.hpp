// SPDX-License-Identifier: BSD-3-Clause
// Random draws from a Gaussian distribution of twists.
#pragma once

#include <Eigen/Eigenvalues>
#include <random>

#include "geometry/types.hpp"

namespace photonav {

/// A square root of a covariance: a matrix A with A A^T = covariance. The covariance may be
/// singular.
inline Matrix6 rootOf(const Matrix6& covariance) {
    const Eigen::SelfAdjointEigenSolver<Matrix6> solver(covariance);
    return solver.eigenvectors() * solver.eigenvalues().cwiseMax(0.).cwiseSqrt().asDiagonal();
}

/// A random twist drawn from N(0, root root^T).
inline Vector6 draw(const Matrix6& root, std::mt19937_64& random) {
    std::normal_distribution<double> normal;
    Vector6 z;
    for (double& component : z) component = normal(random);
    return root * z;
}

}  // namespace photonav
