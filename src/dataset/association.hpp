// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

namespace photonav {

/// Pairs two lists of timestamps, both in order: closest pairs first, each timestamp used at most
/// once, as associate.py of the TUM benchmark does. Time n log n and memory n, also for dense
/// timestamps.
/// @param tolerance the largest difference of a pair [s]
/// @returns for every timestamp of `a` the index of its partner in `b`, or -1
std::vector<int> associate(const std::vector<double>& a, const std::vector<double>& b,
                           double tolerance);

}  // namespace photonav
