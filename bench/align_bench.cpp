// SPDX-License-Identifier: BSD-3-Clause
// Alignment, one thread. With a TUM folder (argument, or PHOTONAV_DATA/rgbd_office): pairs of
// 640x480 RGB-D images five frames apart by KeyframeModel and by OpenCV's RgbdOdometry, errors
// against the recorded poses. Always: tracking of 188x120 images in a mesh and in a textured octree
// of 5 cm, starting from odometry.
#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <numbers>
#include <opencv2/core.hpp>
#include <opencv2/rgbd/depth.hpp>
#include <random>

#include "alignment/dense_aligner.hpp"
#include "alignment/keyframe_model.hpp"
#include "bench_arguments.hpp"
#include "dataset/sequence_tum.hpp"
#include "estimation/calibration.hpp"
#include "geometry/se3.hpp"
#include "image_noise.hpp"
#include "map/map_fusion.hpp"
#include "problem/tracking_map.hpp"
#include "render/mesh_renderer.hpp"
#include "render/voxel_renderer.hpp"
#include "statistics.hpp"
#include "thread_time.hpp"
#include "tracking_scenes.hpp"

using namespace photonav;

namespace {

/// Errors and times of one method over many alignments.
struct Score {
    std::vector<double> millimetres, degrees, time;
    int failed = 0;

    void add(const Pose& estimate, const Pose& truth, double ms) {
        const Pose error = truth * estimate.inverse();
        millimetres.push_back(1e3 * error.translation().norm());
        degrees.push_back(Eigen::AngleAxisd(error.linear()).angle() * 180. / std::numbers::pi);
        time.push_back(ms);
    }

