// SPDX-License-Identifier: BSD-3-Clause
// Axes: from quantities to shares of a frame, with ticks at round numbers.
#pragma once

#include <limits>
#include <string>
#include <vector>

namespace photonav {

struct Axis {
    static constexpr double kAuto = std::numeric_limits<double>::quiet_NaN();

    double min = kAuto, max = kAuto;  ///< positive on a logarithmic axis; kAuto: from the data
    bool log = false;
    std::string label = {};  ///< quantity and unit

    /// 0 at min, 1 at max. Infinities, and values that have no logarithm, are at the ends.
    double fraction(double value) const;

    /// With limits around the given values (those that are finite and, on a logarithmic axis,
    /// positive) in place of kAuto, and a length in any case.
    Axis fittedTo(const std::vector<double>& values) const;
};

struct Tick {
    double value;
    std::string label;
};

/// About `wanted` ticks at multiples of 1, 2 or 5 times a power of ten; decades (and 2 and 5
/// between them when there are few) on a logarithmic axis, unless fewer than two of these are on
/// it.
std::vector<Tick> ticksOf(const Axis& axis, int wanted);

}  // namespace photonav
