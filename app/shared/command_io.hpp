// SPDX-License-Identifier: BSD-3-Clause
// Common to all commands: options, exit codes and output on the terminal.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace photonav {

/// Exit codes of all commands. kNoAnswer: the command found no solution, for example no path, or
/// failed for a reason other than its input. kInterrupted: stopped by a signal.
enum ExitCode { kDone = 0, kNoAnswer = 1, kBadInput = 2, kInterrupted = 130 };

struct CommandOptions {
    std::string config;                  ///< YAML file of the planning problem
    std::vector<std::string> overrides;  ///< key.path=value
    std::filesystem::path out;           ///< result folder; empty: out/<command>-<config name>
    bool quiet = false;                  ///< print no progress and no summary
    bool json = false;        ///< print result.json on standard output, without a summary
    std::string commandLine;  ///< the command as typed, for the report
};

/// References to the members `out`, `quiet` and `json` of a command's options.
struct OutputOptions {
    template <typename Options>
    OutputOptions(Options& options) : out(options.out), quiet(options.quiet), json(options.json) {}

    std::filesystem::path& out;
    bool& quiet;
    bool& json;
};

/// Prints "photonav: LINE" to standard error. Where that is closed or full, nothing is printed: a
/// result is worth more than what is said about it.
void printMessage(std::string_view line);

/// A progress line on standard error, which is overwritten by the next one. Nothing is printed
/// unless standard error is a terminal.
class ProgressLine {
  public:
    /// @param quiet true: nothing is printed
    explicit ProgressLine(bool quiet);
    ~ProgressLine();
    ProgressLine(const ProgressLine&) = delete;
    ProgressLine& operator=(const ProgressLine&) = delete;
    void show(const std::string& text);
    void clear();

  private:
    void write(const std::string& text);

    bool enabled_;
    std::size_t width_ = 0;
};

}  // namespace photonav
