// SPDX-License-Identifier: BSD-3-Clause
// The command line: subcommands and their options, nothing else. Those with many are in
// *_command_line.cpp.
#include <fmt/format.h>
#include <ompl/util/Console.h>
#include <unistd.h>

#include <atomic>
#include <csignal>
#include <cstdio>
#include <filesystem>
#include <new>
#include <string_view>

#include "commands/benchmark_command.hpp"
#include "commands/command_line.hpp"
#include "commands/compare_command.hpp"
#include "commands/doctor_command.hpp"
#include "commands/export_command.hpp"
#include "commands/info_command.hpp"
#include "commands/map_info.hpp"
#include "commands/plan_command.hpp"
#include "commands/reference_command.hpp"
#include "commands/replay_command.hpp"
#include "commands/sweep_command.hpp"
#include "io/error.hpp"
#include "io/folder_transaction.hpp"
#include "io/stopwatch.hpp"
#include "io/yaml_reader.hpp"
#include "map/octree_file.hpp"
#include "render/interruptible_views.hpp"
#include "report/report.hpp"
#include "sweep/sweep_journal.hpp"

namespace {

using namespace photonav;

std::atomic<bool> interrupted{false};
std::atomic<double> interruptedAt{0.};
volatile std::sig_atomic_t interruptedBy = 0;
std::atomic<bool> hasOwnFiles{false};  // of a command that writes no result folder
static_assert(std::atomic<bool>::is_always_lock_free && std::atomic<double>::is_always_lock_free);
const Stopwatch running;

constexpr double kSameInterrupt = 0.2;  // [s]

/// The exit code that a shell gives a program that a signal ended.
int exitCodeOf(int signal) { return 128 + signal; }
static_assert(kInterrupted == 128 + SIGINT);

/// Writes without a lock or a buffer, as a signal handler must.
void say(std::string_view text) {
    static_cast<void>(!write(STDERR_FILENO, text.data(), text.size()));
}

/// The first Ctrl-C, or SIGTERM as Slurm and systemd send it, lets the command finish its files, or
/// ends it at once where there are none yet; the second one always does. timeout(1) sends its
/// signal twice, to the process and to its group: that is one. A command that has not ended a
/// second later says so.
void onInterrupt(int signal) {
    const double now = running.seconds();
    double first = 0.;
    if (!interruptedAt.compare_exchange_strong(first, now)) {
        if (now - first > kSameInterrupt) std::_Exit(exitCodeOf(signal));
        return;
    }
    interruptedBy = signal;
    interrupted = true;
    if (!hasOwnFiles && !FolderTransaction::isAnyOpen()) {
        say("photonav: interrupted before there was any result\n");
        std::_Exit(exitCodeOf(signal));
    }
    alarm(1);
}

void onAlarm(int /*signal*/) {
    say("photonav: interrupted; finishing what is begun and writing the results so far (once more "
        "to stop at once, which keeps an earlier result as it was)\n");
}

Command planCommand(CLI::App& app, const Invocation& invocation) {
    auto options = std::make_shared<PlanOptions>();
    auto seed = std::make_shared<std::string>();
    options->commandLine = invocation.commandLine;
    CLI::App* parser =
        app.add_subcommand("plan", "Plan a perception-aware path in a known scene or map.");
    addCommon(*parser, *options);
    addSeed(*parser, *seed, "seed of all random numbers");
    addValue(*parser, *options, "--alpha", "planner.alpha",
             "1: the shortest path, 0: the most certain one");
    addValue(*parser, *options, "--kappa", "planner.kappa",
             "metres of detour that 1 m of flight at tr(Sigma) = 1 m^2 is worth, or auto [1/m]");
    parser->add_flag(
        "--audit", options->audit,
        "propagate every stored belief again from the start and print the largest error");
    parser->add_flag("--evolution", options->evolution,
                     "show how the trees of RRT* and of the planner grow (figure and animation)");
    return {parser, [options, seed] {
                if (!seed->empty()) options->overrides.push_back("seed=" + *seed);
                return runPlan(*options, interrupted);
            }};
}

Command compareCommand(CLI::App& app) {
    auto options = std::make_shared<CompareOptions>();
    CLI::App* parser = app.add_subcommand(
        "compare", "Every planner, information model and objective on the same problems.");
    parser->add_option("configs", options->configs, "YAML files of planning problems")->required();
    addOverrides(*parser, options->overrides);
    parser->add_option("--runs", options->runs, "seeds per method, from the config's on")
        ->check(CLI::Range(1, 10000))
        ->capture_default_str();
    parser->add_option("--out", options->out, "result folder")->capture_default_str();
    parser->add_flag("--quiet", options->quiet, "no progress, no tables");
    return {parser, [options] { return runCompare(*options, interrupted); }};
}

int describeMap(const CLI::App& parser, InfoOptions& options) {
    for (const char* name : {"--height", "--at", "--cells"}) {
        if (parser.count(name) == 0) continue;
        throw InputError(name, "", "is for a planning problem, not for a map");
    }
    const std::filesystem::path file = options.config;
    if (options.out.empty()) options.out = "out/info-" + file.stem().string();
    const MapReport report = runMapInfo(options);
    printOutput({options.out, options.quiet, options.json}, report.result, report.summary,
                {"report.html"});
    return kDone;
}

Command infoCommand(CLI::App& app, const Invocation& invocation) {
    auto options = std::make_shared<InfoOptions>();
    options->commandLine = invocation.commandLine;
    CLI::App* parser =
        app.add_subcommand("info", "Map the information of views, and of the pixels of one view.");
    addCommon(*parser, *options);
    parser->get_option("config")->description(
        "YAML file of the planning problem; or a map (.ot, .bt), to see what it holds");
    parser
        ->add_option("--height", options->height,
                     "height of the heat map [m] (default: the start's)")
        ->check(CLI::Range(-1e5, 1e5));
    parser->add_option("--at", options->at, "x,y,z[,yaw] of the single view (default: the start)");
    parser->add_option("--cells", options->cells, "cells along the longer side of the heat map")
        ->check(CLI::Range(1, 2000))
        ->capture_default_str();
    return {parser, [options, parser] {
                std::signal(SIGINT, SIG_DFL);  // nothing to keep at any time
                std::signal(SIGTERM, SIG_DFL);
                if (!isOcTreeFile(options->config)) return runInfo(*options);
                return describeMap(*parser, *options);
            }};
}

Command sweepCommand(CLI::App& app, const Invocation& invocation) {
    auto options = std::make_shared<SweepOptions>();
    options->commandLine = invocation.commandLine;
    CLI::App* parser = app.add_subcommand(
        "sweep", "Compare planners over alpha and seeds: the table of the paper.");
    addCommon(*parser, *options, false);
    parser->add_option("--alpha", options->lists.alphas, "first:last:step or a,b,c")
        ->type_name("ALPHAS");
    parser->add_option("--planners", options->lists.planners, "a,b,c")->type_name("NAMES");
    parser->add_option("--runs", options->lists.runs, "seeds per planner and alpha");
    addSeed(*parser, options->lists.seed, "the first seed");
    addManyRuns(*parser, *options, SweepKind::kWords);
    return {parser, [options] { return runSweep(*options, interrupted); }};
}

Command benchmarkCommand(CLI::App& app, const Invocation& invocation) {
    auto options = std::make_shared<BenchmarkOptions>();
    options->commandLine = invocation.commandLine;
    CLI::App* parser =
        app.add_subcommand("benchmark", "Run planners in OMPL's benchmark, for its tools to read.");
    addCommon(*parser, *options);
    parser->add_option("--planners", options->lists.planners, "a,b,c")->type_name("NAMES");
    parser->add_option("--runs", options->lists.runs, "seeds per planner");
    addSeed(*parser, options->lists.seed, "the first seed");
    parser->add_option("--interval", options->interval, "time between samples of the progress [s]")
        ->check(CLI::Range(1e-3, 1e3))
        ->capture_default_str();
    parser->add_option("--time-limit", options->timeLimit, "time limit of a run [s]")
        ->check(CLI::Range(1e-3, 1e6))
        ->capture_default_str();
    return {parser, [options] { return runBenchmark(*options, interrupted); }};
}

Command referenceCommand(CLI::App& app) {
    auto options = std::make_shared<ReferenceOptions>();
    CLI::App* parser =
        app.add_subcommand("reference", "Compute near-optimal reference paths (takes hours).");
    parser->add_option("config", options->config, "YAML file of the planning problem")->required();
    addOverrides(*parser, options->overrides);
    parser->add_option("--alpha", options->lists.alphas, "first:last:step or a,b,c")
        ->type_name("ALPHAS");
    parser->add_option("--planners", options->lists.planners, "a,b,c")->type_name("NAMES");
    parser->add_option("--runs", options->runs, "seeds per planner and alpha")
        ->check(CLI::Range(0, 1000000))
        ->capture_default_str();
    parser->add_option("--vertices", options->vertices, "vertices of each run")
        ->check(CLI::Range(2, 100000000))
        ->capture_default_str();
    parser->add_option("--labels", options->labels, "labels per vertex")
        ->check(CLI::Range(1, 1000000))
        ->capture_default_str();
    parser->add_option("--moves", options->moves, "changes that the descent tries from each path")
        ->check(CLI::Range(0, 1000000000))
        ->capture_default_str();
    parser->add_option("--file", options->file,
                       "the table (default: reference/<config>.csv beside the config)");
    parser->add_flag("--from-scratch", options->fromScratch,
                     "do not start from the paths of the table");
    parser->add_flag("--quiet", options->quiet, "no progress, no summary");
    return {parser, [options] {
                hasOwnFiles = true;
                return runReference(*options, interrupted);
            }};
}

Command reportCommand(CLI::App& app) {
    auto folder = std::make_shared<std::filesystem::path>();
    CLI::App* parser = app.add_subcommand("report", "Rebuild report.html of a result folder.");
    parser->add_option("folder", *folder, "result folder")->required();
    return {parser, [folder] {
                if (!std::filesystem::exists(*folder / "report.json")) {
                    throw InputError(folder->string(), "",
                                     "not a result folder of photonav: no report.json");
                }
                writeReport(*folder / "report.html", readReportJson(*folder / "report.json"));
                Manifest::renew(*folder, "report.html");
                fmt::print("report: {}\n", (*folder / "report.html").string());
                return static_cast<int>(kDone);
            }};
}

Command exportCommand(CLI::App& app) {
    auto folder = std::make_shared<std::filesystem::path>();
    auto file = std::make_shared<std::filesystem::path>();
    auto quiet = std::make_shared<bool>(false);
    CLI::App* parser =
        app.add_subcommand("export", "Write a result as an MCAP file, to be watched in Foxglove.");
    parser->add_option("folder", *folder, "result folder")->required();
    parser->add_option("--out", *file, "the file (default: <folder>.mcap)");
    parser->add_flag("--quiet", *quiet, "prints nothing");
    return {parser, [folder, file, quiet] {
                hasOwnFiles = true;
                return runExport(*folder, *file, *quiet);
            }};
}

Command doctorCommand(CLI::App& app) {
    CLI::App* parser = app.add_subcommand(
        "doctor", "Does it work here? Versions, processor, programs, a sample plan.");
    return {parser, [] {
                hasOwnFiles = true;
                return runDoctor();
            }};
}

std::string withNearest(const std::string& complaint, const std::string& word,
                        const std::vector<std::string>& names) {
    const std::string near = nearestWord(word, names);
    return near.empty() ? complaint : fmt::format("{}, did you mean '{}'?", complaint, near);
}

std::vector<std::string> optionsOf(const CLI::App& parser) {
    std::vector<std::string> names;
    for (const CLI::Option* option : parser.get_options()) {
        for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
    }
    return names;
}

/// What was typed in place of a command or an option, when that is what is wrong.
std::string complaint(const CLI::App& app, const CLI::ParseError& error) {
    const auto code = static_cast<CLI::ExitCodes>(error.get_exit_code());
    const std::vector<std::string> unknown = app.remaining(true);
    const bool isUnknown =
        code == CLI::ExitCodes::ExtrasError || code == CLI::ExitCodes::RequiredError;
    if (!isUnknown || unknown.empty()) return error.what();
    const std::string& word = unknown.front();
    const std::vector<CLI::App*> chosen = app.get_subcommands();
    if (word.starts_with('-')) {
        const CLI::App& parser = chosen.empty() ? app : *chosen.front();
        return withNearest(word + ": no such option", word, optionsOf(parser));
    }
    if (!chosen.empty()) return error.what();
    std::vector<std::string> names;
    for (const CLI::App* command : app.get_subcommands({})) names.push_back(command->get_name());
    return withNearest(word + ": no such command", word, names);
}

int run(int argc, char** argv) {
    CLI::App app{
        "photonav: paths on which the camera sees enough texture to be localised.\n"
        "Start with: photonav plan config/two_textures.yaml",
        "photonav"};
    app.set_version_flag("--version", PHOTONAV_VERSION);
    app.require_subcommand(1);
    Invocation invocation{"photonav", interrupted};
    for (int i = 1; i < argc; ++i) invocation.commandLine += std::string(" ") + argv[i];

    const std::array commands{planCommand(app, invocation),
                              infoCommand(app, invocation),
                              flyCommand(app, invocation),
                              exploreCommand(app, invocation),
                              mapCommand(app, invocation),
                              sweepCommand(app, invocation),
                              compareCommand(app),
                              benchmarkCommand(app, invocation),
                              referenceCommand(app),
                              replayCommand(app, invocation),
                              checkCommand(app, invocation),
                              servoCommand(app, invocation),
                              calibrateDepthCommand(app, invocation),
                              reportCommand(app),
                              exportCommand(app),
                              keysCommand(app),
                              completionCommand(app),
                              doctorCommand(app)};
    app.footer(  // after the commands, which would inherit it

        "plan, check, fly, explore, servo, sweep, benchmark, info, map and replay write "
        "result.json,\n"
        "figures, report.html and config.yaml (complete, re-runnable) into their folder (--out);\n"
        "compare writes tables, figures and result.json, reference its table alone;\n"
        "calibrate-depth writes camera.yaml and result.json, export a file.\n"
        "photonav COMMAND --help lists the options of a command, photonav keys those of a config.\n"
        "Exit codes: 0 done; 1 ran, but found no answer; 2 bad input; 130 stopped by Ctrl-C, 143 "
        "by\n"
        "SIGTERM, with the results so far.");
    try {
        app.parse(argc, argv);
    } catch (const CLI::ParseError& error) {
        if (error.get_exit_code() == 0) return app.exit(error);
        fmt::print(stderr, "photonav: {} (see photonav --help)\n", complaint(app, error));
        return kBadInput;
    }
    for (const Command& command : commands) {
        if (!command.parser->parsed()) continue;
        const int code = command.run();
        if (code != kInterrupted) return code;
        fmt::print(stderr, "photonav: interrupted; what was done until then is kept\n");
        return exitCodeOf(interruptedBy);
    }
    return kBadInput;
}

}  // namespace

int main(int argc, char** argv) {
    std::signal(SIGINT, onInterrupt);
    std::signal(SIGTERM, onInterrupt);
    std::signal(SIGALRM, onAlarm);
    ompl::msg::noOutputHandler();
    const std::string command = argc > 1 ? argv[1] : "";
    const auto fail = [](int code, std::string_view reason) {
        fmt::print(stderr, "photonav: {}\n", oneLine(reason));
        return code;
    };
    try {
        const int code = run(argc, argv);
        if (std::fflush(stdout) == 0 && std::ferror(stdout) == 0) return code;
        return fail(kNoAnswer, "standard output cannot be written");
    } catch (const InputError& error) {
        return fail(kBadInput, error.what());
    } catch (const std::filesystem::filesystem_error& error) {
        return fail(kBadInput, error.path1().string() + ": " + error.code().message());
    } catch (const RenderingStopped&) {
        return fail(exitCodeOf(interruptedBy), "interrupted before there was any result");
    } catch (const std::bad_alloc&) {
        return fail(kNoAnswer, command + ": needs more memory than there is");
    } catch (const std::exception& error) {
        return fail(kNoAnswer, command + ": " + error.what());
    }
}
