// SPDX-License-Identifier: BSD-3-Clause
// Eigenvalues and eigenvectors of covariances and information matrices of poses. Compiled once:
// Eigen's solvers take a compiler ten seconds wherever they are used.
#pragma once

#include "geometry/types.hpp"

namespace photonav {

/// Eigenvalues, ascending, and the eigenvectors in the columns of a matrix.
struct Eigensystem {
    Vector6 values;
    Matrix6 vectors;
};

/// A V = V diag(values), V^T V = 1.
/// @param A symmetric
Eigensystem eigensystem(const Matrix6& A);

/// Of A relative to B: A V = B V diag(values), V^T B V = 1.
/// @param A symmetric
/// @param B symmetric and positive definite; if it is not, values and vectors are not finite or
///     do not fulfil the equations
Eigensystem eigensystem(const Matrix6& A, const Matrix6& B);

}  // namespace photonav
