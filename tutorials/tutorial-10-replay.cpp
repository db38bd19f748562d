// SPDX-License-Identifier: BSD-3-Clause
// A recorded flight through two trackers: odometry, which only looks at the flight itself, and
// localisation in a map. How far off is each, and did it know?
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <numbers>
#include <opencv2/imgcodecs.hpp>
#include <random>
#include <set>

#include "evaluation.hpp"
#include "localizer.hpp"
#include "mesh_renderer.hpp"
#include "odometry.hpp"
#include "plot.hpp"
#include "scene_argument.hpp"
#include "sequence_tum.hpp"
#include "trajectory.hpp"

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

void writePng(const std::string& file, const ImageF& image, int type, double scale) {
    cv::Mat pixels;
    cv::Mat(static_cast<int>(image.getHeight()), static_cast<int>(image.getWidth()), CV_32FC1,
            image.bitmap)
        .convertTo(pixels, type, scale);
    if (!cv::imwrite(file, pixels)) throw std::runtime_error("cannot write " + file);
}

/// A recording in the layout of the TUM RGB-D benchmark: images, depth, true poses.
void record(const ViewSource& room, const Camera& camera, const std::string& folder) {
    std::filesystem::create_directories(folder + "/rgb");
    std::filesystem::create_directories(folder + "/depth");
    std::ofstream rgb(folder + "/rgb.txt");
    std::ofstream depth(folder + "/depth.txt");
    std::ofstream(folder + "/camera.yaml")
        << "width: " << camera.width << "\nheight: " << camera.height << "\nfx: " << camera.fx()
        << "\nfy: " << camera.fy() << "\ncx: " << camera.cx() << "\ncy: " << camera.cy() << '\n';
    Trajectory truth;
    std::mt19937_64 random(1);
    std::normal_distribution<float> noise(0.F, static_cast<float>(kNoise));
    View view;
    for (int i = 0; i < kFrames; ++i) {
        const double time = i / 15.;
        const std::string name = std::to_string(i) + ".png";
        room.render(camera, flight(i).inverse(), view);
        for (unsigned k = 0; k < view.intensity.getSize(); ++k) {
            view.intensity.bitmap[k] += noise(random);
        }
        writePng(folder + "/rgb/" + name, view.intensity, CV_8U, 255.);
        writePng(folder + "/depth/" + name, view.depth, CV_16U, 5000.);
        rgb << time << " rgb/" << name << '\n';
        depth << time << " depth/" << name << '\n';
        truth.push_back({time, flight(i)});
    }
    writeTrajectory(folder + "/groundtruth.txt", truth);
}

/// What a tracker made of the recording.
struct Result {
    std::vector<PosePair> poses;
    double nees = 0.;  ///< mean of the squared normalised errors, per degree of freedom
    int judged = 0;
    int lost = 0;
    std::set<double> keyframes;  // timestamps

    void add(const TrackedFrame& tracked, const RecordedFrame& frame, std::size_t i) {
        lost += tracked.lost ? 1 : 0;
        if (tracked.keyframe) keyframes.insert(*tracked.keyframe);
        if (tracked.lost) return;
        poses.push_back({i, frame.timestamp, tracked.T_c_w.mean.inverse(), frame.T_c_w.inverse()});
        if (const auto squared = squaredNormalisedError(tracked.T_c_w, frame.T_c_w)) {
            nees = (nees * judged + *squared / 6.) / (judged + 1);
            ++judged;
        }
    }
};

//! [odometry]
Result followByOdometry(const Sequence& flight) {
    const RecordedFrame first = loadFrame(flight, 0);
    Odometry odometry(flight.camera, {first.T_c_w, Matrix6::Zero()});
    Result result;
    for (std::size_t i = 0; i < flight.frames.size(); ++i) {
        const RecordedFrame frame = loadFrame(flight, i);
        result.add(odometry.track(frame.view, frame.timestamp), frame, i);
    }
    return result;
}
//! [odometry]

//! [localise]
Result followInMap(const Sequence& flight, const ViewSource& map) {
    LocalizerOptions options;
    options.alignment.photometric.sigma = kNoise;
    const UncertainPose start{loadFrame(flight, 0).T_c_w, 0.05 * 0.05 * Matrix6::Identity()};
    Localizer localizer(map, flight.camera, start, options);
    Result result;
    for (std::size_t i = 0; i < flight.frames.size(); ++i) {
        const RecordedFrame frame = loadFrame(flight, i);
        result.add(localizer.track(frame.view.intensity, frame.timestamp), frame, i);
    }
    return result;
}
//! [localise]

//! [judge]
void print(const char* name, const Result& result, bool align) {
    const Pose T = align ? alignmentOf(result.poses) : Pose::Identity();
    const ErrorSummary absolute = summarise(absoluteErrors(result.poses, T).translation);
    const PoseErrors second = relativeErrors(result.poses, Spacing::seconds, 1.);
    std::printf("%-10s %5zu  %4d  %9zu  %8.2f %6.2f  %8.2f %6.3f  %7.2f\n", name,
                result.poses.size(), result.lost, result.keyframes.size(), 1e3 * absolute.rmse,
                1e3 * absolute.max, 1e3 * summarise(second.translation).rmse,
                summarise(second.rotation).rmse * 180. / std::numbers::pi, result.nees);
}
//! [judge]

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
    const Plot::Points drift = errorCurve(odometry);
    double most = 1.;
    for (const auto& p : drift) most = std::max(most, p.y());
    Plot plot({Eigen::Vector2d(0., 0.), Eigen::Vector2d(kFrames / 15., 1.15 * most)},
              {110., 300. / most}, "time [s]", "distance from the truth [mm]");
    plot.curve(drift, {200, 60, 40}, 3);
    plot.curve(errorCurve(inMap), {20, 60, 200}, 3);
    plot.label("odometry", {200, 60, 40});
    plot.label("localised in the map", {20, 60, 200});
    plot.save("replay.png");
}

}  // namespace

int main(int argc, char** argv) {
    const MeshRenderer room(sceneArgument(argc, argv, "room.yaml"));
    const Camera camera = makeCamera(188, 120, 70. * std::numbers::pi / 180.);
    record(room, camera, "flight");
    const Sequence flight = readTumSequence("flight");

    const Result odometry = followByOdometry(flight);
    const Result inMap = followInMap(flight, room);
    std::puts("           found  lost  keyframes  absolute [mm]  in a second [mm, deg]  NEES / 6");
    print("odometry", odometry, true);
    print("map", inMap, false);
    draw(odometry, inMap);
    std::puts("wrote flight (also for photonav replay) and replay.png");
}
