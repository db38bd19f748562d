// SPDX-License-Identifier: BSD-3-Clause
// The partial order of covariances (Loewner order).
#pragma once

#include "geometry/types.hpp"

namespace photonav {

/// Whether b - a is positive definite, so that the variance by a is below the variance by b in
/// every direction. Callers add a slack to b, so that matrices that are equal up to rounding are
/// comparable as well.
inline bool isLoewnerLess(const Matrix6& a, const Matrix6& b) {
    const Matrix6 excess = b - a;
    if ((excess.diagonal().array() < 0.).any()) return false;
    return excess.llt().info() == Eigen::Success;
}

}  // namespace photonav
