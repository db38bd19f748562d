// SPDX-License-Identifier: BSD-3-Clause
// Programs of others that open our files, and whose files we open.
#pragma once

#include "app/executable.hpp"

namespace photonav {

/// Whether the shell finds a program. Tests skip where it does not.
inline bool isInstalled(const std::string& program) {
    return execute("command -v " + program).exitCode == 0;
}

/// Runs a program without a window, for a minute at most.
inline Execution otherProgram(const std::string& command) {
    return execute("QT_QPA_PLATFORM=offscreen timeout 60 " + command);
}

}  // namespace photonav
