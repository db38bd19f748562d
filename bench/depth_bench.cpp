// SPDX-License-Identifier: BSD-3-Clause
// Depth along flights: the monocular filter and stereo block matching against the true depth, image
// by image and as maps of 5 cm. One thread; both methods get views of the same world from the same
// poses: the poses of the sample flights, with their image size and noise, and flights through a
// hall at 376x240, with the noise of a real camera (shot noise, read noise, blur).
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <opencv2/core.hpp>
#include <random>
#include <string>
#include <vector>

#include "bench_arguments.hpp"
#include "dataset/sequence_tum.hpp"
#include "depth/monocular_depth.hpp"
#include "depth/stereo_depth.hpp"
#include "map/map_fusion.hpp"
#include "render/mesh_renderer.hpp"
#include "simulation/camera_noise.hpp"
#include "simulation/simulated_camera.hpp"
#include "statistics.hpp"
#include "thread_time.hpp"
#include "tracking_scenes.hpp"

using namespace photonav;

namespace {

constexpr int kImages = 80;         // through the hall
constexpr double kStep = 0.02;      // on its circle of 2 m radius: 4 cm [rad]
constexpr double kBaseline = 0.11;  // EuRoC's [m]
constexpr double kCell = 0.05;      // of the maps [m]
const FusionOptions kFusion{.maxRange = 5.};

vpImage<unsigned char> bytes(const ImageF& image) {
    vpImage<unsigned char> result(image.getHeight(), image.getWidth());
    for (unsigned i = 0; i < image.getSize(); ++i) {
        result.bitmap[i] = greyLevel(image.bitmap[i]);
    }
    return result;
}

/// Errors of the depths of many views, and the map made of them.
struct DepthErrors {
    explicit DepthErrors(std::string called) : name(std::move(called)) {}

    std::string name;
    TexturedOcTree map{kCell};
    std::vector<float> errors;  ///< relative
    std::size_t pixels = 0;     ///< with a true depth
    std::vector<double> seconds;

    void add(const View& view, const ImageF& truth, const Camera& camera, const Pose& T_c_w) {
        for (unsigned i = 0; i < truth.getSize(); ++i) {
            const float z = truth.bitmap[i];
            if (!(z > 0.F)) continue;
            ++pixels;
            const float measured = view.depth.bitmap[i];
            if (measured > 0.F) errors.push_back(std::abs(measured - z) / z);
        }
        fuse(map, view, camera, T_c_w, kFusion);
    }

    void print(const TexturedOcTree& trueMap) {
        const auto wild =
            std::count_if(errors.begin(), errors.end(), [](float error) { return error > 0.1F; });
        const double slowest = *std::max_element(seconds.begin(), seconds.end());
        double total = 0.;
        for (const double s : seconds) total += s;
        fmt::print("  {:<22} {:5.1f} %   {:5.2f} % {:5.2f} %   {:5.2f} %    {:5.1f} % {:5.1f} %",
                   name, 100. * double(errors.size()) / double(pixels),
                   100. * quantile(errors, 0.5), 100. * quantile(errors, 0.9),
                   100. * double(wild) / double(errors.size()), 100. * shareNear(map, trueMap),
                   100. * shareNear(trueMap, map));
        if (total > 0.) {
            fmt::print("   {:5.1f} {:5.1f} ms", 1e3 * total / double(seconds.size()),
                       1e3 * slowest);
        }
        fmt::print("\n");
    }

    /// Share of the occupied cells of one map with an occupied cell of the other next to them.
    static double shareNear(const TexturedOcTree& map, const TexturedOcTree& other) {
        std::size_t count = 0;
        std::size_t near = 0;
        for (auto leaf = map.begin_leafs(); leaf != map.end_leafs(); ++leaf) {
            if (!map.isNodeOccupied(*leaf)) continue;
            ++count;
            near += isNear(leaf.getCoordinate(), other) ? 1 : 0;
        }
        return count > 0 ? double(near) / double(count) : 0.;
    }

    static bool isNear(const octomap::point3d& p, const TexturedOcTree& other) {
        constexpr auto kStride = static_cast<float>(kCell);
        for (const float x : {-kStride, 0.F, kStride}) {
            for (const float y : {-kStride, 0.F, kStride}) {
                for (const float z : {-kStride, 0.F, kStride}) {
                    const auto* node = other.search(p + octomap::point3d(x, y, z));
                    if (node != nullptr && other.isNodeOccupied(*node)) return true;
                }
            }
        }
        return false;
    }
};

/// The poses of a flight, and the noise of its camera.
struct Flight {
    std::string title;
    const ViewSource& world;
    Camera camera;
    std::vector<Pose> T_c_w;
    std::function<ImageF(const ImageF& ideal, std::mt19937_64& random)> expose;
};

/// Two cameras side by side; the monocular filter uses the left one.
class Rig {
  public:
    explicit Rig(const Flight& flight)
        : flight_(flight),
          left_{flight.camera, Eigen::Vector4d::Zero(), Pose::Identity(), {}},
          right_(left_),
          stereo_(pair()) {}

