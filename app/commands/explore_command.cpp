// SPDX-License-Identifier: BSD-3-Clause
#include "commands/explore_command.hpp"

#include <fmt/format.h>

#include "commands/flight_recording.hpp"
#include "commands/result_folder.hpp"
#include "exploration/explorations.hpp"
#include "io/stopwatch.hpp"
#include "planners/planner_table.hpp"
#include "report/explore_report.hpp"
#include "report/fly_report.hpp"
#include "result/json_values.hpp"

namespace photonav {
namespace {

std::vector<std::string> plannersOf(const Config& config) {
    const std::vector<std::string>& planners = config.explore.planners;
    return planners.empty() ? std::vector{config.planner} : planners;
}

void printFlight(const ExplorationResult& flight, const ExplorationSummary& s) {
    fmt::print("{} after {:.1f} m and {:.1f} s{}\n", nameOf(flight.end), flight.way,
               flight.duration, flight.reason.empty() ? "" : ": " + flight.reason);
    fmt::print(
        "position error (rms) {}, NEES {:.2f}, goal error {}, {} keyframes, "
        "update {:.0f} ms (95 %: {:.0f} ms)\n",
        lengthText(s.positionRmse), s.nees, lengthText(flight.goalError), flight.keyframes,
        1e3 * s.updateMedian, 1e3 * s.update95);
}

void printSummary(const std::vector<ExplorationSummary>& summaries) {
    fmt::print("{:<16} {:>10} {:>10} {:>11} {:>13} {:>10} {:>8} {:>8} {:>11}\n", "planner",
               "arrived", "collisions", "error (rms)", "NEES (median)", "goal error", "duration",
               "length", "mean trace");
    for (const ExplorationSummary& s : summaries) {
        fmt::print("{:<16} {:>10} {:>10} {:>11} {:>13} {:>10} {:>6.1f} s {:>6.1f} m {:>11.3g}\n",
                   s.planner, fmt::format("{} of {}", s.arrived, s.flights), s.collisions,
                   lengthText(s.positionRmse), fmt::format("{:.2f} ({:.2f})", s.nees, s.neesMedian),
                   lengthText(s.goalError), s.duration, s.length, s.meanTrace);
    }
}

bool hasArrived(const std::vector<ExplorationResult>& flights) {
    for (const ExplorationResult& flight : flights) {
        if (flight.planner == flights.front().planner && flight.hasArrived()) return true;
    }
    return false;
}

}  // namespace

int runExplore(const ExploreOptions& options, const std::atomic<bool>& interrupted) {
    const Stopwatch watch;
    const Config config = loadConfig(options.config, options.overrides);
    const World world(config);
    const PlanningProblem problem(config, world);
    const ExplorationSetup setup = setUpExploration(problem);
    FlightRecording recording(options.record, setup.truth.camera, setup.flight.tracker.map);
    FolderTransaction folder = beginResult(options, "explore", {config.sceneFile, config.mapFile});

    const std::vector<std::string> planners = plannersOf(config);
    const unsigned trials = config.explore.trials;
    std::vector<ExplorationResult> flights;
    {
        ProgressLine line(options.quiet);
        std::size_t flown = 0, arrived = 0;
        const auto onEnd = [&](const ExplorationResult& flight) {
            ++flown;
            arrived += flight.hasArrived();
        };
        const auto onUpdate = [&](const ExplorationResult& flight) {
            const PlanUpdate& update = flight.updates.back();
            line.show(
                fmt::format("{} of {} flights, {} arrived; {}, seed {}: {:.1f} s, {:.1f} m "
                            "flown, {:.1f} m to go",
                            flown, planners.size() * trials, arrived, flight.planner, flight.seed,
                            update.time, flight.way, update.length));
        };
        flights = exploreMany(setup, planners, trials, options.jobs, interrupted,
                              {onEnd, onUpdate, recording.onExposure()});
    }
    recording.commit();
    const bool stopped = interrupted;
    const auto summaries = summariesByPlanner(flights, config.belief.characteristicLength);
    nlohmann::json result = exploreResult(setup, flights, summaries, stopped);
    result["time"]["total_s"] = watch.seconds();
    writeExploreReport(folder.path(), setup, world, flights, summaries, options.commandLine,
                       result);
    commitResult(folder, result);

    if (options.json) {
        fmt::print("{}", jsonText(result));
    } else if (!options.quiet) {
        if (flights.size() == 1) printFlight(flights.front(), summaries.front());
        if (flights.size() > 1) printSummary(summaries);
        fmt::print("report: {}\n", (folder.target() / "report.html").string());
    }
    if (stopped) return kInterrupted;
    return hasArrived(flights) ? kDone : kNoAnswer;
}

}  // namespace photonav
