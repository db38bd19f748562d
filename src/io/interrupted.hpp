// SPDX-License-Identifier: BSD-3-Clause
// The end of a long computation that was interrupted.
#pragma once

#include <atomic>
#include <functional>
#include <stdexcept>

namespace photonav {

/// Thrown where a long computation was interrupted, by Ctrl-C for example.
struct Interrupted : std::runtime_error {
    Interrupted() : std::runtime_error("interrupted") {}
};

/// Whether to stop; asked now and then in a long computation. Empty: never.
using IsStopped = std::function<bool()>;

/// @throws Interrupted when it is time to stop
inline void throwIfStopped(const IsStopped& isStopped) {
    if (isStopped && isStopped()) throw Interrupted();
}
inline void throwIfStopped(const std::atomic<bool>& isStopped) {
    if (isStopped) throw Interrupted();
}

}  // namespace photonav
