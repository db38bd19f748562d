// SPDX-License-Identifier: BSD-3-Clause
#include "shared/command_io.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace photonav {

void printMessage(std::string_view line) {
    const std::string text = fmt::format("photonav: {}\n", line);
    std::fwrite(text.data(), 1, text.size(), stderr);
}

std::string durationText(double seconds) {
    const auto total = std::lround(seconds);
    if (total < 120) return fmt::format("{} s", total);
    if (total < 7200) return fmt::format("{} min", (total + 30) / 60);
    return fmt::format("{:.1f} h", static_cast<double>(total) / 3600.);
}

std::string remainingText(double seconds) {
    return fmt::format(", about {} left", durationText(seconds));
}

ProgressLine::ProgressLine(bool quiet, double period)
    : enabled_(!quiet), isTerminal_(isatty(STDERR_FILENO) != 0), period_(period) {}

ProgressLine::~ProgressLine() { clear(); }

void ProgressLine::clear() {
    if (enabled_ && width_ > 0) write(fmt::format("\r{:{}}\r", "", width_));
    width_ = 0;
}

void ProgressLine::show(const std::string& text) {
    if (!enabled_) return;
    if (isTerminal_) {
        write(fmt::format("\r{:{}}", text, std::max(width_, text.size())));
        width_ = text.size();
    } else if (watch_.seconds() - lastLine_ >= period_) {
        lastLine_ = watch_.seconds();
        printMessage(text);
    }
}

void ProgressLine::show(const std::string& text, double share) {
    const bool isKnown = share > 0. && share <= 1.;
    show(isKnown ? text + remainingText(phase_.seconds() * (1. - share) / share) : text);
}

void ProgressLine::say(const std::string& text) {
    if (!enabled_) return;
    clear();
    printMessage(text);
}

/// A terminal may go away while the command runs.
void ProgressLine::write(const std::string& text) {
    enabled_ = std::fwrite(text.data(), 1, text.size(), stderr) == text.size();
    std::fflush(stderr);
}

}  // namespace photonav
