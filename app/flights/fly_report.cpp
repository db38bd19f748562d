// SPDX-License-Identifier: BSD-3-Clause
#include "flights/fly_report.hpp"

#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <cmath>

#include "dataset/belief_trajectory.hpp"
#include "figures/fly_figures.hpp"
#include "report/problem_report.hpp"
#include "result/json_values.hpp"

namespace photonav {
namespace fs = std::filesystem;
using nlohmann::json;
namespace {

ReportTable tableOf(const FlightSet& set) {
    const FlightSummary s = summarise(set);
    ReportTable table{"Flights of " + set.path.planner, {}};
    if (s.flights == 0) {
        table.rows = {{"flights", "none"}};
        return table;
    }
    table.rows = {
        {"arrived", fmt::format("{} of {}", s.arrived, s.flights)},
        {"wrong arrivals (estimate at the goal, robot elsewhere)", fmt::format("{}", s.astray)},
        {"uncertain arrivals (estimate at the goal, not certain enough)",
         fmt::format("{}", s.uncertain)},
        {"collisions", fmt::format("{}", s.collisions)},
        {"gave up lost / out of time", fmt::format("{} / {}", s.lost, s.outOfTime)},
        {"position error, rms", lengthText(s.positionRmse)},
        {"standard deviation of the position predicted by the plan", lengthText(s.predictedSigma)},
        {"errors within 3 predicted standard deviations",
         fmt::format("{:.1f} %", 100. * s.within3Sigma)},
        {"standard deviation estimated in flight", lengthText(s.believedSigma)},
        {"NEES per degree of freedom (1: consistent), mean and median flight",
         fmt::format("{:.2f}, {:.2f}", s.nees, s.neesMedian)},
        {"NEES per degree of freedom at the goal (95 % interval if consistent)",
         fmt::format("{:.2f} ({:.2f} to {:.2f})", s.neesAtGoal, s.neesLow, s.neesHigh)},
        {"true distance to the goal at the end, median", lengthText(s.goalError)},
        {"time without tracking, all flights", fmt::format("{:.1f} s", s.lostTime)},
        {"duration, mean", fmt::format("{:.1f} s", s.duration)},
        {"mean speed until the goal is reached", fmt::format("{:.2f} m/s", s.meanSpeed)}};
    if (s.photometric > 0) {
        table.rows.emplace_back(
            "servoing on the image of the goal",
            fmt::format("{} flights, {} to {}", s.photometric, lengthText(s.photometricBefore),
                        lengthText(s.photometricAfter)));
    }
    return table;
}

Figure topView(const Config& config, const World& world, const std::vector<FlightSet>& sets,
               const std::vector<DrawnPath>& paths) {
    TopView view = viewFromAbove(config, world, paths);
    view.title = "Plans and true positions of the flights";
    for (std::size_t k = 0; k < sets.size(); ++k) {
        if (!sets[k].flights.empty()) view.trees.push_back(drawnFlights(sets[k]));
    }
    return topViewFigure(view);
}

std::vector<NamedFigure> figuresOf(const Config& config, const World& world,
                                   const std::vector<FlightSet>& sets,
                                   const std::vector<DrawnPath>& paths) {
    std::vector<NamedFigure> figures;
    if (!sets.empty()) {
        figures.push_back(
            {"errors",
             "Error of the estimated position at each image, and the standard deviation "
             "that the plan predicted.",
             errorBandsFigure(sets)});
    }
    figures.push_back({"top_view",
                       "From above: plans with the predicted 3σ ellipses, and the true positions "
                       "of the flights.",
                       topView(config, world, sets, paths)});
    if (!sets.empty()) {
        figures.push_back(
            {"nees",
             "Mean NEES along the plan: 1 if the covariances are consistent with the errors.",
             neesFigure(sets)});
    }
    return figures;
}

std::string subtitleOf(const FlyConfig& fly) {
    std::string text = "Closed-loop flights along plans";
    if (fly.camera == "real") text += " with the image noise of a real camera";
    if (!fly.map.empty()) text += ", tracking in the map " + fs::path(fly.map).filename().string();
    return text + ": predicted and actual errors.";
}

/// Named after the config, or after the result folder of the plan.
std::string titleOf(const Config& config) {
    const fs::path plan = config.fly.plan;
    const fs::path name =
        plan.empty() ? fs::path(config.file).stem() : plan.parent_path().filename();
    return name.string() + ", flown";
}

}  // namespace

void writeFlyReport(const fs::path& folder, const Config& config, const World& world,
                    const std::vector<FlightSet>& sets, std::vector<ReportFrame> frames,
                    const std::string& commandLine, const json& result) {
    ReportData report = problemReport(config, world, commandLine, result);
    report.frames = std::move(frames);
    report.title = titleOf(config);
    report.subtitle = subtitleOf(config.fly);
    for (std::size_t k = 0; k < sets.size(); ++k) {
        report.paths.push_back(drawnPath(sets[k].path, config.camera.T_b_c()));
        report.trees.push_back(drawnFlights(sets[k]));
        report.tables.push_back(tableOf(sets[k]));
    }
    if (!sets.empty() && !sets[0].flights.empty() && sets[0].flights[0].number == 0) {
        writeFlownTrajectory(folder, sets[0].flights[0]);
    }
    writeResultFolder(folder, report, figuresOf(config, world, sets, report.paths));
}

}  // namespace photonav
