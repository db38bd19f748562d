// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <ctime>

/// Processor time of this process [s]; other programs are not counted.
inline double processSeconds() { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

/// Processor time of this thread [ms]; other programs are not counted.
inline double threadTime() {
    timespec now{};
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
    return 1e3 * static_cast<double>(now.tv_sec) + 1e-6 * static_cast<double>(now.tv_nsec);
}

/// Processor time that `work` takes on this thread [ms].
double milliseconds(const auto& work) {
    const double begin = threadTime();
    work();
    return threadTime() - begin;
}
