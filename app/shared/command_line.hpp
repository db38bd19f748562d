// SPDX-License-Identifier: BSD-3-Clause
// The command lines of the subcommands, and options that several of them share.
#pragma once

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <atomic>
#include <cmath>
#include <functional>
#include <set>
#include <string>

#include "config/key_table.hpp"
#include "io/number.hpp"
#include "shared/command_io.hpp"
#include "shared/many_runs.hpp"

namespace photonav {

/// The reaction of a command to Ctrl-C, SIGTERM, SIGHUP and SIGXCPU.
enum class OnInterrupt {
    finish,       ///< ends with the results so far, or at once if no result folder is begun
    finishAlways  ///< always ends by itself: it writes files without a result folder
};

/// A subcommand: its parser and its function.
struct Command {
    CLI::App* parser;
    std::function<int()> run;  ///< returns the exit code; throws InputError
    OnInterrupt onInterrupt = OnInterrupt::finish;
};

/// Input of every command in addition to its own options.
struct Invocation {
    std::string commandLine;               ///< the command as typed, for reports
    const std::atomic<bool>& interrupted;  ///< set by the signals of OnInterrupt
};

/// Adds a subcommand to `app`. Its options are stored in a value of type `Options`.
/// @param name name of the subcommand
/// @param description sentence for --help
/// @param addOptions called with the parser and the options, which live as long as the command
/// @param run called with the options and Invocation::interrupted; returns the exit code
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

// Each function adds the commands of one folder of app/.
Commands planCommands(CLI::App& app, const Invocation& invocation);
Commands comparisonCommands(CLI::App& app, const Invocation& invocation);
Commands flightCommands(CLI::App& app, const Invocation& invocation);
Commands explorationCommands(CLI::App& app, const Invocation& invocation);
Commands recordingCommands(CLI::App& app, const Invocation& invocation);
Commands toolCommands(CLI::App& app, const Invocation& invocation);

/// Adds `photonav completion`, which prints a completion script for bash or zsh. The script covers
/// all commands that `app` has when the command runs.
Command completionCommand(CLI::App& app);

// Names of the types of values, from which `photonav completion` knows what to offer; a fixed set
// of values has the name "{a,b}".
inline constexpr const char* kPlannersType = "NAMES";
inline constexpr const char* kKeyType = "KEY";
inline constexpr const char* kOverrideType = "KEY.PATH=VALUE";

/// Refuses an option's empty text, which would stand for its default.
const CLI::Validator& notEmpty();

/// Adds --out, --quiet and --json.
/// @param defaultFolder default of --out, for the help text
void addOutput(CLI::App& parser, const OutputOptions& output, const std::string& defaultFolder);

/// Adds --quiet.
void addQuiet(CLI::App& parser, bool& quiet);

/// The format of the help texts: at most 80 columns.
std::shared_ptr<CLI::FormatterBase> helpFormat();

/// Allows the numbers from `least` to `most`.
template <typename Number>
CLI::Option* limit(CLI::Option* option, Number least, Number most) {
    return option->check([=](const std::string& text) {
        const auto number = numberIn(text);
        const bool isAllowed =
            number && *number >= static_cast<double>(least) && *number <= static_cast<double>(most);
        return isAllowed ? std::string()
                         : fmt::format("'{}' is not a number from {} to {}", text, least, most);
    });
}

/// Adds an option for a number from `least` to `most`. The value of `number` is the default.
template <typename Number>
void addNumber(CLI::App& parser, const std::string& name, Number& number,
               const std::string& description, Number least, Number most) {
    limit(parser.add_option(name, number, description), least, most)->capture_default_str();
}

/// Adds --set, which appends to `overrides`. Other options that override keys are inserted before,
/// so that --set has precedence.
void addOverrides(CLI::App& parser, std::vector<std::string>& overrides);

/// Adds an option that overrides a key of the config; --set has precedence. The default is the
/// config's value.
/// @param key path of the key, "planner.alpha"
/// @param text converts the argument into the key's value, and may throw InputError; empty: the
///        argument is the value
CLI::Option* addValue(CLI::App& parser, std::vector<std::string>& overrides,
                      const std::string& name, const std::string& key,
                      const std::string& description,
                      std::function<std::string(const std::string&)> text = {});

/// Adds --seed, which overrides the key `seed`, as addValue().
/// @param what description of the seed
void addSeed(CLI::App& parser, std::vector<std::string>& overrides, const std::string& what);

/// Adds an option for a list of planners, as addValue().
void addPlanners(CLI::App& parser, std::vector<std::string>& overrides, const std::string& key,
                 const std::string& name = "--planners");

/// Adds the argument CONFIG, --set, and the options of addOutput().
void addCommon(CLI::App& parser, CommandOptions& options, bool needsConfig = true);

/// Adds --jobs.
void addJobs(CLI::App& parser, unsigned& jobs);

/// Adds --jobs, --shard, --merge and --resume.
void addManyRuns(CLI::App& parser, ManyRunsOptions& options, const RunWords& words);

/// Adds --record, a folder for a recording of the first flight.
void addRecord(CLI::App& parser, std::filesystem::path& folder);

/// The name of the option for a key: "--body-radius" for body_radius.
std::string optionOf(const ConfigKey& key);

/// The value of a key from the argument of its option: a list gets brackets if they are missing.
std::string valueOf(const ConfigKey& key, const std::string& text);

/// Adds an option per key, which sets the variable of the key.
/// @param keys must outlive the parser
/// @param without names of keys that get no option
void addKeyOptions(CLI::App& parser, const KeyTable& keys, const std::set<std::string>& without);

/// Options of a command together with a section of the config, of type `Section`, as options.
template <typename Options, typename Section>
struct WithKeys : Options {
    Section typed;  ///< values of the options; initially the defaults
    KeyTable keys;  ///< keys of `typed`
};

/// Adds the options of addKeyOptions(). Options that are given also override the config, as with
/// addValue(). File names are relative to the working directory.
void addKeyOverrides(CLI::App& parser, const KeyTable& keys, const std::set<std::string>& without,
                     std::vector<std::string>& overrides);

/// The last component of a path, also if the path ends with a slash.
std::string folderName(const std::string& path);

/// Checks that no option is given together with a complete config, except --out, --quiet and
/// --json.
/// @throws InputError for the first other option
void refuseOptionsBeside(const std::string& config, const CLI::App& parser);

}  // namespace photonav
