// SPDX-License-Identifier: BSD-3-Clause
// The command line of each subcommand, and what they share.
#pragma once

#include <CLI/CLI.hpp>
#include <atomic>
#include <functional>
#include <set>
#include <string>

#include "commands/command_io.hpp"
#include "commands/many_runs.hpp"
#include "config/key_table.hpp"
#include "report/report.hpp"

namespace photonav {

/// A subcommand and what to do when it was chosen.
struct Command {
    CLI::App* parser;
    std::function<int()> run;  ///< returns the exit code; throws InputError
};

/// What every command needs besides its own options.
struct Invocation {
    std::string commandLine;  ///< as typed, for reports
    const std::atomic<bool>& interrupted;
};

Command checkCommand(CLI::App& app, const Invocation& invocation);
Command calibrateDepthCommand(CLI::App& app, const Invocation& invocation);
/// Of all commands that `app` has when it runs.
Command keysCommand(CLI::App& app);
Command completionCommand(CLI::App& app);
Command exploreCommand(CLI::App& app, const Invocation& invocation);
Command flyCommand(CLI::App& app, const Invocation& invocation);
Command mapCommand(CLI::App& app, const Invocation& invocation);
Command replayCommand(CLI::App& app, const Invocation& invocation);
Command servoCommand(CLI::App& app, const Invocation& invocation);

/// What happens to the results of a run.
struct OutputOptions {
    std::filesystem::path& out;
    bool& quiet;
    bool& json;
};
void addOutput(CLI::App& parser, OutputOptions output, const std::string& defaultFolder);

/// result.json as asked for, else the summary and where the `files` of the result folder are.
void printOutput(const OutputOptions& output, const nlohmann::json& result,
                 const ReportTable& summary, const std::vector<std::string>& files);

void addOverrides(CLI::App& parser, std::vector<std::string>& overrides);

/// An option that overrides a key of the config, before --set.
void addValue(CLI::App& parser, CommandOptions& options, const std::string& name,
              const std::string& key, const std::string& description);

/// config, --set and the output.
void addCommon(CLI::App& parser, CommandOptions& options, bool needsConfig = true);

/// --jobs, --shard, --merge and --resume. Shards are merged without a config.
void addManyRuns(CLI::App& parser, ManyRunsOptions& options, const RunWords& words);

/// --seed as text for an override: a number that a config may hold.
template <typename Text>
void addSeed(CLI::App& parser, Text& seed, const std::string& what) {
    parser.add_option("--seed", seed, what + " (overrides the config)")
        ->check(CLI::Range(1U, 4294967295U));
}

/// "--body-radius" of the key body_radius.
std::string optionOf(const ConfigKey& key);

/// The value of a key as it was typed: lists are typed without brackets.
std::string valueOf(const ConfigKey& key, const std::string& text);

/// An option per key, which sets what the table refers to.
/// @param keys must outlive the parser
/// @param without names of keys that are typed in another way
void addKeyOptions(CLI::App& parser, const KeyTable& keys, const std::set<std::string>& without);

/// Last part of a path, without a closing slash.
std::string folderName(const std::string& path);

/// For a complete config: options besides it are errors.
/// @throws InputError for the first one that was given
void refuseOptionsBeside(const std::string& config, const CLI::App& parser);

}  // namespace photonav