    void print(const std::string& name) const {
        fmt::print(
            "  {:<32} {:6.2f} {:6.2f} mm   {:5.3f} {:5.3f} deg   {:6.2f} {:6.2f} ms   {} lost\n",
            name, quantile(millimetres, 0.5), quantile(millimetres, 0.9), quantile(degrees, 0.5),
            quantile(degrees, 0.9), quantile(time, 0.5), quantile(time, 0.9), failed);
    }
};

// --- RGB-D pairs --------------------------------------------------------------------------------

cv::Mat bytes(const ImageF& image) {
    cv::Mat result;
    cv::Mat(int(image.getHeight()), int(image.getWidth()), CV_32FC1, image.bitmap)
        .convertTo(result, CV_8U, 255.);
    return result;
}

cv::Mat metres(const ImageF& depth) {
    return cv::Mat(int(depth.getHeight()), int(depth.getWidth()), CV_32FC1, depth.bitmap).clone();
}

/// T_second_first by OpenCV, all its own preparation included.
void opencvOdometry(cv::rgbd::RgbdOdometry& odometry, const View& first, const View& second,
                    Score& score, const Pose& truth) {
    const cv::Mat grey1 = bytes(first.intensity), grey2 = bytes(second.intensity);
    const cv::Mat depth1 = metres(first.depth), depth2 = metres(second.depth);
    cv::Mat Rt;
    bool good = false;
    const double ms = milliseconds(
        [&] { good = odometry.compute(grey1, depth1, cv::Mat(), grey2, depth2, cv::Mat(), Rt); });
    Pose T = Pose::Identity();
    if (good) {
        for (int i = 0; i < 3; ++i) {
            for (int j = 0; j < 4; ++j) T(i, j) = Rt.at<double>(i, j);
        }
    } else {
        ++score.failed;
    }
    score.add(T, truth, ms);
}

struct Method {
    std::string name;
    KeyframeOptions options;
    Score score;
    double nees = 0.;  ///< sum, per degree of freedom
};

/// @param depthError relative, of the scale and registration of depth
std::vector<Method> keyframeMethods(double depthError) {
    std::vector<Method> methods;
    for (const int finest : {0, 1, 2}) {
        KeyframeOptions options;
        options.finest = finest;
        if (finest == 0) options.minGradient = 0.02;
        options.alignment.levels = 4 - finest;
        options.alignment.modelErrors.depthScale = depthError;
        const char* size = finest == 0 ? "640x480" : finest == 1 ? "320x240" : "160x120";
        methods.push_back({fmt::format("keyframe, {}", size), options, {}});
    }
    return methods;
}

/// Error of depth that nothing is known about, as replays assume.
constexpr double kUnregistered = 0.1;

void compareOnPairs(const std::string& folder, std::size_t step) {
    TumOptions tum;
    const auto unregistered = std::filesystem::path(PHOTONAV_SOURCE_DIR) / "config" / "cameras" /
                              "kinect_unregistered.yaml";
    if (folder.find("rgbd_office") != std::string::npos) tum.cameraFile = unregistered.string();
    const Sequence sequence = readTumSequence(folder, tum);
    const cv::Mat K = (cv::Mat_<double>(3, 3) << sequence.camera.fx(), 0., sequence.camera.cx(), 0.,
                       sequence.camera.fy(), sequence.camera.cy(), 0., 0., 1.);
    const auto peer = cv::rgbd::RgbdOdometry::create(K);
    std::vector<Method> methods = keyframeMethods(sequence.depthError.value_or(kUnregistered));
    Score opencv, still;
    RecordedFrame first = loadFrame(sequence, 0);
    for (std::size_t i = step; i < sequence.frames.size(); i += step) {
        const RecordedFrame second = loadFrame(sequence, i);
        const Pose truth = second.T_c_w * first.T_c_w.inverse();
        still.add(Pose::Identity(), truth, 0.);
        opencvOdometry(*peer, first.view, second.view, opencv, truth);
        for (Method& method : methods) {
            Alignment a;
            const double ms = milliseconds([&] {
                KeyframeModel keyframe(first.view, sequence.camera, Pose::Identity(),
                                       method.options);
                a = keyframe.align(second.view.intensity, Pose::Identity());
            });
            method.score.failed += isLost(a.verdict) ? 1 : 0;
            method.score.add(a.T_c_w, truth, ms);
            const Vector6 xi = logSE3(truth * a.T_c_w.inverse());
            method.nees += xi.dot(a.covariance.ldlt().solve(xi)) / 6.;
        }
        first = second;
    }
    fmt::print("pairs {} frames apart of {}: median and p90 of {} pairs\n", step, folder,
               still.time.size());
    still.print("no motion assumed");
    opencv.print("OpenCV RgbdOdometry");
    for (const Method& method : methods) {
        method.score.print(method.name);
        fmt::print("  {:<28} {:.1f}x faster than RgbdOdometry, NEES {:.2f}\n", "",
                   quantile(opencv.time, 0.5) / quantile(method.score.time, 0.5),
                   method.nees / double(still.time.size()));
    }
}

// --- Images in a map ----------------------------------------------------------------------------

std::vector<Pose> circle(double belowHorizon, int count) {
    std::vector<Pose> poses;
    for (int i = 0; i < count; ++i) {
        poses.push_back(onCircle(2. * std::numbers::pi * i / count, belowHorizon));
    }
    return poses;
}

TexturedOcTree mapOf(const MeshRenderer& mesh) {
    TexturedOcTree map(0.05);
    const Camera camera = makeCamera(640, 480, 70. * std::numbers::pi / 180.);
    View view;
    for (const double belowHorizon : {0.2, 0.8, 1.5}) {
        for (const Pose& T_c_w : circle(belowHorizon, 40)) {
            mesh.render(camera, T_c_w, view);
            fuse(map, view, camera, T_c_w);
        }
    }
    return map;
}

/// Images of the mesh, tracked in `model` from starts 2 cm and 1 degree off (standard deviations
/// per axis, the prior's).
void track(const std::string& name, const MeshRenderer& world, const ViewSource& model,
           const AlignmentOptions& options, double belowHorizon, unsigned width = 188) {
    const Camera camera = trackingCamera(width);
    DenseAligner aligner(model, camera, options);
    std::mt19937_64 random(1);
    Vector6 sigmas;
    sigmas << Eigen::Vector3d::Constant(0.02), Eigen::Vector3d::Constant(0.017);
    Score score;
    double iterations = 0.;
    const auto poses = circle(belowHorizon, 100);
    for (const Pose& truth : poses) {
        View view;
        world.render(camera, truth, view);
        const ImageF image = independentNoise(view.intensity, random);
        const UncertainPose prior{expSE3(randomTwist(sigmas, random)) * truth,
                                  sigmas.cwiseAbs2().asDiagonal()};
        Alignment a;
        const double ms = milliseconds([&] { a = aligner.align(image, prior); });
        score.add(a.T_c_w, truth, ms);
        score.failed += isLost(a.verdict) ? 1 : 0;
        iterations += a.iterations / double(poses.size());
    }
    score.print(name);
    fmt::print("  {:<32} {:.0f} Hz (p90 {:.0f} Hz), {:.1f} comparisons an image\n", "",
               1e3 / quantile(score.time, 0.5), 1e3 / quantile(score.time, 0.9), iterations);
}

/// With covariances from the residuals, as in flights and replays, and from an assumed noise.
void trackInMaps() {
    const MeshRenderer mesh(furnishedHall());
    const TexturedOcTree map = mapOf(mesh);
    const VoxelRenderer voxels(map, UnknownPolicy::occupied);
    const AlignmentOptions assumed, inMesh = photographOptions(kRenderedBlur);
    AlignmentOptions replayed = inMesh;
    replayed.cellSize = map.getResolution();
    replayed.modelErrors.surface = surfaceError(MapKind::surfaces, replayed.cellSize);
    replayed.modelNoise = ModelNoise::inCovariance;
    AlignmentOptions flown = replayed;
    flown.modelNoise = ModelNoise::inPose;
    fmt::print("188x120 images in a map, starts 2 cm and 1 degree off: median and p90 of 100\n");
    for (const auto& [name, angle] : {std::pair{"45 degrees", 0.25}, {"down", 0.5}}) {
        const double below = angle * std::numbers::pi;
        track(fmt::format("mesh, {}", name), mesh, mesh, inMesh, below);
        track(fmt::format("mesh, {}, 376x240", name), mesh, mesh, inMesh, below, 376);
        track(fmt::format("mesh, {}, noise assumed", name), mesh, mesh, assumed, below);
        track(fmt::format("cells, {}, as replays", name), mesh, voxels, replayed, below);
        track(fmt::format("cells, {}, as flights", name), mesh, voxels, flown, below);
    }
}

}  // namespace

int main(int argc, char** argv) {
    const BenchArguments arguments(argc, argv, "align_bench [TUM_FOLDER]");
    cv::setNumThreads(1);
    const char* data = std::getenv("PHOTONAV_DATA");
    const std::string folder =
        arguments.text(1, data ? std::string(data) + "/rgbd_office" : std::string());
    trackInMaps();
    if (folder.empty()) return 0;
    compareOnPairs(folder, 1);
    compareOnPairs(folder, 5);
}
