// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include <optional>

#include "commands/command_line.hpp"
#include "commands/explore_command.hpp"
#include "config/config_keys.hpp"
#include "exploration/trial_journal.hpp"

namespace photonav {
namespace {

struct ExploreArguments : ExploreOptions {
    std::string seed;
    std::optional<std::string> planners;
    ExploreConfig typed;  ///< the defaults
    KeyTable keys;        ///< of `typed`
};

/// What was typed goes over the config, as --set would.
void override(const CLI::App& parser, ExploreArguments& options) {
    if (!options.seed.empty()) options.overrides.push_back("seed=" + options.seed);
    if (options.planners) {
        options.overrides.push_back("explore.planners=[" + *options.planners + "]");
    }
    for (const ConfigKey& key : options.keys.keys()) {
        const CLI::Option* option = parser.get_option_no_throw(optionOf(key));
        if (key.words.name == "planners" || option == nullptr || option->count() == 0) continue;
        options.overrides.push_back(
            fmt::format("{}={}", key.path(), valueOf(key, option->results().back())));
    }
}

}  // namespace

Command exploreCommand(CLI::App& app, const Invocation& invocation) {
    auto options = std::make_shared<ExploreArguments>();
    addKeys(options->keys, options->typed);
    options->commandLine = invocation.commandLine;
    CLI::App* parser =
        app.add_subcommand("explore",
                           "Fly to the goal in an unknown scene: map it with the robot's camera, "
                           "and repair the plan on the way. Exit code 0: a flight of the first "
                           "planner arrived.");
    addCommon(*parser, *options, false);
    parser
        ->add_option("--planners,--planner", options->planners,
                     "names of planners, a,b,c (default: planner.name)")
        ->type_name("NAMES");
    addManyRuns(*parser, *options, TrialKind::kWords);
    parser
        ->add_option("--record", options->record, "write the first flight as a TUM RGB-D recording")
        ->type_name("DIR");
    parser
        ->add_option("--serve", options->serve,
                     "show the first flight to browsers while it is flown; 0: at a free port")
        ->type_name("[ADDRESS:]PORT");
    parser->add_flag("--film", options->film, "write a film of the first flight (film.webm)");
    addSeed(*parser, options->seed, "seed of the random numbers of the first trial");
    addKeyOptions(*parser, options->keys, {"planners"});
    return {parser, [options, parser, &interrupted = invocation.interrupted] {
                override(*parser, *options);
                return runExplore(*options, interrupted);
            }};
}

}  // namespace photonav
