// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <atomic>

#include "problem/planning_problem.hpp"

namespace photonav {

/// Lets a flag end what looks at `current`, until the end of the scope.
class InterruptionScope {
  public:
    InterruptionScope(const std::atomic<bool>*& current, const std::atomic<bool>& flag)
        : current_(current) {
        current_ = &flag;
    }
    InterruptionScope(const InterruptionScope&) = delete;
    InterruptionScope& operator=(const InterruptionScope&) = delete;
    ~InterruptionScope() { current_ = &kNotInterrupted; }

  private:
    const std::atomic<bool>*& current_;
};

}  // namespace photonav