    const Camera& camera() const { return stereo_.camera(); }

    View ideal(const Pose& T_c_w) const {
        View view;
        flight_.world.render(camera(), T_c_w, view);
        return view;
    }

    ImageF picture(const Pose& T_c_w) { return flight_.expose(ideal(T_c_w).intensity, random_); }

    /// @param T_c_w of the rectified left camera
    /// @return seconds it took
    double measure(const Pose& T_c_w, View& view) {
        const Pose T_l_w = stereo_.T_r_c().inverse() * T_c_w;
        const StereoImages images{taken(T_l_w), taken(right_.T_b_c.inverse() * T_l_w)};
        const double before = threadTime();
        stereo_(images, view);
        return 1e-3 * (threadTime() - before);
    }

  private:
    StereoDepth pair() {
        right_.T_b_c.translation().x() = kBaseline;
        return {left_, right_, {.halvings = 0}};
    }

    vpImage<unsigned char> taken(const Pose& T_c_w) {
        View view;
        flight_.world.render(flight_.camera, T_c_w, view);
        return bytes(flight_.expose(view.intensity, random_));
    }

    const Flight& flight_;
    DistortedCamera left_, right_;
    StereoDepth stereo_;
    std::mt19937_64 random_{1};
};

void fly(const Flight& flight) {
    Rig rig(flight);
    const Camera& camera = rig.camera();
    DepthErrors mono("monocular"), pair("stereo"), truth("true depth");
    MonocularDepth filters(camera);
    int references = 0;
    const auto measure = [&](const DepthFilter& filter) {
        const View ideal = rig.ideal(filter.pose());
        mono.add(filter.view(), ideal.depth, camera, filter.pose());
        truth.add(ideal, ideal.depth, camera, filter.pose());
        View view;
        pair.seconds.push_back(rig.measure(filter.pose(), view));
        pair.add(view, ideal.depth, camera, filter.pose());
        ++references;
    };
    for (const Pose& T_c_w : flight.T_c_w) {
        const ImageF image = rig.picture(T_c_w);
        const double before = threadTime();
        const auto finished = filters.add(image, T_c_w);
        mono.seconds.push_back(1e-3 * (threadTime() - before));
        if (finished) measure(*finished);
    }
    if (const auto last = filters.finish()) measure(*last);
    truth.seconds.push_back(0.);
    fmt::print("{}: {} images, {} references\n", flight.title, flight.T_c_w.size(), references);
    fmt::print("  {:<22} {:>7}   {:>15}   {:>7}    {:>15}   {:>8}\n", "", "pixels",
               "error p50, p90", "> 10 %", "cells right, found", "time mean, max");
    for (DepthErrors* errors : {&mono, &pair, &truth}) errors->print(truth.map);
}

void flyThroughHall(const char* title, const ViewSource& hall, double belowHorizon) {
    Flight flight{title, hall, makeCamera(376, 240, 80. * std::numbers::pi / 180.), {}, {}};
    for (int i = 0; i < kImages; ++i) flight.T_c_w.push_back(onCircle(kStep * i, belowHorizon));
    flight.expose = [](const ImageF& ideal, std::mt19937_64& random) {
        return takePicture(ideal, {}, random);
    };
    fly(flight);
}

/// The poses of a sample flight, in the scene where it was recorded.
void repeatFlight(const std::string& name, const std::string& scene) {
    const std::string root = PHOTONAV_SOURCE_DIR;
    const MeshRenderer world(loadScene(root + "/config/scenes/" + scene + ".yaml"));
    const Sequence recorded = readTumSequence(root + "/data/" + name);
    Flight flight{name + " in " + scene, world, recorded.camera, {}, {}};
    for (const auto& frame : recorded.frames) flight.T_c_w.push_back(frame.T_c_w);
    PhotometricOptions photometric;
    photometric.scale = recorded.informationScale.value_or(1.);
    flight.expose = [noise = assumedNoise(photometric)](ImageF image, std::mt19937_64& random) {
        noise(image, random, {});
        for (unsigned i = 0; i < image.getSize(); ++i) {
            image.bitmap[i] = static_cast<float>(greyLevel(image.bitmap[i])) / 255.F;
        }
        return image;
    };
    fly(flight);
}

}  // namespace

int main(int argc, char** argv) {
    const BenchArguments arguments(argc, argv, "depth_bench");
    cv::setNumThreads(1);
    repeatFlight("flight_down", "two_textures");
    repeatFlight("flight_front45", "room");
    const MeshRenderer hall(furnishedHall());
    flyThroughHall("hall with boxes, 45 degrees", hall, std::numbers::pi / 4.);
    flyThroughHall("hall with boxes, 10 degrees below the horizon", hall, std::numbers::pi / 18.);
    flyThroughHall("hall with boxes, downward", hall, std::numbers::pi / 2.);
}
