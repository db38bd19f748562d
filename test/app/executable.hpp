// SPDX-License-Identifier: BSD-3-Clause
// The executable, run as a user runs it.
#pragma once

#include <fmt/format.h>

#include <array>
#include <cstdio>
#include <string>

namespace photonav {

struct Execution {
    int exitCode;
    std::string output;  // standard output and standard error
};

/// Runs a shell command.
inline Execution execute(const std::string& shellCommand) {
    FILE* pipe = popen(fmt::format("{} 2>&1", shellCommand).c_str(), "r");  // NOLINT(cert-env33-c)
    Execution run{-1, ""};
    std::array<char, 4096> buffer{};
    while (std::fgets(buffer.data(), buffer.size(), pipe) != nullptr) run.output += buffer.data();
    const int status = pclose(pipe);
    run.exitCode = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
    return run;
}

inline Execution photonav(const std::string& arguments) {
    return execute(fmt::format("{} {}", PHOTONAV_BINARY, arguments));
}

/// File of an example config.
inline std::string config(const std::string& name) {
    return fmt::format("{}/config/{}.yaml", PHOTONAV_SOURCE_DIR, name);
}

}  // namespace photonav
