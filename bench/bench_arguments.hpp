// SPDX-License-Identifier: BSD-3-Clause
// The command line of a benchmark: positional arguments, all of which have defaults.
#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cstdio>
#include <cstdlib>
#include <span>
#include <string>
#include <string_view>

namespace photonav {

/// Arguments of a benchmark by their position (1 is the first). `--help` prints the usage and ends
/// the program; more arguments than the usage names, or a wrong one, end it with one line and exit
/// code 2.
class BenchArguments {
  public:
    /// @param usage one line: the program and its arguments in brackets, for example
    ///        "align_bench [FOLDER]"
    BenchArguments(int argc, char** argv, std::string_view usage)
        : arguments_(argv, static_cast<std::size_t>(argc)), usage_(usage) {
        for (std::size_t i = 1; i < arguments_.size(); ++i) {
            if (std::string_view(arguments_[i]) == "--help") end(stdout, 0);
        }
        const auto named = static_cast<std::size_t>(std::count(usage.begin(), usage.end(), '['));
        if (arguments_.size() > named + 1) end(stderr, 2);
    }

    std::string text(std::size_t position, std::string_view otherwise) const {
        return std::string(position < arguments_.size() ? arguments_[position] : otherwise);
    }

    template <typename Number>
    Number number(std::size_t position, Number otherwise, Number least = Number(0)) const {
        if (position >= arguments_.size()) return otherwise;
        const std::string_view given = arguments_[position];
        Number value{};
        const char* const last = given.data() + given.size();
        const auto [read, error] = std::from_chars(given.data(), last, value);
        if (error != std::errc() || read != last || !(value >= least)) end(stderr, 2);
        return value;
    }

  private:
    [[noreturn]] void end(std::FILE* stream, int exitCode) const {
        fmt::print(stream, "usage: {}\n", usage_);
        std::exit(exitCode);
    }

    std::span<char*> arguments_;
    std::string_view usage_;
};

}  // namespace photonav
