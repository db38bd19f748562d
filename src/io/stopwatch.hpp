// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <chrono>
#include <utility>

namespace photonav {

/// Measures wall-clock time since its construction.
class Stopwatch {
  public:
    /// Time since the construction [s].
    double seconds() const { return since(begin_, Clock::now()); }

    /// Time since the last call of lap(), or since the construction [s].
    double lap() {
        const auto now = Clock::now();
        return since(std::exchange(last_, now), now);
    }

  private:
    using Clock = std::chrono::steady_clock;

    static double since(Clock::time_point begin, Clock::time_point end) {
        return std::chrono::duration<double>(end - begin).count();
    }

    Clock::time_point begin_ = Clock::now();
    Clock::time_point last_ = begin_;
};

}  // namespace photonav
