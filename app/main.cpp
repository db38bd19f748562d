// SPDX-License-Identifier: BSD-3-Clause
// The command line: subcommands and their options, nothing else.
#include <fmt/format.h>
#include <ompl/util/Console.h>

#include <CLI/CLI.hpp>
#include <atomic>
#include <csignal>
#include <cstdio>

#include "benchmark_command.hpp"
#include "command_io.hpp"
#include "compare_command.hpp"
#include "depth_filter.hpp"
#include "error.hpp"
#include "fly_command.hpp"
#include "info_command.hpp"
#include "map_command.hpp"
#include "map_config.hpp"
#include "plan_command.hpp"
#include "reference_command.hpp"
#include "replay_command.hpp"
#include "report.hpp"
#include "scan_command.hpp"
#include "sweep_command.hpp"

namespace {

using namespace photonav;

/// A subcommand and what to do when it was chosen.
struct Command {
    CLI::App* parser;
    std::function<int()> run;
};

std::atomic<bool> interrupted{false};
static_assert(std::atomic<bool>::is_always_lock_free);

/// The first Ctrl-C asks politely, the second one does not.
void onInterrupt(int) {
    if (interrupted.exchange(true)) std::_Exit(kInterrupted);
}

const CLI::Validator kNotEmpty(
    [](const std::string& text) { return std::string(text.empty() ? "must not be empty" : ""); },
    "");

void addCommon(CLI::App* command, CommandOptions& options, bool needsConfig = true) {
    command->add_option("config", options.config, "YAML file of the planning problem")
        ->required(needsConfig);
    command->add_option("--set", options.overrides, "override a value of the config")
        ->type_name("KEY.PATH=VALUE")
        ->allow_extra_args(false);
    command->add_option("--out", options.out, "result folder (default: out/<command>-<config>)")
        ->check(kNotEmpty);
    command->add_flag("--quiet", options.quiet, "no progress, no summary");
    command->add_flag("--json", options.json, "result.json on standard output");
}

Command planCommand(CLI::App& app, const std::string& commandLine) {
    auto options = std::make_shared<PlanOptions>();
    auto seed = std::make_shared<std::string>();
    options->commandLine = commandLine;
    CLI::App* parser =
        app.add_subcommand("plan", "Plan a perception-aware path in a known scene or map.");
    addCommon(parser, *options);
    parser->add_option("--seed", *seed, "of everything random (overrides the config)");
    parser->add_flag("--audit", options->audit,
                     "print what replaying every stored belief from the start gave");
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
    parser->add_option("--set", options->overrides, "override a value of the configs")
        ->type_name("KEY.PATH=VALUE")
        ->allow_extra_args(false);
    parser->add_option("--runs", options->runs, "seeds per method")
        ->check(CLI::Range(1, 10000))
        ->capture_default_str();
    parser->add_option("--out", options->out, "result folder")->capture_default_str();
    parser->add_flag("--quiet", options->quiet, "no progress, no tables");
    return {parser, [options] { return runCompare(*options, interrupted); }};
}

Command infoCommand(CLI::App& app, const std::string& commandLine) {
    auto options = std::make_shared<InfoOptions>();
    options->commandLine = commandLine;
    CLI::App* parser = app.add_subcommand(
        "info", "Show where a view is worth something, and which of its pixels.");
    addCommon(parser, *options);
    parser->add_option("--height", options->height, "of the heat map [m] (default: the start's)");
    parser->add_option("--at", options->at, "x,y,z[,yaw] of the single view (default: the start)");
    parser->add_option("--cells", options->cells, "along the longer side of the heat map")
        ->check(CLI::Range(1, 2000))
        ->capture_default_str();
    return {parser, [options] {
                std::signal(SIGINT, SIG_DFL);  // seconds of work, nothing to keep
                return runInfo(*options);
            }};
}

void printSummary(const ReportTable& table, const std::filesystem::path& folder) {
    for (const auto& [label, value] : table.rows) fmt::print("{:<42}{}\n", label, value);
    fmt::print("map: {}\nreport: {}\n", (folder / "map.ot").string(),
               (folder / "report.html").string());
}

/// The options of `map` for a laser scan; those that belong to images are errors.
ScanMapOptions scanOptions(const CLI::App& parser, const MapOptions& options,
                           const std::vector<double>& scanner) {
    for (const char* name : {"--camera", "--up", "--every", "--frames", "--min-range",
                             "--depth-scale", "--tolerance", "--depth"}) {
        if (parser.count(name) > 0) throw InputError(name, "", "is for images, not point clouds");
    }
    ScanMapOptions scan;
    scan.commandLine = options.commandLine;
    if (!isScan(options.dataset)) {  // the config of an earlier map
        readScanConfig(options.dataset, scan);
        return scan;
    }
    scan.scans = options.dataset;
    scan.resolution = options.resolution;
    if (parser.count("--max-range") > 0) scan.maxRange = options.fusion.maxRange;
    if (!scanner.empty()) scan.scanner.emplace(scanner.data());
    return scan;
}

/// Last part of a path, without a closing slash.
std::string nameOf(const std::string& path) {
    return (std::filesystem::path(path) / "").lexically_normal().parent_path().filename().string();
}

/// The config of an earlier map says everything.
void refuseOptionsBeside(const std::string& config, const CLI::App& parser) {
    for (const CLI::Option* option : parser.get_options()) {
        const std::string name = option->get_name();
        if (option->count() > 0 && name.starts_with("--") && name != "--out" && name != "--quiet" &&
            name != "--json") {
            throw InputError(name, "", "not together with a config; edit " + config);
        }
    }
}

Command mapCommand(CLI::App& app, const std::string& commandLine) {
    struct Options : MapOptions {
        bool quiet = false;
        bool json = false;
        std::vector<double> scanner;
    };
    auto options = std::make_shared<Options>();
    options->commandLine = commandLine;
    CLI::App* parser = app.add_subcommand(
        "map", "Turn a recorded RGB-D sequence or laser scans into a textured OctoMap.");
    parser
        ->add_option("dataset", options->dataset,
                     "folder in the TUM RGB-D layout; or a coloured point cloud (.ply), or a "
                     "folder with one per station of the scanner; or the config.yaml of an earlier "
                     "map")
        ->required();
    parser->add_option("--out", options->out, "result folder (default: out/map-<dataset>)")
        ->check(kNotEmpty);
    parser->add_option("--resolution", options->resolution, "edge of a cell [m]")
        ->capture_default_str();
    parser->add_option("--camera", options->cameraFile,
                       "camera.yaml to use instead of the dataset's");
    parser
        ->add_option("--up", options->up,
                     "what points up in the recorded world: x ... -z, a direction x,y,z, or floor")
        ->capture_default_str();
    parser->add_option("--every", options->every, "use every n-th frame")->capture_default_str();
    parser->add_option("--frames", options->frames, "only the frames from a on and before b")
        ->type_name("A:B");
    parser
        ->add_option("--depth", options->depth,
                     "recorded, or monocular: from the images and their poses alone")
        ->capture_default_str();
    parser->add_option("--min-range", options->fusion.minRange, "nearest depth trusted [m]")
        ->capture_default_str();
    parser
        ->add_option("--max-range", options->fusion.maxRange,
                     "farthest surface entered [m] (point clouds: 40)")
        ->capture_default_str();
    parser
        ->add_option("--scanner", options->scanner,
                     "x,y,z of the scanner, for a point cloud that does not say it")
        ->delimiter(',')
        ->expected(3);
    parser->add_option("--depth-scale", options->depthScale,
                       "depth image value of one metre (default: the dataset's)");
    parser->add_option("--tolerance", options->tolerance, "largest difference of timestamps [s]")
        ->capture_default_str();
    parser->add_flag("--quiet", options->quiet, "no progress, no summary");
    parser->add_flag("--json", options->json, "result.json on standard output");
    return {
        parser, [options, parser] {
            const std::string dataset = options->dataset;
            const bool isConfig = std::filesystem::path(dataset).extension() == ".yaml";
            if (isConfig) refuseOptionsBeside(dataset, *parser);
            const bool isOfScans = isConfig ? isScanConfig(dataset) : isScan(dataset);
            ScanMapOptions scan;
            if (isOfScans) {
                scan = scanOptions(*parser, *options, options->scanner);
            } else if (!options->scanner.empty()) {
                throw InputError("--scanner", "", "is for point clouds, not images");
            } else if (isConfig) {
                readMapConfig(dataset, *options);
            }
            if (options->depth == "monocular" && !isConfig && parser->count("--min-range") == 0) {
                options->fusion.minRange = DepthFilterOptions().minDepth;
            }
            if (options->out.empty()) {
                options->out = "out/map-" + nameOf(isOfScans ? scan.scans : options->dataset);
            }
            scan.out = options->out;
            ProgressLine line(options->quiet);
            scan.progress = options->progress = [&line](std::size_t done, std::size_t total) {
                line.show(fmt::format("{} of {} fused", done, total));
            };
            const MapReport report =
                isOfScans ? runScanMap(scan, interrupted) : runMap(*options, interrupted);
            line.clear();
            if (options->json)
                fmt::print("{}\n", report.result.dump(2));
            else if (!options->quiet)
                printSummary(report.summary, options->out);
            return report.exitCode;
        }};
}

void addReplayOptions(CLI::App& parser, ReplayOptions& options) {
    parser.add_option("dataset", options.dataset, "folder in the TUM RGB-D or the EuRoC layout")
        ->required();
    parser.add_option("--map", options.mapFile,
                      "localise in this textured octree (.ot), mesh or scene file");
    parser.add_flag("--odometry", options.odometry, "from image to image instead, without a map");
    parser.add_option("--start", options.start, "x,y,z,qx,qy,qz,qw of the first frame's camera")
        ->type_name("POSE");
    parser.add_option("--start-sigma", options.startSigma, "its standard deviation [m] and [rad]")
        ->capture_default_str();
    parser.add_option("--every", options.every, "use every n-th frame")->capture_default_str();
    parser.add_option("--frames", options.frames, "only the frames from a on and before b")
        ->type_name("A:B");
    parser.add_option("--camera", options.cameraFile,
                      "camera.yaml to use instead of the dataset's");
    parser.add_option("--depth-scale", options.depthScale,
                      "depth image value of one metre (default: the dataset's)");
    parser
        .add_option("--up", options.up,
                    "what points up in the recorded world: x ... -z, a direction x,y,z, or floor")
        ->capture_default_str();
    parser.add_option("--tolerance", options.tolerance, "largest difference of timestamps [s]")
        ->capture_default_str();
    parser.add_option("--stereo", options.stereo, "bm or sgbm: block matching, semi-global")
        ->capture_default_str();
    parser.add_option("--sigma", options.sigma, "image noise, grey values in [0, 1]")
        ->capture_default_str();
    parser.add_option("--scale", options.scale,
                      "factor on the information (default: the tracker's)");
    parser
        .add_option("--floor", options.floorTranslation,
                    "least standard deviation of a position in a map [m]")
        ->capture_default_str();
    parser.add_option("--floor-rotation", options.floorRotation, "the same of a rotation [rad]")
        ->capture_default_str();
    parser
        .add_option("--max-width", options.maxWidth,
                    "images are halved until they are as wide, with --map")
        ->capture_default_str();
    parser
        .add_option("--min-overlap", options.minOverlap,
                    "least share of an image that the model must cover")
        ->capture_default_str();
    parser.add_flag("--calibrate", options.calibrate,
                    "fit factor and floor that would have made the covariances true");
    parser.add_flag("!--no-exposure", options.exposure, "images do not change in brightness");
}

Command replayCommand(CLI::App& app, const std::string& commandLine) {
    struct Options : ReplayOptions {
        bool quiet = false;
        bool json = false;
    };
    auto options = std::make_shared<Options>();
    options->commandLine = commandLine;
    CLI::App* parser = app.add_subcommand(
        "replay", "Track a recorded flight, in a map or by odometry, and say how well.");
    addReplayOptions(*parser, *options);
    parser->add_option("--out", options->out, "result folder (default: out/replay-<dataset>)")
        ->check(kNotEmpty);
    parser->add_flag("--quiet", options->quiet, "no progress, no summary");
    parser->add_flag("--json", options->json, "result.json on standard output");
    return {parser, [options] {
                if (options->out.empty()) {
                    options->out =
                        std::filesystem::path("out") / ("replay-" + nameOf(options->dataset));
                }
                ProgressLine line(options->quiet);
                options->progress = [&line](std::size_t done, std::size_t total) {
                    line.show(fmt::format("{} of {} frames", done, total));
                };
                const ReplayReport report = runReplay(*options, interrupted);
                line.clear();
                if (options->json) {
                    fmt::print("{}\n", report.result.dump(2));
                } else if (!options->quiet) {
                    for (const auto& [label, value] : report.summary.rows) {
                        fmt::print("{:<42}{}\n", label, value);
                    }
                    fmt::print("report: {}\n", (options->out / "report.html").string());
                }
                return report.exitCode;
            }};
}

Command sweepCommand(CLI::App& app, const std::string& commandLine) {
    auto options = std::make_shared<SweepOptions>();
    options->commandLine = commandLine;
    CLI::App* parser = app.add_subcommand(
        "sweep", "Compare planners over alpha and seeds: the table of the paper.");
    addCommon(parser, *options, false);
    parser->add_option("--alpha", options->alphas, "first:last:step or a,b,c")->type_name("ALPHAS");
    parser->add_option("--planners", options->planners, "a,b,c")->type_name("NAMES");
    parser->add_option("--runs", options->runs, "seeds per planner and alpha");
    parser->add_option("--seed", options->seed, "the first seed (overrides the config)");
    parser->add_option("--jobs", options->jobs, "threads")
        ->check(CLI::Range(1, 4096))
        ->capture_default_str();
    parser->add_option("--shard", options->shard, "do only part k of n")->type_name("K/N");
    parser->add_option("--merge", options->merge, "one table from the folders of all n shards")
        ->type_name("DIR...");
    parser->add_flag("--resume", options->resume, "go on with what the result folder holds");
    return {parser, [options] { return runSweep(*options, interrupted); }};
}

Command benchmarkCommand(CLI::App& app, const std::string& commandLine) {
    auto options = std::make_shared<BenchmarkOptions>();
    options->commandLine = commandLine;
    CLI::App* parser =
        app.add_subcommand("benchmark", "Run planners in OMPL's benchmark, for its tools to read.");
    addCommon(parser, *options);
    parser->add_option("--planners", options->planners, "a,b,c")->type_name("NAMES");
    parser->add_option("--runs", options->runs, "seeds per planner");
    parser->add_option("--seed", options->seed, "the first seed (overrides the config)");
    parser->add_option("--interval", options->interval, "between samples of the progress [s]")
        ->check(CLI::Range(1e-3, 1e3))
        ->capture_default_str();
    parser->add_option("--time-limit", options->timeLimit, "of a run that gets nowhere [s]")
        ->check(CLI::Range(1e-3, 1e6))
        ->capture_default_str();
    return {parser, [options] { return runBenchmark(*options, interrupted); }};
}

Command referenceCommand(CLI::App& app) {
    auto options = std::make_shared<ReferenceOptions>();
    CLI::App* parser = app.add_subcommand(
        "reference", "Find the best paths that can be found: hours, for others to be measured by.");
    parser->add_option("config", options->config, "YAML file of the planning problem")->required();
    parser->add_option("--set", options->overrides, "override a value of the config")
        ->type_name("KEY.PATH=VALUE")
        ->allow_extra_args(false);
    parser->add_option("--alpha", options->alphas, "first:last:step or a,b,c")->type_name("ALPHAS");
    parser->add_option("--planners", options->planners, "a,b,c")->type_name("NAMES");
    parser->add_option("--runs", options->runs, "seeds per planner and alpha")
        ->capture_default_str();
    parser->add_option("--vertices", options->vertices, "of each run")->capture_default_str();
    parser->add_option("--labels", options->labels, "per vertex")->capture_default_str();
    parser->add_option("--moves", options->moves, "tried by the descent from each path")
        ->capture_default_str();
    parser->add_option("--file", options->file,
                       "the table (default: reference/<config>.csv beside the config)");
    parser->add_flag("--from-scratch", options->fromScratch, "forget the paths known so far");
    parser->add_flag("--quiet", options->quiet, "no progress, no summary");
    return {parser, [options] { return runReference(*options, interrupted); }};
}

Command flyCommand(CLI::App& app, const std::string& commandLine) {
    auto options = std::make_shared<FlyOptions>();
    auto seed = std::make_shared<std::string>();
    options->commandLine = commandLine;
    CLI::App* parser =
        app.add_subcommand("fly", "Fly a plan in closed loop, many times, beside RRT*'s.");
    addCommon(parser, *options);
    const auto number = [parser](const char* name, double& value, const char* what, double least,
                                 double most) {
        parser->add_option(name, value, what)
            ->check(CLI::Range(least, most))
            ->capture_default_str();
    };
    parser->get_option("config")->description("YAML file, or result folder of photonav plan");
    parser->add_option("--flights", options->flights, "per planner")
        ->check(CLI::Range(1, 1000000))
        ->capture_default_str();
    parser->add_option("--jobs", options->jobs, "threads")
        ->check(CLI::Range(1, 4096))
        ->capture_default_str();
    parser->add_option("--seed", *seed, "of everything random (overrides the config)");
    number("--speed", options->speed, "at most [m/s]", 0.01, 100.);
    number("--rate", options->rate, "of the camera [Hz] (0: a view every planner.ds)", 0., 1000.);
    number("--latency", options->latency, "of images [s]", 0., 10.);
    number("--drop", options->drop, "share of the images that never arrive", 0., 1.);
    number("--black", options->black, "share of the images that are black", 0., 1.);
    parser->add_option("--blackout", options->blackout, "a time of black images [s]")
        ->type_name("START,LENGTH");
    parser
        ->add_option("--camera", options->camera,
                     "noise of the images: as the config assumes, or as real cameras have")
        ->check(CLI::IsMember({"assumed", "real"}))
        ->capture_default_str();
    number("--odometry", options->odometry, "true variance of the odometry by the assumed one", 0.,
           1e6);
    number("--body-radius", options->bodyRadius,
           "of collisions [m] (0: half of robot.radius, the rest is margin)", 0., 1e3);
    parser->add_flag("--photometric-goal,!--no-photometric-goal", options->photometricGoal,
                     "servo on the goal's image at the end (the default)");
    parser
        ->add_option("--record", options->record, "write the first flight as a TUM RGB-D recording")
        ->type_name("DIR");
    return {parser, [options, seed] {
                if (!seed->empty()) options->overrides.push_back("seed=" + *seed);
                return runFly(*options, interrupted);
            }};
}

Command reportCommand(CLI::App& app) {
    auto folder = std::make_shared<std::filesystem::path>();
    CLI::App* parser = app.add_subcommand("report", "Rebuild report.html of a result folder.");
    parser->add_option("folder", *folder, "result folder")->required();
    return {parser, [folder] {
                writeReport(*folder / "report.html", readReportData(*folder / "report.json"));
                fmt::print("report: {}\n", (*folder / "report.html").string());
                return static_cast<int>(kDone);
            }};
}

int run(int argc, char** argv) {
    CLI::App app{
        "photonav: paths on which the camera always sees enough texture to know where it is.\n"
        "Start with: photonav plan config/two_textures.yaml",
        "photonav"};
    app.set_version_flag("--version", PHOTONAV_VERSION);
    app.require_subcommand(1);
    app.footer(
        "Every run writes result.json, figures, report.html and config.yaml (complete,\n"
        "re-runnable) into its folder.\n"
        "Exit codes: 0 done; 1 ran, but found no answer; 2 bad input; 130 stopped by Ctrl-C.");
    std::string commandLine = "photonav";
    for (int i = 1; i < argc; ++i) commandLine += std::string(" ") + argv[i];

    const std::array commands{planCommand(app, commandLine),      infoCommand(app, commandLine),
                              flyCommand(app, commandLine),       mapCommand(app, commandLine),
                              sweepCommand(app, commandLine),     compareCommand(app),
                              benchmarkCommand(app, commandLine), referenceCommand(app),
                              replayCommand(app, commandLine),    reportCommand(app)};
    try {
        app.parse(argc, argv);
    } catch (const CLI::ParseError& error) {
        if (error.get_exit_code() == 0) return app.exit(error);
        fmt::print(stderr, "photonav: {} (see photonav --help)\n", error.what());
        return kBadInput;
    }
    for (const Command& command : commands) {
        if (command.parser->parsed()) return command.run();
    }
    return kBadInput;
}

}  // namespace

int main(int argc, char** argv) {
    std::signal(SIGINT, onInterrupt);
    ompl::msg::noOutputHandler();
    try {
        return run(argc, argv);
    } catch (const std::exception& error) {
        fmt::print(stderr, "photonav: {}\n", error.what());
        return kBadInput;
    }
}
