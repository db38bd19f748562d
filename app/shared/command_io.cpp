// SPDX-License-Identifier: BSD-3-Clause
#include "shared/command_io.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>

namespace photonav {

void printMessage(std::string_view line) {
    const std::string text = fmt::format("photonav: {}\n", line);
    std::fwrite(text.data(), 1, text.size(), stderr);
}

ProgressLine::ProgressLine(bool quiet) : enabled_(!quiet && isatty(STDERR_FILENO) != 0) {}

ProgressLine::~ProgressLine() { clear(); }

void ProgressLine::clear() {
    if (enabled_ && width_ > 0) write(fmt::format("\r{:{}}\r", "", width_));
    width_ = 0;
}

void ProgressLine::show(const std::string& text) {
    if (!enabled_) return;
    write(fmt::format("\r{:{}}", text, std::max(width_, text.size())));
    width_ = text.size();
}

/// A terminal may go away while the command runs.
void ProgressLine::write(const std::string& text) {
    enabled_ = std::fwrite(text.data(), 1, text.size(), stderr) == text.size();
    std::fflush(stderr);
}

}  // namespace photonav
