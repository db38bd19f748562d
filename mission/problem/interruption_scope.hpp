// SPDX-License-Identifier: BSD-3-Clause
// What ends work that takes long: a flag that a signal sets.
#pragma once

#include <atomic>

namespace photonav {

inline const std::atomic<bool> kNotInterrupted{false};

/// While it exists, a flag ends the rendering of large views (RenderingStopped).
class InterruptionScope {
  public:
    /// @param current what the views look at
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
