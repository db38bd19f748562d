// SPDX-License-Identifier: BSD-3-Clause
#include "config/config_keys.hpp"
#include "exploration/trial_journal.hpp"
#include "explorations/explore_command.hpp"
#include "shared/command_line.hpp"

namespace photonav {
namespace {

using ExploreArguments = WithKeys<ExploreOptions, ExploreConfig>;

void addExploreOptions(CLI::App& parser, ExploreArguments& options) {
    addCommon(parser, options, false);
    addPlanners(parser, options.overrides, "explore.planners", "--planners,--planner");
    addManyRuns(parser, options, TrialKind::kWords);
    addRecord(parser, options.record);
    parser
        .add_option("--serve", options.serve,
                    "show the first flight to browsers while it is flown; 0: at a free port")
        ->type_name("[ADDRESS:]PORT");
    parser.add_flag("--film", options.film, "write a film of the first flight (film.webm)");
    addSeed(parser, options.overrides, "seed of the random numbers of the first trial");
    addKeys(options.keys, options.typed);
    addKeyOverrides(parser, options.keys, {"planners"}, options.overrides);
}

}  // namespace

Commands explorationCommands(CLI::App& app, const Invocation& invocation) {
    return {makeCommand<ExploreArguments>(
        app, invocation, "explore",
        "Fly to the goal in an unknown scene: map it with the robot's camera, and repair the plan "
        "on the way. Exit code 0: a flight of the first planner arrived.",
        addExploreOptions, runExplore)};
}

}  // namespace photonav
