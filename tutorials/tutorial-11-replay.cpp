// SPDX-License-Identifier: BSD-3-Clause
// A recorded flight tracked in two ways: by odometry, which uses only the flight itself, and by
// localisation in a map. How large are the errors, and are the covariances consistent?
#include <cstdio>
#include <numbers>
#include <set>

#include "exercises.hpp"
#include "flight/flight_recorder.hpp"
#include "geometry/se3.hpp"
#include "plot/figure.hpp"
#include "render/mesh_renderer.hpp"
#include "replay/replay.hpp"
#include "replay/replay_errors.hpp"
#include "scene_argument.hpp"

using namespace photonav;

namespace {

constexpr int kFrames = 120;
constexpr double kNoise = 0.01;  // of the recorded grey values

/// A round about the low table in config/scenes/room.yaml, looking at it and the carpet below.
Pose flight(int i) {
    const double angle = 2. * std::numbers::pi * i / kFrames;
    const Eigen::Vector3d p_w(2.4 + 1.2 * std::cos(angle), 6.1 + 1.2 * std::sin(angle), 1.5);
    return levelPose(p_w, angle + 0.8 * std::numbers::pi) * cameraMount(0.9);
}

/// A recording in the layout of the TUM RGB-D benchmark: images, depth, true poses.
void record(const ViewSource& room, const Camera& camera, const std::string& folder) {
    FlightRecorder recorder(folder, camera, 1., kRenderedBlur);
    const ImageNoise addNoise = assumedNoise({.sigma = kNoise});
    std::mt19937_64 random(1);
    View view;
    for (int i = 0; i < kFrames; ++i) {
        const Pose T_c_w = flight(i).inverse();
        room.render(camera, T_c_w, view);
        addNoise(view.intensity, random, {});
        recorder.add({i / 15., T_c_w, view.intensity, view.depth});
    }
    recorder.finish();
}

//! [odometry]
ReplayOptions odometry() {
    ReplayOptions options;
    options.dataset = "flight";
    options.odometry = true;  // each image relative to an earlier one, with their depth
    return options;
}
//! [odometry]

//! [localise]
ReplayOptions localisation(const std::string& map) {
    ReplayOptions options;
    options.dataset = "flight";
    options.mapFile = map;
    options.sigma = kNoise;
    options.startSigma = 0.05;  // of the first pose, per axis [m] and [rad]
    return options;
}
//! [localise]

//! [follow]
struct Result {
    ReplayRun run;
    ReplayErrors errors;
};

/// Estimates the pose of every image, and compares it with the true one.
Result follow(const ReplayOptions& options) {
    ReplayRun run = Replay(options).run();
    ReplayErrors errors = evaluate(run);
    return {std::move(run), std::move(errors)};
}
//! [follow]

//! [print]
void print(const char* name, const Result& result) {
    std::set<double> keyframes;  // their time stamps
    for (const ReplayedFrame& frame : result.run.frames) {
        if (frame.tracked.keyframe) keyframes.insert(*frame.tracked.keyframe);
    }
    double nees = 0.;
    int evaluated = 0;
    for (const EvaluatedFrame& frame : result.errors.frames) {
        if (!frame.normalised) continue;  // odometry's first image: its pose is given
        nees += frame.normalised->pose;
        ++evaluated;
    }
    const std::size_t found = result.errors.frames.size();
    const ErrorSummary absolute = summarise(result.errors.absolute.translation);
    std::printf("%-10s %5zu  %4zu  %9zu  %8.2f %6.2f  %8.2f %6.3f  %7.2f\n", name, found,
                result.run.frames.size() - found, keyframes.size(), 1e3 * absolute.rmse,
                1e3 * absolute.max, 1e3 * summarise(result.errors.perSecond.translation).rmse,
                summarise(result.errors.perSecond.rotation).rmse * 180. / std::numbers::pi,
                nees / evaluated);
}
//! [print]

/// Distance from the truth over time, millimetres.
Plot::Points errorCurve(const Result& result) {
    Plot::Points points;
    for (const EvaluatedFrame& frame : result.errors.frames) {
        points.emplace_back(frame.pair.timestamp, 1e3 * frame.positionError);
    }
    return points;
}

void draw(const Result& odometry, const Result& inMap) {
    Plot plot;
    plot.x = {.min = 0., .label = "time [s]"};
    plot.y = {.min = 0., .label = "position error [mm]"};
    plot.curve(errorCurve(odometry), {.color = {200, 60, 40}, .width = 3., .name = "odometry"});
    plot.curve(errorCurve(inMap),
               {.color = {20, 60, 200}, .width = 3., .name = "localised in the map"});
    Figure{"Errors of a replay", {{plot}}}.save("replay.png");
}

/// Length of the path that was truly flown [m].
double lengthOf(const ReplayErrors& errors) {
    double length = 0.;
    for (std::size_t i = 1; i < errors.frames.size(); ++i) {
        length += (errors.frames[i].pair.T_w_c_truth.translation() -
                   errors.frames[i - 1].pair.T_w_c_truth.translation())
                      .norm();
    }
    return length;
}

std::vector<Exercise> exercises(const ReplayErrors& odometry) {
    return {
        {[&] { return lengthOf(odometry); }},
        {[&] { return 100. * odometry.frames.back().positionError / lengthOf(odometry); }, 0.15}};
}

}  // namespace

int main(int argc, char** argv) {
    const Camera camera = makeCamera(188, 120, 70. * std::numbers::pi / 180.);
    record(MeshRenderer(sceneArgument(argc, argv, "room.yaml")), camera, "flight");

    const Result byOdometry = follow(odometry());
    if (const auto code = checkAnswers(argc, argv, exercises(byOdometry.errors))) return *code;
    const Result inMap = follow(localisation(sceneFile(argc, argv, "room.yaml")));
    std::puts("           found  lost  keyframes  absolute [mm]  in a second [mm, deg]      NEES");
    print("odometry", byOdometry);
    print("map", inMap);
    draw(byOdometry, inMap);
    std::puts("wrote flight (also for photonav replay) and replay.png");
}
