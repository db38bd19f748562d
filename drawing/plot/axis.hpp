// SPDX-License-Identifier: BSD-3-Clause
// Axes of plots: map values to positions along a frame, with ticks at round numbers.
#pragma once

#include <limits>
#include <string>
#include <vector>

namespace photonav {

struct Axis {
    static constexpr double kAuto = std::numeric_limits<double>::quiet_NaN();

    /// Limits: kAuto: from the data. Positive if `log`; otherwise max < min reverses the axis.
    double min = kAuto, max = kAuto;
    bool log = false;        ///< logarithmic axis
    std::string label = {};  ///< quantity and unit
    bool whole = false;      ///< ticks at whole numbers only

    /// The position of a value: 0 at min, 1 at max. Infinite values, and on a logarithmic axis
    /// values <= 0, are at the ends.
    double fraction(double value) const;

    /// This axis with limits that enclose the given values in place of kAuto. Values that are not
    /// finite, or not positive on a logarithmic axis, are ignored. min < max unless both are given.
    Axis fittedTo(const std::vector<double>& values) const;
};

struct Tick {
    double value;
    std::string label;
};

/// About `wanted` ticks at multiples of 1, 2 or 5 times a power of ten. A logarithmic axis has
/// ticks at decades, and at 2 and 5 between them if there are few decades; if fewer than two of
/// these lie on the axis, it has linear ticks.
std::vector<Tick> ticksOf(const Axis& axis, int wanted);

}  // namespace photonav
