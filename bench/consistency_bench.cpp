// SPDX-License-Identifier: BSD-3-Clause
// Are predicted covariances consistent? NEES per degree of freedom of simulated alignments and
// flights, with independent noise and with the noise of a real camera, before and after
// calibration. The numbers of docs/experiments/tracking.md.
#include <fmt/format.h>

#include <cstdlib>
#include <numbers>
#include <random>

#include "alignment/keyframe_model.hpp"
#include "bench_arguments.hpp"
#include "estimation/calibration.hpp"
#include "estimation/tracker.hpp"
#include "geometry/se3.hpp"
#include "image_noise.hpp"
#include "map/map_fusion.hpp"
#include "render/mesh_renderer.hpp"
#include "render/voxel_renderer.hpp"
#include "simulation/camera_noise.hpp"
#include "tracking_scenes.hpp"

using namespace photonav;

namespace {

using Random = std::mt19937_64;
using Picture = std::function<ImageF(const ImageF&, Random&)>;

/// Exposure changes from image to image.
Picture realCamera(double vignetting) {
    return [vignetting](const ImageF& ideal, Random& random) {
        std::uniform_real_distribution<double> gain(0.8, 1.2);
        CameraNoiseOptions options;
        options.vignetting = vignetting;
        options.exposure.gain = gain(random);
        return takePicture(ideal, options, random);
    };
}

Vector6 startSigmas() {
    Vector6 s;
    s << Eigen::Vector3d::Constant(0.02), Eigen::Vector3d::Constant(0.01);
    return s;
}

Pose randomPose(Random& random) {
    std::uniform_real_distribution<double> around(0., 2. * std::numbers::pi);
    std::uniform_real_distribution<double> below(0.5, 1.5);
    return onCircle(around(random), below(random));
}

std::vector<AlignmentError> errorsOf(const ViewSource& world, const ViewSource& model,
                                     const AlignmentOptions& options, const Picture& picture,
                                     int count, int& lost) {
    const Camera camera = trackingCamera();
    DenseAligner aligner(model, camera, options);
    std::vector<AlignmentError> errors;
    Random random(1);
    View view;
    while (static_cast<int>(errors.size()) < count) {
        const Pose truth = randomPose(random);
        world.render(camera, truth, view);
        const ImageF image = picture(view.intensity, random);
        const Alignment a =
            aligner.align(image, expSE3(randomTwist(startSigmas(), random)) * truth);
        if (isLost(a.verdict) && ++lost < count) continue;
        errors.push_back({logSE3(truth * a.T_c_w.inverse()), a.information});
    }
    return errors;
}

void printRow(const std::string& name, const std::vector<AlignmentError>& errors, int lost) {
    double metres = 0., radians = 0.;
    for (const AlignmentError& e : errors) {
        metres += e.xi.head<3>().squaredNorm() / double(errors.size());
        radians += e.xi.tail<3>().squaredNorm() / double(errors.size());
    }
    const Calibration c = calibrate(errors);
    fmt::print(
        "{:<44} {:7.2f} mm {:6.3f} deg  NEES {:8.2f}  -> scale {:7.3g}, least sigma {:5.2f} mm "
        "{:5.3f} deg: {:5.2f}   {} lost\n",
        name, 1e3 * std::sqrt(metres), std::sqrt(radians) * 180. / std::numbers::pi, c.neesBefore,
        c.scale, 1e3 * c.leastSigma, c.leastSigmaRotation * 180. / std::numbers::pi, c.neesAfter,
        lost);
    std::fflush(stdout);
}

void row(const std::string& name, const ViewSource& world, const ViewSource& model,
         const AlignmentOptions& options, const Picture& picture, int count) {
    int lost = 0;
    printRow(name, errorsOf(world, model, options, picture, count, lost), lost);
}

/// A map from images with noisy depth.
TexturedOcTree mapOf(const MeshRenderer& world, double resolution) {
    TexturedOcTree map(resolution);
    const Camera camera = makeCamera(376, 240, 70. * std::numbers::pi / 180.);
    Random random(3);
    View view;
    for (const double below : {0.2, 0.6, 1.0, 1.5}) {
        for (int i = 0; i < 40; ++i) {
            const Pose T_c_w = onCircle(2. * std::numbers::pi * i / 40, below);
            world.render(camera, T_c_w, view);
            addDepthNoise(view.depth, {}, random);
            fuse(map, view, camera, T_c_w);
        }
    }
    return map;
}

void keyframeRow(const std::string& name, const ViewSource& world, int finest, int count) {
    const Camera camera = makeCamera(376, 240, 70. * std::numbers::pi / 180.);
    KeyframeOptions options;
    options.finest = finest;
    std::vector<AlignmentError> errors;
    Random random(5);
    View first, second;
    int lost = 0;
    while (static_cast<int>(errors.size()) < count) {
        const Pose T_k_w = randomPose(random);
        const Pose truth = expSE3(randomTwist(startSigmas(), random)) * T_k_w;
        world.render(camera, T_k_w, first);
        world.render(camera, truth, second);
        first.intensity = independentNoise(first.intensity, random);
        KeyframeModel keyframe(first, camera, T_k_w, options);
        const Alignment a = keyframe.align(independentNoise(second.intensity, random), T_k_w);
        if (isLost(a.verdict) && ++lost < count) continue;
        errors.push_back({logSE3(truth * a.T_c_w.inverse()), a.information});
    }
    printRow(name, errors, lost);
}

/// Flights of ten images with odometry between: NEES of the filter at the end.
void flights(const std::string& name, const ViewSource& world, const ViewSource& model,
             const AlignmentOptions& options, const Picture& picture, int count) {
    const Camera camera = trackingCamera();
    Vector6 sigmas;
    sigmas << Eigen::Vector3d::Constant(0.01), Eigen::Vector3d::Constant(0.005);
    const Matrix6 Q = sigmas.cwiseAbs2().asDiagonal();
    Random random(7);
    View view;
    double sum = 0., metres = 0., radians = 0.;
    int lost = 0, images = 0;
    for (int flight = 0; flight < count; ++flight) {
        const double begin = 0.1 * flight;
        Pose truth = onCircle(begin, 0.9);
        Tracker tracker({std::shared_ptr<void>(), &model}, camera,
                        {expSE3(randomTwist(sigmas, random)) * truth, Q}, {.map = options});
        for (int i = 1; i <= 10; ++i, ++images) {
            const Pose next = onCircle(begin + 0.03 * i, 0.9);
            const Pose T_next_now = next * truth.inverse();
            truth = next;
            Observation observation;
            observation.time = i;
            observation.T_next_now =
                UncertainPose{expSE3(randomTwist(sigmas, random)) * T_next_now, Q};
            world.render(camera, truth, view);
            observation.frames.push_back({observation.time, {picture(view.intensity, random), {}}});
            lost += tracker.update(observation).front().rejected ? 1 : 0;
        }
        const Vector6 xi = logSE3(truth * tracker.beliefAtLastImage().mean.inverse());
        sum += xi.dot(tracker.beliefAtLastImage().covariance.ldlt().solve(xi)) / 6.;
        metres += xi.head<3>().squaredNorm() / count;
        radians += xi.tail<3>().squaredNorm() / count;
    }
    const double sigma = std::sqrt(2. / (6. * count));
    fmt::print(
        "{:<44} {:7.2f} mm {:6.3f} deg  NEES {:8.3f}, 95 % of chi-square: [{:.3f}, {:.3f}]; "
        "{} of {} images lost\n",
        name, 1e3 * std::sqrt(metres), std::sqrt(radians) * 180. / std::numbers::pi, sum / count,
        1. - 1.96 * sigma, 1. + 1.96 * sigma, lost, images);
    std::fflush(stdout);
}

}  // namespace

