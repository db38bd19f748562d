// SPDX-License-Identifier: BSD-3-Clause
// The command line of each subcommand, and what they share.
#pragma once

#include <CLI/CLI.hpp>
#include <atomic>
#include <functional>
#include <set>
#include <string>

#include "config/key_table.hpp"
#include "shared/command_io.hpp"
#include "shared/many_runs.hpp"

namespace photonav {

/// How a command answers to Ctrl-C and SIGTERM.
enum class OnInterrupt {
    finish,        ///< with the results so far; ends at once where there are none yet
    finishAlways,  ///< it has files of its own, no result folder
    endAtOnce      ///< there is nothing to keep
};

/// A subcommand and what to do when it was chosen.
struct Command {
    CLI::App* parser;
    std::function<int()> run;  ///< returns the exit code; throws InputError
    OnInterrupt onInterrupt = OnInterrupt::finish;
};

/// What every command needs besides its own options.
struct Invocation {
    std::string commandLine;  ///< as typed, for reports
    const std::atomic<bool>& interrupted;
};

/// A subcommand, its options as a value of `Options`.
/// @param addOptions called with the parser and the options, which live as long as the command
/// @param run called with the options and the flag of an interrupt, returns the exit code
template <typename Options, typename AddOptions, typename Run>
Command makeCommand(CLI::App& app, const Invocation& invocation, const char* name,
                    const char* description, const AddOptions& addOptions, const Run& run) {
    auto options = std::make_shared<Options>();
    if constexpr (requires { options->commandLine; }) options->commandLine = invocation.commandLine;
    CLI::App* parser = app.add_subcommand(name, description)->group("Commands");
    addOptions(*parser, *options);
    return {parser, [options, run, &interrupted = invocation.interrupted] {
                return run(*options, interrupted);
            }};
}

using Commands = std::vector<Command>;

// The commands of each folder.
Commands planCommands(CLI::App& app, const Invocation& invocation);
Commands comparisonCommands(CLI::App& app, const Invocation& invocation);
Commands flightCommands(CLI::App& app, const Invocation& invocation);
Commands explorationCommands(CLI::App& app, const Invocation& invocation);
Commands recordingCommands(CLI::App& app, const Invocation& invocation);
Commands toolCommands(CLI::App& app, const Invocation& invocation);

/// Of all commands that `app` has when it runs.
Command completionCommand(CLI::App& app);

void addOutput(CLI::App& parser, const OutputOptions& output, const std::string& defaultFolder);

void addQuiet(CLI::App& parser, bool& quiet);

/// The format of --help.
std::shared_ptr<CLI::FormatterBase> helpFormat();

/// A number from `least` to `most`; its value is the default.
template <typename Number>
void addNumber(CLI::App& parser, const std::string& name, Number& number,
               const std::string& description, Number least, Number most) {
    parser.add_option(name, number, description)
        ->check(CLI::Range(least, most))
        ->capture_default_str();
}

/// --set. Options that override a key as well come before it.
void addOverrides(CLI::App& parser, std::vector<std::string>& overrides);

/// An option that overrides a key of the config, before --set; the config's value is its default.
/// @param text of the key's value, from what was typed; throws InputError
CLI::Option* addValue(CLI::App& parser, std::vector<std::string>& overrides,
                      const std::string& name, const std::string& key,
                      const std::string& description,
                      std::function<std::string(const std::string&)> text = {});

/// --seed, as addValue().
void addSeed(CLI::App& parser, std::vector<std::string>& overrides, const std::string& what);

/// A list of planners, as addValue().
void addPlanners(CLI::App& parser, std::vector<std::string>& overrides, const std::string& key,
                 const std::string& name = "--planners");

/// config, --set and the output.
void addCommon(CLI::App& parser, CommandOptions& options, bool needsConfig = true);

void addJobs(CLI::App& parser, unsigned& jobs);

/// --jobs, --shard, --merge and --resume. Shards are merged without a config.
void addManyRuns(CLI::App& parser, ManyRunsOptions& options, const RunWords& words);

/// --record of the first flight.
void addRecord(CLI::App& parser, std::filesystem::path& folder);

/// "--body-radius" of the key body_radius.
std::string optionOf(const ConfigKey& key);

/// The value of a key as it was typed: lists are typed without brackets.
std::string valueOf(const ConfigKey& key, const std::string& text);

/// An option per key, which sets what the table refers to.
/// @param keys must outlive the parser
/// @param without names of keys that are typed in another way
void addKeyOptions(CLI::App& parser, const KeyTable& keys, const std::set<std::string>& without);

/// Options of a command with keys of the config, of type `Section`, among them.
template <typename Options, typename Section>
struct WithKeys : Options {
    Section typed;  ///< the defaults
    KeyTable keys;  ///< of `typed`
};

/// As addKeyOptions(), and what was typed goes over the config, as with addValue(). Files are meant
/// from the working directory.
void addKeyOverrides(CLI::App& parser, const KeyTable& keys, const std::set<std::string>& without,
                     std::vector<std::string>& overrides);

/// Last part of a path, without a closing slash.
std::string folderName(const std::string& path);

/// For a complete config: options besides it are errors.
/// @throws InputError for the first one that was given
void refuseOptionsBeside(const std::string& config, const CLI::App& parser);

}  // namespace photonav
