// SPDX-License-Identifier: BSD-3-Clause
// Mean and median of lists of numbers.
#pragma once

#include <algorithm>
#include <cstddef>
#include <numeric>
#include <vector>

namespace photonav {

/// The arithmetic mean; `ifEmpty` for an empty list.
inline double mean(const std::vector<double>& values, double ifEmpty) {
    if (values.empty()) return ifEmpty;
    return std::accumulate(values.begin(), values.end(), 0.) / static_cast<double>(values.size());
}

/// The median, for an even number of values the mean of the middle two; `ifEmpty` for an empty
/// list.
template <class T>
double median(std::vector<T> values, double ifEmpty) {
    if (values.empty()) return ifEmpty;
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    if (values.size() % 2 == 1) return *middle;
    return 0.5 * (static_cast<double>(*std::max_element(values.begin(), middle)) + *middle);
}

}  // namespace photonav
