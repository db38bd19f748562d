// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <limits>
#include <numbers>

namespace photonav {

/// Used for the missing bound of a range, and for the cost of a state that cannot be reached.
inline constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// A missing value: null in JSON.
inline constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

inline constexpr double kDegree = std::numbers::pi / 180.;  ///< [rad]

}  // namespace photonav
