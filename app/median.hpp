// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

namespace photonav {

/// The upper median; `ofNothing` of an empty list.
template <class T>
double median(std::vector<T> values, double ofNothing) {
    if (values.empty()) return ofNothing;
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    return *middle;
}

}  // namespace photonav