int main(int argc, char** argv) {
    const BenchArguments arguments(argc, argv, "consistency_bench [ALIGNMENTS_PER_ROW=300]");
    const int count = arguments.number(1, 300, 20);
    const MeshRenderer room(furnishedHall()), floor(texturedFloor());
    const AlignmentOptions ideal;
    AlignmentOptions exposed;
    exposed.exposure = ExposurePrior{};
    const double sigma = std::sqrt(2. / (6. * count));
    fmt::print(
        "{} alignments a row; NEES per degree of freedom, 95 % of chi-square: [{:.3f}, "
        "{:.3f}]\n",
        count, 1. - 1.96 * sigma, 1. + 1.96 * sigma);
    AlignmentOptions huber;
    huber.robust = RobustWeight::huber;
    AlignmentOptions exposedHuber = exposed;
    exposedHuber.robust = RobustWeight::huber;
    row("floor, independent noise", floor, floor, ideal, independentNoise, count);
    row("room, independent noise", room, room, ideal, independentNoise, count);
    row("floor, independent noise, huber", floor, floor, huber, independentNoise, count);
    row("room, independent noise, huber", room, room, huber, independentNoise, count);
    for (const double vignetting : {0., 0.03, 0.15}) {
        const Picture picture = realCamera(vignetting);
        const std::string lens = fmt::format("real camera, vignetting {}", vignetting);
        row("floor, " + lens, floor, floor, exposed, picture, count);
        row("room, " + lens, room, room, exposed, picture, count);
        row("room, huber, " + lens, room, room, exposedHuber, picture, count);
    }
    const Picture picture = realCamera(CameraNoiseOptions{}.vignetting);
    for (const double resolution : {0.05, 0.025}) {
        const TexturedOcTree map = mapOf(room, resolution);
        const VoxelRenderer voxels(map, UnknownPolicy::occupied);
        row(fmt::format("room, real camera, map of {} m", resolution), room, voxels, exposed,
            picture, count);
        flights(fmt::format("flights, real camera, map of {} m", resolution), room, voxels,
                realCameraOptions(), picture, count);
    }
    keyframeRow("keyframe at full size, independent noise", room, 0, count);
    keyframeRow("keyframe at half size, independent noise", room, 1, count);
    flights("flights over floor, independent noise", floor, floor, ideal, independentNoise, count);
    flights("flights in room, independent noise", room, room, ideal, independentNoise, count);
    flights("flights in room, huber, independent noise", room, room, huber, independentNoise,
            count);
    flights("flights over floor, real camera", floor, floor, realCameraOptions(), picture, count);
    flights("flights in room, real camera", room, room, realCameraOptions(), picture, count);
}
