// SPDX-License-Identifier: BSD-3-Clause
// How much two images of the same size differ.
#pragma once

#include <algorithm>
#include <cmath>

#include "geometry/types.hpp"

namespace photonav::test {

inline double rmsDifference(const ImageF& a, const ImageF& b) {
    double sum = 0.;
    for (unsigned i = 0; i < a.getSize(); ++i) sum += std::pow(a.bitmap[i] - b.bitmap[i], 2);
    return std::sqrt(sum / a.getSize());
}

inline double largestDifference(const ImageF& a, const ImageF& b) {
    double largest = 0.;
    for (unsigned i = 0; i < a.getSize(); ++i) {
        largest = std::max<double>(largest, std::abs(a.bitmap[i] - b.bitmap[i]));
    }
    return largest;
}

}  // namespace photonav::test
