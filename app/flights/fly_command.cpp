// SPDX-License-Identifier: BSD-3-Clause
#include "flights/fly_command.hpp"

#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <algorithm>

#include "flight/flight_setup.hpp"
#include "flights/flight_recording.hpp"
#include "flights/fly_frames.hpp"
#include "flights/fly_report.hpp"
#include "io/error.hpp"
#include "io/stopwatch.hpp"
#include "planners/planner_table.hpp"
#include "plans/plan_progress.hpp"
#include "problem/planned_path.hpp"
#include "replay/calibration_file.hpp"
#include "result/json_values.hpp"
#include "result/text_table.hpp"
#include "shared/result_folder.hpp"

namespace photonav {
namespace {

/// The config's planner first, then RRT* if it is to be compared with.
std::vector<FlightSet> planAll(const Config& config, PlanningProblem& problem, ProgressLine& line,
                               const std::atomic<bool>& interrupted) {
    std::vector<FlightSet> sets;
    const auto add = [&](EvaluatedPath path) {
        std::vector<PlannedView> plan = plannedViews(path.points);
        if (plan.size() < 2) throw config.invalid("goal", "is the start: nothing to fly");
        sets.push_back({std::move(path), std::move(plan), {}});
    };
    const auto solve = [&](const std::string& name) {
        auto outcome = problem.solve(name, interrupted, shownOn(line, config.vertices, name));
        if (outcome.path) add(std::move(*outcome.path));
    };
    const double kappa = problem.kappa(interrupted, kappaShownOn(line, config));
    if (!interrupted) sayKappa(line, config, kappa);
    if (!config.fly.plan.empty()) {
        const PlannedPath path = readPlannedPath(config.fly.plan, config);
        add(problem.evaluate(path.planner, path.waypoints, interrupted));
    } else {
        solve(config.planner);
    }
    const bool isCompared = config.compareWithRrtStar && usesViews(config.planner);
    if (!sets.empty() && isCompared && !interrupted) solve("rrt_star");
    return sets;
}

/// @return the first flight of each plan, to be played
std::vector<ReportFrame> flyAll(std::vector<FlightSet>& sets, const FlightSetup& setup,
                                const FlyOptions& options, FlightRecording& recording,
                                unsigned count, ProgressLine& line,
                                const std::atomic<bool>& interrupted) {
    std::vector<ReportFrame> frames;
    const std::size_t all = count * sets.size();
    std::size_t flown = 0, arrived = 0;
    line.beginPhase();
    for (FlightSet& set : sets) {
        const auto onFlight = [&](const FlightResult& result) {
            ++flown;
            arrived += result.end == FlightEnd::arrived;
            line.show(fmt::format("{}: {} of {} flights, {} arrived", set.path.planner, flown, all,
                                  arrived),
                      static_cast<double>(flown) / static_cast<double>(all));
        };
        const OnExposure record = &set == &sets.front() ? recording.onExposure() : OnExposure{};
        SparseExposures exposures;
        const auto onExposure = [&](const Exposed& exposed) {
            exposures.add(exposed);
            if (record) record(exposed);
        };
        set.flights = flyMany(set.plan, setup.world, setup.options, count, options.jobs,
                              interrupted, onFlight, onExposure);
        if (set.flights.empty() || set.flights.front().number != 0) continue;
        for (ReportFrame& frame :
             flightFrames(set.path.planner, set.flights.front(), exposures.kept(), setup.world)) {
            frames.push_back(std::move(frame));
        }
    }
    recording.commit();
    return frames;
}

/// The ellipse of where a flight ended, and what it is worth.
std::string uncertaintyText(const FlightResult& flight) {
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(flight.believedGoal->covariance);
    const Eigen::Vector3d sigma = solver.eigenvalues().cwiseMax(0.).cwiseSqrt();
    return fmt::format("standard deviations of {}, {} and {}: there with a probability of {:.1f} %",
                       lengthText(sigma.z()), lengthText(sigma.y()), lengthText(sigma.x()),
                       100. * flight.arrivalProbability);
}

void printFailure(const FlightSet& set) {
    const FlightSummary s = summarise(set);
    if (s.flights == 0 || s.arrived > 0) return;
    fmt::print(
        "no flight of {} arrived: {} astray, {} at the goal without being certain, {} collided, {} "
        "gave up lost, {} out of time\n",
        set.path.planner, s.astray, s.uncertain, s.collisions, s.lost, s.outOfTime);
    for (const FlightResult& flight : set.flights) {
        if (flight.end != FlightEnd::uncertain) continue;
        fmt::print("flight {} ended at its believed goal with {}\n", flight.number,
                   uncertaintyText(flight));
        return;
    }
}

const std::vector<std::string> kFlightColumns{
    "planner",   "arrived",  "astray",        "uncertain",    "collisions", "error (rms)",
    "predicted", "believed", "NEES (median)", "NEES at goal", "lost (sum)", "goal error"};

std::vector<std::string> flightRow(const FlightSet& set) {
    const FlightSummary s = summarise(set);
    if (s.flights == 0) {
        std::vector<std::string> row{set.path.planner, "not flown"};
        row.resize(kFlightColumns.size());
        return row;
    }
    const auto number = [](std::size_t value) { return fmt::format("{}", value); };
    return {set.path.planner,
            fmt::format("{} of {}", s.arrived, s.flights),
            number(s.astray),
            number(s.uncertain),
            number(s.collisions),
            lengthText(s.positionRmse),
            lengthText(s.predictedSigma),
            lengthText(s.believedSigma),
            fmt::format("{:.2f} ({:.2f})", s.nees, s.neesMedian),
            fmt::format("{:.2f}", s.neesAtGoal),
            fmt::format("{:.1f} s", s.lostTime),
            lengthText(s.goalError)};
}

void printSummary(const std::vector<FlightSet>& sets) {
    if (sets.empty()) {
        fmt::print("no path to fly\n");
        return;
    }
    TextTable table{kFlightColumns, {}};
    for (const FlightSet& set : sets) table.rows.push_back(flightRow(set));
    fmt::print("{}", alignedText(table));
    if (!sets.front().flights.empty()) {
        const FlightSummary s = summarise(sets.front());
        fmt::print("consistent at the goal: {:.2f} to {:.2f} (95 % of chi-square)\n", s.neesLow,
                   s.neesHigh);
    }
    printFailure(sets.front());
}

InputPaths inputsOfFlight(const FlyOptions& options, const Config& config) {
    return inputsOf(config, {options.config, options.calibration});
}

bool isNothingFlown(const std::vector<FlightSet>& sets) {
    return std::all_of(sets.begin(), sets.end(),
                       [](const FlightSet& set) { return set.flights.empty(); });
}

/// A folder has its own plan.
void checkNamesOnePlan(const FlyOptions& options) {
    for (const std::string& text : options.overrides) {
        if (!text.starts_with("fly.plan=")) continue;
        throw InputError("--set", "fly.plan",
                         fmt::format("{} is a plan already; give its config", options.config));
    }
}

FolderTransaction folderFor(const FlyOptions& options, const Config& config) {
    const std::filesystem::path plan = config.fly.plan;
    const CommandOptions& common = options;
    CommandOptions named = common;
    if (!plan.empty()) {  // named as the plan, not as "config"
        named.config = plan.parent_path().filename().string() + ".";
    }
    return beginResult(named, "fly", inputsOfFlight(options, config));
}

/// The config's own plan is the first one: what it is compared with is no success.
bool hasArrived(const std::vector<FlightSet>& sets) {
    return !sets.empty() && summarise(sets.front()).arrived > 0;
}

}  // namespace

int runFly(const FlyOptions& options, const std::atomic<bool>& interrupted) {
    const Stopwatch watch;
    const PlanSource source = findPlan(options.config);
    Config config = loadConfig(source.configFile, options.overrides);
    if (!source.resultFile.empty()) {
        checkNamesOnePlan(options);
        config.fly.plan = std::filesystem::absolute(source.resultFile).lexically_normal().string();
    }
    const World world(config);
    PlanningProblem problem(config, world, alphaOf(config.planner, config.belief.alpha));
    problem.checkPlaces();
    const FlightSetup setup = setUpFlight(problem);
    if (!options.calibration.empty()) readCalibration(options.calibration, setup.map);
    FolderTransaction folder = folderFor(options, config);
    FlightRecording recording(options.record, folder.target(), inputsOfFlight(options, config),
                              setup.world.camera, setup.options.tracker.map);

    std::vector<FlightSet> sets;
    std::vector<ReportFrame> frames;
    {
        ProgressLine line(options.quiet);
        sets = planAll(config, problem, line, interrupted);
        frames = flyAll(sets, setup, options, recording, config.fly.flights, line, interrupted);
    }
    const bool stopped = interrupted;
    if (stopped && keepsEarlierResult(folder, isNothingFlown(sets))) return kInterrupted;
    nlohmann::json result = flyResult(config, sets, setup.options, stopped);
    result["time"]["total_s"] = watch.seconds();
    writeFlyReport(folder.path(), config, world, sets, std::move(frames), options.commandLine,
                   result);
    concludeResult(folder, options, result, [&] { printSummary(sets); });
    if (stopped) return kInterrupted;
    return hasArrived(sets) ? kDone : kNoAnswer;
}

}  // namespace photonav
