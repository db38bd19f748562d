// SPDX-License-Identifier: BSD-3-Clause
// The partial order of covariances.
#pragma once

#include "geometry/types.hpp"

namespace photonav {

/// Whether b - a is positive definite: in no direction is a as uncertain as b. Callers add a slack
/// to b, which also makes equal matrices comparable in spite of rounding.
inline bool isLoewnerLess(const Matrix6& a, const Matrix6& b) {
    const Matrix6 excess = b - a;
    if ((excess.diagonal().array() < 0.).any()) return false;
    return excess.llt().info() == Eigen::Success;
}

}  // namespace photonav
