// SPDX-License-Identifier: BSD-3-Clause
#include "explorations/explore_report.hpp"

#include <fmt/format.h>

#include <cmath>

#include "dataset/belief_trajectory.hpp"
#include "exploration/real_time_json.hpp"
#include "figures/explore_figures.hpp"
#include "figures/flight_log_figures.hpp"
#include "flight/flight_statistics.hpp"
#include "flight/fly_result.hpp"
#include "map/octree_file.hpp"
#include "render/voxel_grid.hpp"
#include "report/problem_report.hpp"
#include "result/json_values.hpp"

namespace photonav {
namespace fs = std::filesystem;
using nlohmann::json;
namespace {

ReportTable tableOf(const ExplorationSummary& s) {
    const auto text = [](const char* format, double value) {
        return std::isfinite(value) ? fmt::format(fmt::runtime(format), value) : "none";
    };
    return {"Flights of " + s.planner,
            {{"arrived", fmt::format("{} of {}", s.arrived, s.flights)},
             {"collisions", fmt::format("{}", s.collisions)},
             {"position error, rms", lengthText(s.positionRmse)},
             {"NEES per degree of freedom (1: consistent), mean and median flight",
              fmt::format("{:.2f}, {:.2f}", s.nees, s.neesMedian)},
             {"true distance to the goal at the end, median", lengthText(s.goalError)},
             {"length and duration, mean", fmt::format("{:.1f} m, {:.1f} s", s.length, s.duration)},
             {"flown when the way around the obstacles was decided, mean",
              text("{:.1f} m", s.decidedAfter)},
             {"trace of the beliefs, mean and at the end",
              fmt::format("{:.3g}, {:.3g} m²", s.meanTrace, s.goalTrace)},
             {"time of an update, median", text("{:.0f} ms", 1e3 * s.updateMedian)},
             {"time of an update, 95 %", text("{:.0f} ms", 1e3 * s.update95)}}};
}

ReportTextTable tableOfUpdates(const ExplorationResult& flight) {
    ReportTextTable table{"Updates of the first flight",
                          {{"time [s]", "vertices gone", "new", "rewired", "views rendered",
                            "fusion [ms]", "clearance [ms]", "planning [ms]", "path to go [m]"},
                           {}}};
    const auto ms = [](double seconds) { return fmt::format("{:.0f}", 1e3 * seconds); };
    for (const PlanUpdate& u : flight.updates) {
        table.table.rows.push_back(
            {fmt::format("{:.2f}", u.time), fmt::format("{}", u.counts.verticesInvalidated),
             fmt::format("{}", u.counts.verticesAdded), fmt::format("{}", u.counts.verticesRewired),
             fmt::format("{}", u.viewsRendered), ms(u.fuseSeconds), ms(u.clearanceSeconds),
             ms(u.planSeconds),
             std::isfinite(u.length) ? fmt::format("{:.2f}", u.length) : "none"});
    }
    return table;
}

/// The map of a flight from above; empty if it is too large for views.
ImageF mapFromAbove(const ExplorationResult& flight, const Config& config, const TopView& view) {
    Config mapped = config;
    mapped.unknownToPlanner = UnknownPolicy::free;
    try {
        return World(flight.map, mapped)
            .pictureFromAbove(view.area, config.bounds.max().z(), kMapPixel);
    } catch (const MapTooLarge&) {
        return {};
    }
}

std::vector<NamedFigure> figuresOf(const ExplorationSetup& setup, const World& world,
                                   const ExploreOutcome& outcome) {
    const std::vector<ExplorationResult>& flights = outcome.flights;
    TopView view = viewFromAbove(setup.config, world, {});
    view.title = "The true scene, and the true positions of the flights";
    for (const ExplorationResult& flight : flights) view.trees.push_back(drawnWay(flight));
    TopView map = view;
    map.title = "The map of the first flight: believed positions and 3σ ellipses";
    map.trees = {drawnWay(flights.front())};
    map.paths = {drawnBeliefs(flights.front(), setup.config.belief.characteristicLength)};
    map.background = mapFromAbove(flights.front(), setup.config, map);
    std::vector<NamedFigure> figures{
        {"map",
         "What the first flight mapped, from above, and where it believed to be, with 3σ "
         "ellipses; the true positions beside it.",
         topViewFigure(map)},
        {"top_view", "The true scene from above, with the true positions of all flights.",
         topViewFigure(view)},
        {"trace",
         "Trace of the belief and NEES (1: consistent) over the path flown, and the time of "
         "the updates.",
         explorationFigure(flights, setup.config.belief.characteristicLength)},
        {"bands",
         "Trace of the beliefs along the normalised path: mean of the flights of a planner, and "
         "the band in which 95 % of them are.",
         traceBandsFigure(flights, setup.config.belief.characteristicLength)}};
    if (!outcome.log || outcome.log->moments.empty()) return figures;
    view.trees.clear();
    figures.push_back({"stages",
                       "The first flight in stages. Above: the true scene, the path flown and, "
                       "transparent, the plan. In the middle: what is free at the height of the "
                       "robot (white), too near to an obstacle (brown), an obstacle (black) or "
                       "not seen yet (grey). Below: the information of views with the robot's "
                       "heading.",
                       stagesFigure(*outcome.log, view)});
    figures.push_back({"plans",
                       "Plans of the first flight, dark to bright over time, and the path flown.",
                       plansFigure(*outcome.log, view)});
    return figures;
}

/// The page of a flight that is being flown, without the flight.
ReportData reportOfFlight(const ExplorationSetup& setup, const World& world,
                          const std::string& name, const std::string& commandLine) {
    ReportData report = problemReport(setup.config, world, commandLine, {{"command", "explore"}});
    report.title = name + ", being explored";
    report.mesh = {};
    report.voxels = {};
    report.fieldOfView = fieldOfView(setup.truth.camera);
    return report;
}

}  // namespace

std::string livePage(const ExplorationSetup& setup, const World& world, const std::string& name,
                     const std::string& commandLine, const FlightLog& log) {
    ReportData report = reportOfFlight(setup, world, name, commandLine);
    report.subtitle = "The first flight, while it is flown.";
    report.flight = {{"header", headerJson(log)}, {"live", true}};
    return reportPage(reportJson(report));
}

std::function<std::string(const FlightLog& soFar)> pageSoFar(const ExplorationSetup& setup,
                                                             const World& world,
                                                             const std::string& name,
                                                             const std::string& commandLine) {
    ReportData report = reportOfFlight(setup, world, name, commandLine);
    report.subtitle = "The first flight, as far as it was flown when this page was written.";
    return [report = std::move(report)](const FlightLog& soFar) mutable {
        report.flight = flightLogJson(soFar);
        report.flight["end"]["end"] = "not ended";
        return reportPage(reportJson(report));
    };
}

void writeExploreReport(const fs::path& folder, const ExplorationSetup& setup, const World& world,
                        const ExploreOutcome& outcome, const json& result) {
    const std::vector<ExplorationResult>& flights = outcome.flights;
    const Config& config = setup.config;
    const ExplorationResult& first = flights.front();
    ReportData report = problemReport(config, world, outcome.commandLine, result);
    report.title = outcome.name + ", explored";
    report.subtitle = fmt::format(
        "A flight to the goal in a scene {} to the robot: its own map, path and beliefs.",
        setup.known ? "of which a map was known" : "unknown");
    report.mesh = {};
    report.fieldOfView = fieldOfView(setup.truth.camera);
    if (outcome.log) {
        report.flight = flightLogJson(*outcome.log);
    } else {
        report.voxels = drawnVoxels(*first.map);
        report.paths.push_back(drawnBeliefs(first, config.belief.characteristicLength));
        report.trees.push_back(drawnWay(first));
    }
    for (const ExplorationSummary& s : outcome.summaries) report.tables.push_back(tableOf(s));
    if (first.realTime) {
        report.tables.push_back(
            {"Real time: what the first flight missed", realTimeRows(*first.realTime)});
    }
    report.textTables.push_back(tableOfUpdates(first));
    writeFlownTrajectory(folder, first);
    saveTexturedOcTree(*first.map, (folder / "map.ot").string());
    writeResultFolder(folder, report, figuresOf(setup, world, outcome));
}

}  // namespace photonav
