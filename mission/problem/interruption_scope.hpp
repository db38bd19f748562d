// SPDX-License-Identifier: BSD-3-Clause
// Interrupts long computations by a flag, which a signal handler sets.
#pragma once

#include <atomic>

namespace photonav {

inline const std::atomic<bool> kNotInterrupted{false};

/// As long as this object exists, the rendering of large views ends with Interrupted when a
/// flag is set.
class InterruptionScope {
  public:
    /// @param current pointer to the flag that rendering checks; restored at the end of the scope
    /// @param flag must outlive the scope
    InterruptionScope(const std::atomic<bool>*& current, const std::atomic<bool>& flag)
        : current_(current), before_(current) {
        current_ = &flag;
    }
    InterruptionScope(const InterruptionScope&) = delete;
    InterruptionScope& operator=(const InterruptionScope&) = delete;
    ~InterruptionScope() { current_ = before_; }

  private:
    const std::atomic<bool>*& current_;
    const std::atomic<bool>* before_;
};

}  // namespace photonav
