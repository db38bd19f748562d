// SPDX-License-Identifier: BSD-3-Clause
// The basin of convergence: success rate of alignments without a prior, by initial offset, and how
// often a wrong pose is accepted. The tables of docs/experiments/tracking.md.
#include <fmt/format.h>

#include <cstdlib>
#include <random>

#include "alignment/dense_aligner.hpp"
#include "bench_arguments.hpp"
#include "geometry/se3.hpp"
#include "image_noise.hpp"
#include "tracking_scenes.hpp"

using namespace photonav;

namespace {

using Random = std::mt19937_64;

Eigen::Vector3d randomDirection(Random& random) {
    std::normal_distribution<double> normal;
    Eigen::Vector3d d;
    for (double& component : d) component = normal(random);
    return Eigen::Vector3d(d.normalized());
}

struct Outcome {
    int right = 0;
    int accepted = 0;  ///< wrong, but not lost
};

Outcome align(const MeshRenderer& world, double belowHorizon, double metres, double degrees,
              int trials) {
    const Camera camera = trackingCamera();
    DenseAligner aligner(world, camera);
    Random random(1);
    std::uniform_real_distribution<double> around(0., 2. * std::numbers::pi);
    Outcome outcome;
    View view;
    for (int i = 0; i < trials; ++i) {
        const Pose truth = onCircle(around(random), belowHorizon);
        world.render(camera, truth, view);
        const ImageF image = independentNoise(view.intensity, random);
        Vector6 xi;
        xi.head<3>() = metres * randomDirection(random);
        xi.tail<3>() = degrees * std::numbers::pi / 180. * randomDirection(random);
        const Alignment a = aligner.align(image, expSE3(xi) * truth);
        const Vector6 error = logSE3(truth * a.T_c_w.inverse());
        const bool right = error.head<3>().norm() < 0.01 && error.tail<3>().norm() < 0.005;
        outcome.right += right && !isLost(a.verdict) ? 1 : 0;
        outcome.accepted += !right && !isLost(a.verdict) ? 1 : 0;
    }
    return outcome;
}

void table(const std::string& name, const MeshRenderer& world, double belowHorizon, int trials) {
    constexpr std::array kDegrees = {0.5, 1., 2., 5., 10.};
    fmt::print("\n{}: found / wrong but accepted [%]\n", name);
    for (const double degrees : kDegrees) fmt::print("{:>13} deg", degrees);
    fmt::print("\n");
    for (const double centimetres : {1., 2., 5., 10., 20.}) {
        fmt::print("{:3.0f} cm", centimetres);
        for (const double degrees : kDegrees) {
            const Outcome o = align(world, belowHorizon, 0.01 * centimetres, degrees, trials);
            fmt::print("{:9.0f} / {:3.0f}  ", 100. * o.right / trials, 100. * o.accepted / trials);
        }
        fmt::print("\n");
        std::fflush(stdout);
    }
}

}  // namespace

int main(int argc, char** argv) {
    const BenchArguments arguments(argc, argv, "basin_bench [TRIALS_PER_CELL=40]");
    const int trials = arguments.number(1, 40, 1);
    fmt::print("{} alignments a cell, 188x120, noise 0.02; found: within 1 cm and 0.3 degrees\n",
               trials);
    forTrackingViews([&](const auto& name, const auto& world, double belowHorizon) {
        table(name, world, belowHorizon, trials);
    });
}
