// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cstddef>
#include <limits>
#include <vector>

/// The value at rank q (n - 1), rounded to the nearest rank; NaN without values. @param q 0 to 1
template <typename T>
double quantile(std::vector<T> values, double q) {
    if (values.empty()) return std::numeric_limits<double>::quiet_NaN();
    const auto nth = values.begin() +
                     static_cast<std::ptrdiff_t>(q * static_cast<double>(values.size() - 1) + 0.5);
    std::nth_element(values.begin(), nth, values.end());
    return static_cast<double>(*nth);
}
