// SPDX-License-Identifier: BSD-3-Clause
// Depth from stereo and odometry with it, one thread, at 376x240: the pairs of an EuRoC folder
// (argument, or PHOTONAV_DATA/euroc_v101_start), images in memory. Median times of a pair; ratios
// are of the same run.
#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <opencv2/core.hpp>
#include <vector>

#include "bench_arguments.hpp"
#include "depth/stereo_depth.hpp"
#include "estimation/tracker.hpp"
#include "thread_time.hpp"

using namespace photonav;

namespace {

double median(std::vector<double> values) {
    const auto middle = values.begin() + std::ssize(values) / 2;
    std::nth_element(values.begin(), middle, values.end());
    return *middle;
}

struct Timed {
    double depth = 0.;     ///< rectification and matching, median of all pairs [ms]
    double odometry = 0.;  ///< [ms]
    double density = 0.;   ///< share of the pixels with depth
    double drift = 0.;     ///< of the camera centre after the last pair [m]
    int lost = 0;
};

Timed run(const StereoSequence& sequence, const std::vector<StereoImages>& images,
          const StereoOptions& options) {
    StereoDepth stereo(sequence.left, sequence.right, options);
    const Pose first = stereo.T_r_c() * sequence.frames.front().T_c_w;
    const Pose last = stereo.T_r_c() * sequence.frames.back().T_c_w;
    TrackerOptions keyframesAlone;
    keyframesAlone.keyframes.emplace();
    Tracker odometry(nullptr, stereo.camera(), {first, Matrix6::Zero()}, keyframesAlone);
    std::vector<double> depthTimes, odometryTimes;
    Timed timed;
    View view;
    for (std::size_t i = 0; i < images.size(); ++i) {
        const double t0 = threadTime();
        stereo(images[i], view);
        const double t1 = threadTime();
        timed.lost += odometry.track(view, sequence.frames[i].timestamp).rejected ? 1 : 0;
        const double t2 = threadTime();
        depthTimes.push_back(t1 - t0);
        odometryTimes.push_back(t2 - t1);
        const auto known =
            std::count_if(view.depth.bitmap, view.depth.bitmap + view.depth.getSize(),
                          [](float z) { return z > 0.F; });
        timed.density += double(known) / view.depth.getSize() / double(images.size());
    }
    timed.depth = median(depthTimes);
    timed.odometry = median(odometryTimes);
    timed.drift =
        (odometry.beliefAtLastImage().mean.inverse().translation() - last.inverse().translation())
            .norm();
    return timed;
}

}  // namespace

int main(int argc, char** argv) {
    const BenchArguments arguments(argc, argv, "stereo_bench [EUROC_FOLDER]");
    cv::setNumThreads(1);
    const char* data = std::getenv("PHOTONAV_DATA");
    const std::string folder =
        arguments.text(1, data ? std::string(data) + "/euroc_v101_start" : std::string());
    if (folder.empty()) {
        fmt::print(stderr, "stereo_bench: give EUROC_FOLDER, or set PHOTONAV_DATA\n");
        return 2;
    }
    const StereoSequence sequence = readEurocSequence(folder);
    std::vector<StereoImages> images;
    for (std::size_t i = 0; i < sequence.frames.size(); ++i)
        images.push_back(loadStereo(sequence, i));
    fmt::print("{} pairs of {}\n", images.size(), folder);
    double semiGlobal = 0.;
    for (const auto& [name, method, halvings] :
         {std::tuple{"semi-global 376x240", StereoMethod::semiGlobal, 1},
          {"block matching 376x240", StereoMethod::blockMatching, 1},
          {"block matching 752x480", StereoMethod::blockMatching, 0}}) {
        StereoOptions options;
        options.method = method;
        options.halvings = halvings;
        const Timed t = run(sequence, images, options);
        if (semiGlobal == 0.) semiGlobal = t.depth;
        fmt::print(
            "  {:<24} depth {:6.2f} ms ({:4.1f}x semi-global's speed)  odometry {:5.2f} ms  "
            "together "
            "{:4.0f} Hz  density {:4.1f} %  drift {:.2f} mm  lost {}\n",
            name, t.depth, semiGlobal / t.depth, t.odometry, 1e3 / (t.depth + t.odometry),
            100. * t.density, 1e3 * t.drift, t.lost);
    }
}
