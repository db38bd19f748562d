// SPDX-License-Identifier: BSD-3-Clause
// The executable, run as a user runs it.
#pragma once

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
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

/// A shell condition: the process $! has become photonav and catches SIGINT, which is bit 1 of
/// these. On a busy machine that takes seconds, and until then a signal is ignored or ends it at
/// once.
constexpr const char* kCatchesSignals =
    "grep -q photonav /proc/$!/comm && "
    "[ $((0x$(sed -n 's/^SigCgt:[[:space:]]*//p' /proc/$!/status) & 2)) -ne 0 ]";

/// Runs a shell command and sends it a signal when a shell condition holds, a while later if asked.
inline Execution interrupt(const std::string& shellCommand, const std::string& condition,
                           double secondsLater = 0., const std::string& signal = "INT") {
    return execute(
        fmt::format("{{ {} & until {}; do sleep 0.02; done; sleep {}; kill -{} $!; wait $!; }}",
                    shellCommand, condition, secondsLater, signal));
}

inline Execution photonav(const std::string& arguments) {
    return execute(fmt::format("{} {}", PHOTONAV_BINARY, arguments));
}

/// A message of one line that holds the reason, and exit code 2.
inline void expectBadInput(const Execution& run, const std::string& reason) {
    EXPECT_EQ(run.exitCode, 2) << run.output;
    EXPECT_NE(run.output.find(reason), std::string::npos) << run.output;
    EXPECT_TRUE(run.output.starts_with("photonav: ")) << run.output;
    EXPECT_EQ(std::count(run.output.begin(), run.output.end(), '\n'), 1) << run.output;
}

/// File of an example config.
inline std::string config(const std::string& name) {
    return fmt::format("{}/config/{}.yaml", PHOTONAV_SOURCE_DIR, name);
}

}  // namespace photonav
