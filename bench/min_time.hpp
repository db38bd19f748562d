// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <chrono>

/// Shortest time of one call [us] over several batches, because noise only adds time.
template <class Call>
double minMicroseconds(int batches, int calls, const Call& call) {
    double least = 1e30;
    for (int b = 0; b < batches; ++b) {
        const auto start = std::chrono::steady_clock::now();
        for (int i = 0; i < calls; ++i) call(i);
        const std::chrono::duration<double, std::micro> time =
            std::chrono::steady_clock::now() - start;
        least = std::min(least, time.count() / calls);
    }
    return least;
}
