// SPDX-License-Identifier: BSD-3-Clause
#include "plans/check_command.hpp"

#include <fmt/format.h>

#include "check/obstruction.hpp"
#include "flight/flight_setup.hpp"
#include "geometry/constants.hpp"
#include "io/error.hpp"
#include "io/interrupted.hpp"
#include "io/number.hpp"
#include "io/stopwatch.hpp"
#include "map/octree_file.hpp"
#include "plans/check_report.hpp"
#include "result/json_values.hpp"
#include "shared/result_folder.hpp"

namespace photonav {
namespace {

namespace fs = std::filesystem;

constexpr double kMargin = 1.;              // of bounds around a trajectory [m]
constexpr double kMostSteps = 1e6;          // of a trajectory
constexpr double kMostTilt = 5. * kDegree;  // of a body that the simulated robot can follow

GivenHeading headingOf(const std::string& text) {
    if (text == "forward") return {};
    const auto heading = numberIn(text);
    if (heading && std::abs(*heading) <= 1e3) return heading;
    throw InputError("--heading", text, "expected forward or an angle in radians");
}

/// A planning problem from the first to the last pose.
std::string configAround(const GivenTrajectory& trajectory) {
    Eigen::AlignedBox3d box = boxAround(trajectory);
    box.min().array() -= kMargin;
    box.max().array() += kMargin;
    const auto list = [](const Eigen::Vector3d& p) {
        return fmt::format("[{}, {}, {}]", p.x(), p.y(), p.z());
    };
    return fmt::format("bounds: [{}, {}]\nstart: {}\ngoal: {}\nspace: xyz_yaw\n", list(box.min()),
                       list(box.max()), list(trajectory.poses.front().T_w_b.translation()),
                       list(trajectory.poses.back().T_w_b.translation()));
}

/// The world that was named replaces that of the config.
std::vector<std::string> overridesOf(const CheckCommandOptions& options) {
    std::vector<std::string> overrides = options.overrides;
    if (!options.map.empty()) {
        overrides.insert(overrides.begin(), {"scene.file=", "map.file=" + options.map});
    }
    if (!options.scene.empty()) {
        overrides.insert(overrides.begin(), {"map.file=", "scene.file=" + options.scene});
    }
    return overrides;
}

Config configOf(const CheckCommandOptions& options) {
    if (!options.map.empty() && !isOcTreeFile(options.map)) {
        throw InputError("--map", options.map, "not an OctoMap (.ot); meshes are scenes");
    }
    if (!options.config.empty()) return loadConfig(options.config, overridesOf(options));
    if (options.map.empty() && options.scene.empty()) {
        throw InputError(options.trajectory, "", "needs a world: give --map, --scene or --config");
    }
    const GivenTrajectory trajectory = readGivenTrajectory(options.trajectory, Pose::Identity());
    return parseConfig(configAround(trajectory), options.trajectory, overridesOf(options));
}

/// @throws InputError naming --map or --scene where the world that it names cannot be used
World worldOf(const CheckCommandOptions& options, const Config& config) {
    const auto isMissing = [](const std::string& file) {
        return !file.empty() && !fs::exists(file);
    };
    if (isMissing(options.map)) throw InputError("--map", options.map, "no such file");
    if (isMissing(options.scene)) throw InputError("--scene", options.scene, "no such file");
    World world(config);
    if (world.hasTexture()) return world;
    throw InputError(options.map.empty() ? config.file : "--map", config.mapFile,
                     "no cell of the map has a grey value to compare images with; give a textured "
                     "map (.ot)");
}

/// Angle of the body's vertical axis to that of the world, at most along the trajectory.
double tiltOf(const GivenTrajectory& trajectory) {
    double tilt = 0.;
    for (const GivenPose& pose : trajectory.poses) {
        tilt = std::max(tilt, std::acos(std::clamp(pose.T_w_b(2, 2), -1., 1.)));
    }
    return tilt;
}

void checkTilt(const CheckCommandOptions& options, double tilt) {
    if (options.flights == 0 || tilt <= kMostTilt) return;
    throw InputError("--flights", "",
                     fmt::format("the body of the trajectory is tilted by up to {:.0f} degrees, "
                                 "the simulated robot is level",
                                 tilt / kDegree));
}

/// The places as a flight passes them; only the ends are stopped at.
std::vector<PlannedView> planOf(const CheckedTrajectory& checked) {
    std::vector<PlannedView> plan;
    for (const CheckedPlace& place : checked.places) {
        plan.push_back({place.T_w_b, place.covariance, place.length, false});
    }
    plan.front().isWaypoint = plan.back().isWaypoint = true;
    return plan;
}

FlightSet flightsAlong(const CheckOutcome& report, const CheckCommandOptions& options,
                       ProgressLine& line, const std::atomic<bool>& interrupted) {
    FlightSet set{report.path, planOf(report.checked), {}};
    if (options.flights == 0 || interrupted) return set;
    const PlanningProblem problem(report.config, report.world);
    const FlightSetup setup = setUpFlight(problem);
    std::size_t flown = 0;
    line.beginPhase();
    set.flights = flyMany(set.plan, setup.world, setup.options, options.flights, options.jobs,
                          interrupted, [&](const FlightResult&) {
                              ++flown;
                              line.show(fmt::format("{} of {} flights", flown, options.flights),
                                        static_cast<double>(flown) / options.flights);
                          });
    return set;
}

/// Every place is kept, with its covariance.
void checkSteps(const CheckCommandOptions& options, const GivenTrajectory& trajectory,
                const Config& config) {
    const double steps = stepsOf(trajectory, config);
    if (steps <= kMostSteps) return;
    throw InputError(options.trajectory, "",
                     fmt::format("{:.3g} steps of planner.ds = {} m; at most {}", steps,
                                 config.belief.ds, kMostSteps));
}

FolderTransaction folderFor(const CheckCommandOptions& options, const Config& config) {
    const fs::path folder =
        options.out.empty()
            ? fs::path("out") / ("check-" + fs::path(options.trajectory).stem().string())
            : options.out;
    return beginResult(folder, inputsOf(config, {options.trajectory, options.config}));
}

}  // namespace

int runCheck(const CheckCommandOptions& options, const std::atomic<bool>& interrupted) {
    const Stopwatch watch;
    const GivenHeading heading = headingOf(options.heading);
    const Config config = configOf(options);
    const GivenTrajectory trajectory =
        readGivenTrajectory(options.trajectory, config.camera.T_b_c(), heading);
    CheckOutcome report{.config = config,
                        .world = worldOf(options, config),
                        .trajectory = trajectory,
                        .file = options.trajectory,
                        .tilt = tiltOf(trajectory)};
    checkTilt(options, report.tilt);
    checkSteps(options, trajectory, config);
    FolderTransaction folder = folderFor(options, config);

    {
        ProgressLine line(options.quiet);
        report.obstruction = obstructionOf(trajectory, config, report.world, interrupted);
        line.beginPhase();
        report.checked = checkLocalisation(
            trajectory, config, report.world, options.check, interrupted,
            [&](double share) { line.show(fmt::format("{:.1f} % checked", 100. * share), share); });
        report.path = pathOf(report.checked, "trajectory");
        if (options.check.headings > 0 && !interrupted) {
            CheckOptions same = options.check;
            same.headings = 0;
            line.beginPhase();
            try {
                report.turned = checkLocalisation(
                    withBestHeadings(report.checked), config, report.world, same, interrupted,
                    [&](double share) {
                        line.show(fmt::format("best headings: {:.1f} % checked", 100. * share),
                                  share);
                    });
            } catch (const Interrupted&) {  // before its first place
            }
        }
        report.flights = flightsAlong(report, options, line, interrupted);
    }
    report.interrupted = interrupted;
    nlohmann::json result = checkResult(report);
    result["time"]["total_s"] = watch.seconds();
    writeCheckReport(folder.path(), report, options.commandLine, result);
    concludeResult(folder, options, result, [&] { printTable(summaryOf(report)); });
    if (report.interrupted) return kInterrupted;
    return report.checked.isLost() ? kNoAnswer : kDone;
}

}  // namespace photonav
