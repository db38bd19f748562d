// SPDX-License-Identifier: BSD-3-Clause
// A recorded flight tracked in two ways: by odometry, which uses only the flight itself, and by
// localisation in a map. How large are the errors, and are the covariances consistent?
#include <cstdio>
#include <numbers>
#include <set>

#include "dataset/sequence_tum.hpp"
#include "estimation/tracker.hpp"
#include "evaluation/evaluation.hpp"
#include "exercises.hpp"
#include "flight/flight_recorder.hpp"
#include "plot/figure.hpp"
#include "render/mesh_renderer.hpp"
#include "scene_argument.hpp"

using namespace photonav;

namespace {

constexpr int kFrames = 120;
constexpr double kNoise = 0.01;  // of the recorded grey values

/// A round about the low table in config/scenes/room.yaml, looking at it and the carpet below.
Pose flight(int i) {
    const double angle = 2. * std::numbers::pi * i / kFrames;
    Pose T_w_b = Pose::Identity();
    T_w_b.translation() << 2.4 + 1.2 * std::cos(angle), 6.1 + 1.2 * std::sin(angle), 1.5;
    T_w_b.rotate(Eigen::AngleAxisd(angle + 0.8 * std::numbers::pi, Eigen::Vector3d::UnitZ()));
    return T_w_b * cameraMount(0.9);
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
        addNoise(view.intensity, random);
        recorder.add({i / 15., T_c_w, view.intensity, view.depth});
    }
    recorder.finish();
}

/// Beliefs of a tracker against the true poses.
struct Result {
    std::vector<PosePair> poses;
    double nees = 0.;  ///< mean of the squared normalised errors, per degree of freedom
    int evaluated = 0;
    int lost = 0;
    std::set<double> keyframes;  // timestamps

    void add(const TrackedFrame& tracked, const RecordedFrame& frame, std::size_t i) {
        lost += tracked.rejected ? 1 : 0;
        if (tracked.keyframe) keyframes.insert(*tracked.keyframe);
        if (tracked.rejected) return;
        poses.push_back({i, frame.timestamp, tracked.T_c_w.mean.inverse(), frame.T_c_w.inverse()});
        if (const auto squared = squaredNormalisedError(tracked.T_c_w, frame.T_c_w)) {
            nees = (nees * evaluated + *squared / 6.) / (evaluated + 1);
            ++evaluated;
        }
    }
};

//! [follow]
Result follow(const Sequence& flight, Tracker tracker) {
    Result result;
    for (std::size_t i = 0; i < flight.frames.size(); ++i) {
        const RecordedFrame frame = loadFrame(flight, i);
        result.add(tracker.track(frame.view, frame.timestamp), frame, i);
    }
    return result;
}
//! [follow]

//! [odometry]
Tracker odometry(const Sequence& flight) {
    TrackerOptions options;
    options.keyframes.emplace();  // earlier images, with their depth
    const UncertainPose start{loadFrame(flight, 0).T_c_w, Matrix6::Zero()};
    return {nullptr, flight.camera, start, options};
}
//! [odometry]

//! [localise]
Tracker localiser(const Sequence& flight, std::shared_ptr<const ViewSource> map) {
    TrackerOptions options;
    options.map.photometric.sigma = kNoise;
    const UncertainPose start{loadFrame(flight, 0).T_c_w, 0.05 * 0.05 * Matrix6::Identity()};
    return {std::move(map), flight.camera, start, options};
}
//! [localise]

//! [print]
void print(const char* name, const Result& result, bool align) {
    const Pose T = align ? alignmentOf(result.poses) : Pose::Identity();
    const ErrorSummary absolute = summarise(absoluteErrors(result.poses, T).translation);
    const PoseErrors second = relativeErrors(result.poses, Spacing::seconds, 1.);
    std::printf("%-10s %5zu  %4d  %9zu  %8.2f %6.2f  %8.2f %6.3f  %7.2f\n", name,
                result.poses.size(), result.lost, result.keyframes.size(), 1e3 * absolute.rmse,
                1e3 * absolute.max, 1e3 * summarise(second.translation).rmse,
                summarise(second.rotation).rmse * 180. / std::numbers::pi, result.nees);
}
//! [print]

/// Distance from the truth over time, millimetres.
Plot::Points errorCurve(const Result& result) {
    Plot::Points points;
    const PoseErrors errors = absoluteErrors(result.poses);
    for (std::size_t i = 0; i < result.poses.size(); ++i) {
        points.emplace_back(result.poses[i].timestamp, 1e3 * errors.translation[i]);
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

/// Length of the way truly flown [m].
double wayOf(const Result& result) {
    double way = 0.;
    for (std::size_t i = 1; i < result.poses.size(); ++i) {
        way += (result.poses[i].T_w_c_truth.translation() -
                result.poses[i - 1].T_w_c_truth.translation())
                   .norm();
    }
    return way;
}

std::vector<Exercise> exercises(const Result& odometry) {
    return {
        {[&] { return wayOf(odometry); }},
        {[&] { return 100. * absoluteErrors(odometry.poses).translation.back() / wayOf(odometry); },
         0.15}};
}

}  // namespace

int main(int argc, char** argv) {
    const auto room = std::make_shared<MeshRenderer>(sceneArgument(argc, argv, "room.yaml"));
    const Camera camera = makeCamera(188, 120, 70. * std::numbers::pi / 180.);
    record(*room, camera, "flight");
    const Sequence flight = readTumSequence("flight");

    const Result byOdometry = follow(flight, odometry(flight));
    if (const auto code = checkAnswers(argc, argv, exercises(byOdometry))) return *code;
    const Result inMap = follow(flight, localiser(flight, room));
    std::puts("           found  lost  keyframes  absolute [mm]  in a second [mm, deg]  NEES / 6");
    print("odometry", byOdometry, true);
    print("map", inMap, false);
    draw(byOdometry, inMap);
    std::puts("wrote flight (also for photonav replay) and replay.png");
}
