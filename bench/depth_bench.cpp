// SPDX-License-Identifier: BSD-3-Clause
// Depth along a synthetic flight at 376x240, images of a real camera (shot noise, read noise,
// blur): the monocular filter and stereo block matching against the true depth, image by image and
// as maps of 5 cm. One thread; both see the same images.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <opencv2/core.hpp>
#include <string>
#include <vector>

#include "camera_noise.hpp"
#include "map_fusion.hpp"
#include "mesh_renderer.hpp"
#include "monocular_depth.hpp"
#include "stereo_depth.hpp"
#include "thread_time.hpp"
#include "tracking_scenes.hpp"

using namespace photonav;

namespace {

constexpr int kImages = 80;
constexpr double kStep = 0.02;      // on the circle of 2 m radius: 4 cm [rad]
constexpr double kBaseline = 0.11;  // EuRoC's [m]
constexpr double kCell = 0.05;      // of the maps [m]
const FusionOptions kFusion{.maxRange = 5.};

double quantile(std::vector<float>& values, double q) {
    if (values.empty()) return 0.;
    const auto at = values.begin() + std::ptrdiff_t(q * double(values.size() - 1));
    std::nth_element(values.begin(), at, values.end());
    return *at;
}

vpImage<unsigned char> bytes(const ImageF& image) {
    vpImage<unsigned char> result(image.getHeight(), image.getWidth());
    for (unsigned i = 0; i < image.getSize(); ++i) {
        result.bitmap[i] = static_cast<unsigned char>(std::lround(255.F * image.bitmap[i]));
    }
    return result;
}

/// Depths of many views against the truth, and the map they make.
struct Judge {
    explicit Judge(std::string called) : name(std::move(called)) {}

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

    /// Share of the occupied cells of one map that have one of the other's next to them.
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

void fly(const char* title, const ViewSource& hall, double belowHorizon) {
    DistortedCamera left;
    left.camera = makeCamera(376, 240, 80. * std::numbers::pi / 180.);
    DistortedCamera right = left;
    right.T_b_c.translation().x() = kBaseline;
    StereoDepth stereo(left, right, {.halvings = 0});
    const Camera camera = stereo.camera();
    std::mt19937_64 random(1);
    const auto picture = [&](const Pose& T_c_w, const Camera& of) {
        View view;
        hall.render(of, T_c_w, view);
        return takePicture(view.intensity, {}, random);
    };
    const auto truthAt = [&](const Pose& T_c_w) {
        View view;
        hall.render(camera, T_c_w, view);
        return view;
    };
    Judge mono("monocular"), pair("stereo"), truth("true depth");
    MonocularDepth filters(camera);
    int references = 0;
    const auto judge = [&](const DepthFilter& filter) {
        const View ideal = truthAt(filter.pose());
        mono.add(filter.view(), ideal.depth, camera, filter.pose());
        truth.add(ideal, ideal.depth, camera, filter.pose());
        const Pose T_l_w = stereo.T_r_c().inverse() * filter.pose();
        const StereoImages images{bytes(picture(T_l_w, left.camera)),
                                  bytes(picture(right.T_b_c.inverse() * T_l_w, right.camera))};
        View view;
        const double before = threadTime();
        stereo(images, view);
        pair.seconds.push_back(1e-3 * (threadTime() - before));
        pair.add(view, ideal.depth, camera, filter.pose());
        ++references;
    };
    for (int i = 0; i < kImages; ++i) {
        const Pose T_c_w = onCircle(kStep * i, belowHorizon);
        const ImageF image = picture(T_c_w, camera);
        const double before = threadTime();
        const auto finished = filters.add(image, T_c_w);
        mono.seconds.push_back(1e-3 * (threadTime() - before));
        if (finished) judge(*finished);
    }
    if (const auto last = filters.finish()) judge(*last);
    truth.seconds.push_back(0.);
    fmt::print("{}: {} images, {} references\n", title, kImages, references);
    fmt::print("  {:<22} {:>7}   {:>15}   {:>7}    {:>15}   {:>8}\n", "", "pixels",
               "error p50, p90", "> 10 %", "cells right, found", "time mean, max");
    for (Judge* judged : {&mono, &pair, &truth}) judged->print(truth.map);
}

}  // namespace

int main() {
    cv::setNumThreads(1);
    const MeshRenderer hall(furnishedHall());
    fly("hall with boxes, 45 degrees", hall, std::numbers::pi / 4.);
    fly("hall with boxes, 10 degrees below the horizon", hall, std::numbers::pi / 18.);
    fly("hall with boxes, downward", hall, std::numbers::pi / 2.);
}
