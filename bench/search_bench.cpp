// SPDX-License-Identifier: BSD-3-Clause
// The search of a wide prior in images of several sizes: how often it finds the pose, says that it
// does not know, and is wrong. The table of docs/experiments/tracking.md.
#include <fmt/format.h>

#include <cstdlib>
#include <random>

#include "alignment/wide_aligner.hpp"
#include "bench_arguments.hpp"
#include "geometry/se3.hpp"
#include "image_noise.hpp"
#include "thread_time.hpp"
#include "tracking_scenes.hpp"

using namespace photonav;

namespace {

using Random = std::mt19937_64;

/// Squared Mahalanobis distance in six dimensions that is as rare as five standard deviations in
/// one.
constexpr double kFar = 40.;

/// Standard deviations of a lost camera: 0.3 m, and 0.1 rad about the vertical.
UncertainPose lostCamera(const Pose& mean) {
    Vector6 variances = Vector6::Constant(1e-6);
    variances.head<3>().setConstant(0.3 * 0.3);
    UncertainPose prior{mean, variances.asDiagonal()};
    const Eigen::Vector3d up_c = mean.linear().col(2);
    prior.covariance.bottomRightCorner<3, 3>() += 0.1 * 0.1 * up_c * up_c.transpose();
    return prior;
}

struct Outcome {
    int found = 0;
    int undecided = 0;
    int wrong = 0;             ///< accepted, and beyond kFar
    double milliseconds = 0.;  ///< processor time
};

Outcome search(const MeshRenderer& world, double belowHorizon, unsigned width, int trials) {
    const Camera camera = trackingCamera(width);
    AlignmentOptions options;
    options.photometric = {.sigma = 0.02, .scale = 1.};
    WideAligner aligner(world, camera, options);
    Random random(1);
    std::uniform_real_distribution<double> around(0., 2. * std::numbers::pi);
    Outcome outcome;
    View view;
    for (int i = 0; i < trials; ++i) {
        const Pose truth = onCircle(around(random), belowHorizon);
        const Vector6 position = 0.3 * Vector6(1., 1., 1., 0., 0., 0.);
        Vector6 xi = randomTwist(position, random);
        xi.tail<3>() = randomTwist(Vector6::Constant(0.1), random)[0] * truth.linear().col(2);
        world.render(camera, truth, view);
        const ImageF image = independentNoise(view.intensity, random);
        const UncertainPose prior = lostCamera(expSE3(xi) * truth);
        const double before = threadTime();
        const Alignment a = aligner.align(image, prior);
        outcome.milliseconds += threadTime() - before;
        if (isLost(a.verdict) || a.covariance == prior.covariance) {
            ++outcome.undecided;
        } else {
            const Vector6 error = logSE3(truth * a.T_c_w.inverse());
            ++(squaredDistance(error, a.covariance) > kFar ? outcome.wrong : outcome.found);
        }
    }
    return outcome;
}

void rows(const std::string& name, const MeshRenderer& world, double belowHorizon, int trials) {
    for (const unsigned width : {94U, 188U, 376U, 640U}) {
        const Outcome o = search(world, belowHorizon, width, trials);
        const double percent = 100. / trials;
        fmt::print("{:<46} {:5} {:8.0f} {:10.0f} {:6.0f} {:8.0f}\n", name, width, percent * o.found,
                   percent * o.undecided, percent * o.wrong, o.milliseconds / trials);
        std::fflush(stdout);
    }
}

}  // namespace

int main(int argc, char** argv) {
    const BenchArguments arguments(argc, argv, "search_bench [TRIALS_PER_ROW=40]");
    const int trials = arguments.number(1, 40, 1);
    fmt::print("{} searches a row [%], prior 0.3 m and 0.1 rad about the vertical, noise 0.02\n\n",
               trials);
    fmt::print("{:<46} {:>5} {:>8} {:>10} {:>6} {:>8}\n", "", "width", "found", "undecided",
               "wrong", "ms");
    forTrackingViews([&](const auto& name, const auto& world, double belowHorizon) {
        rows(name, world, belowHorizon, trials);
    });
}
