// SPDX-License-Identifier: BSD-3-Clause
// What all commands share: their options, exit codes and the terminal.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace photonav {

enum ExitCode { kDone = 0, kNoAnswer = 1, kBadInput = 2, kInterrupted = 130 };

struct CommandOptions {
    std::string config;                  ///< YAML file
    std::vector<std::string> overrides;  ///< key.path=value
    std::filesystem::path out;           ///< result folder; empty: out/<command>-<config name>
    bool quiet = false;                  ///< no progress, no summary
    bool json = false;                   ///< result.json on standard output as well
    std::string commandLine;             ///< as typed, for the report
};

/// What happens to the results of a run, among the options of a command.
struct OutputOptions {
    template <typename Options>
    OutputOptions(Options& options) : out(options.out), quiet(options.quiet), json(options.json) {}

    std::filesystem::path& out;
    bool& quiet;
    bool& json;
};

/// A single line on standard error that is overwritten on a terminal, and dropped elsewhere.
class ProgressLine {
  public:
    explicit ProgressLine(bool quiet);
    ~ProgressLine();
    ProgressLine(const ProgressLine&) = delete;
    ProgressLine& operator=(const ProgressLine&) = delete;
    void show(const std::string& text);
    void clear();

  private:
    bool enabled_;
    std::size_t width_ = 0;
};

}  // namespace photonav
