// SPDX-License-Identifier: BSD-3-Clause
#include "shared/command_io.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>

namespace photonav {

ProgressLine::ProgressLine(bool quiet) : enabled_(!quiet && isatty(STDERR_FILENO) != 0) {}

ProgressLine::~ProgressLine() { clear(); }

void ProgressLine::clear() {
    if (enabled_ && width_ > 0) fmt::print(stderr, "\r{:{}}\r", "", width_);
    width_ = 0;
}

void ProgressLine::show(const std::string& text) {
    if (!enabled_) return;
    fmt::print(stderr, "\r{:{}}", text, std::max(width_, text.size()));
    std::fflush(stderr);
    width_ = text.size();
}

}  // namespace photonav
