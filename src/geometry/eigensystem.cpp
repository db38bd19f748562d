// SPDX-License-Identifier: BSD-3-Clause
#include "geometry/eigensystem.hpp"

#include <Eigen/Eigenvalues>

namespace photonav {

Eigensystem eigensystem(const Matrix6& A) {
    const Eigen::SelfAdjointEigenSolver<Matrix6> solver(A);
    return {solver.eigenvalues(), solver.eigenvectors()};
}

Eigensystem eigensystem(const Matrix6& A, const Matrix6& B) {
    const Eigen::GeneralizedSelfAdjointEigenSolver<Matrix6> solver(A, B);
    return {solver.eigenvalues(), solver.eigenvectors()};
}

}  // namespace photonav
