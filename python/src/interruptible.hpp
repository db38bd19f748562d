// SPDX-License-Identifier: BSD-3-Clause
// Long calls: other Python threads go on meanwhile, and Ctrl-C ends them.
#pragma once

#include <pybind11/pybind11.h>

#include <atomic>
#include <chrono>
#include <future>

namespace photonav::python {

/// Runs work(interrupted) on a thread of its own, without the interpreter's lock. A signal that
/// Python's handler answers with an exception sets `interrupted`; once the work has ended, that
/// exception is thrown.
template <typename Work>
auto interruptible(const Work& work) {
    namespace py = pybind11;
    constexpr std::chrono::milliseconds kLook(50);
    std::atomic<bool> interrupted{false};
    auto result = std::async(std::launch::async, [&] { return work(interrupted); });
    for (bool isDone = false; !isDone;) {
        {
            const py::gil_scoped_release release;
            isDone = result.wait_for(kLook) == std::future_status::ready;
        }
        if (isDone || PyErr_CheckSignals() == 0) continue;
        interrupted = true;
        const py::error_already_set signal;
        {
            const py::gil_scoped_release release;
            result.wait();
        }
        throw signal;
    }
    return result.get();
}

}  // namespace photonav::python
