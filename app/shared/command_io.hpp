// SPDX-License-Identifier: BSD-3-Clause
// Common to all commands: options, exit codes and output on the terminal.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "io/stopwatch.hpp"

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

/// A duration [s] as text: "90 s", "12 min", "3.5 h".
std::string durationText(double seconds);

/// A remaining time [s] as the end of a progress line: ", about 3 min left".
std::string remainingText(double seconds);

/// The progress of a command on standard error. On a terminal each text overwrites the last one.
/// Otherwise at most one line is printed per period, and none by shorter commands.
class ProgressLine {
  public:
    /// @param quiet true: nothing is printed
    /// @param period shortest time between two lines if standard error is not a terminal [s]
    explicit ProgressLine(bool quiet, double period = 30.);
    ~ProgressLine();
    ProgressLine(const ProgressLine&) = delete;
    ProgressLine& operator=(const ProgressLine&) = delete;
    void show(const std::string& text);

    /// Shows the text with the remaining time, if the work proceeds as fast as since the line or
    /// its phase began.
    /// @param share done, in [0, 1]
    void show(const std::string& text, double share);

    /// Prints a line that stays, whatever the period.
    void say(const std::string& text);

    /// Begins another phase of the work, whose shares begin at 0.
    void beginPhase() { phase_ = {}; }
    void clear();

  private:
    void write(const std::string& text);

    bool enabled_, isTerminal_;
    double period_, lastLine_ = 0.;
    Stopwatch watch_, phase_;
    std::size_t width_ = 0;
};

}  // namespace photonav
