// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <limits>
#include <numbers>

namespace photonav {

/// The open end of a range; the cost of what is out of reach.
inline constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// A number that there is none of: written as null to JSON.
inline constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

inline constexpr double kDegree = std::numbers::pi / 180.;  ///< [rad]

}  // namespace photonav
