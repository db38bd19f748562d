// SPDX-License-Identifier: BSD-3-Clause
// Localisation in a scene that has changed since the model was made: all boxes of a hall stand
// elsewhere. How often is an image called converged although its pose is wrong? A table of
// docs/experiments/tracking.md.
#include <fmt/format.h>

#include <cstdio>
#include <numbers>
#include <random>
#include <string>
#include <vector>

#include "alignment/dense_aligner.hpp"
#include "bench_arguments.hpp"
#include "estimation/calibration.hpp"
#include "geometry/se3.hpp"
#include "image_noise.hpp"
#include "render/area_sensor.hpp"
#include "statistics.hpp"
#include "tracking_scenes.hpp"

using namespace photonav;

namespace {

using Random = std::mt19937_64;

struct Outcome {
    int converged = 0;
    int wrong = 0;  ///< converged, and a component is beyond five standard deviations
    std::vector<double> millimetres;  ///< of those that converged

    void add(const Alignment& a, const Pose& truth) {
        if (a.verdict != Verdict::converged) return;
        ++converged;
        const Vector6 xi = logSE3(truth * a.T_c_w.inverse());
        const Vector6 sigmas = a.covariance.diagonal().cwiseSqrt();
        wrong += (xi.cwiseAbs().array() > 5. * sigmas.array()).any() ? 1 : 0;
        millimetres.push_back(1e3 * xi.head<3>().norm());
    }
    std::string text() const {
        return fmt::format("{:9} {:6} {:8.1f}", converged, wrong, quantile(millimetres, 0.5));
    }
};

/// @param contrast of floor and walls, see furnishedHall()
void row(double contrast, double moved, int count) {
    const MeshRenderer model(furnishedHall(0., contrast));
    const MeshRenderer world(furnishedHall(moved, contrast));
    const AreaSensor sensor(world);
    const Camera camera = trackingCamera();
    AlignmentOptions options = realCameraOptions(kAreaBlur);
    options.robust = RobustWeight::huber;
    DenseAligner judging(model, camera, options);
    options.trust.minTexture = -kInfinity;
    DenseAligner byResiduals(model, camera, options);
    Vector6 sigmas;
    sigmas << Eigen::Vector3d::Constant(0.05), Eigen::Vector3d::Constant(0.02);
    Random random(7);
    Outcome before, after;
    View view;
    for (int i = 0; i < count; ++i) {
        const Pose truth = onCircle(2. * std::numbers::pi * i / count, 0.2 + 0.2 * (i % 5));
        sensor.render(camera, truth, view);
        const ImageF image = independentNoise(view.intensity, random);
        const UncertainPose prior{expSE3(randomTwist(sigmas, random)) * truth,
                                  sigmas.cwiseAbs2().asDiagonal()};
        before.add(byResiduals.align(image, prior), truth);
        after.add(judging.align(image, prior), truth);
    }
    fmt::print("{:8.2f} {:8.2f} |{} |{}\n", contrast, moved, before.text(), after.text());
    std::fflush(stdout);
}

}  // namespace

int main(int argc, char** argv) {
    const BenchArguments arguments(argc, argv, "changed_scene_bench [IMAGES_PER_ROW=100]");
    const int count = arguments.number(1, 100, 1);
    fmt::print(
        "{} images a row, 188 x 120, mesh; contrast of floor and walls relative to the boxes\n"
        "                  | texture not judged       | judged\n"
        "contrast  moved/m |converged  wrong       mm |converged  wrong       mm\n",
        count);
    for (const double contrast : {1., 0.3, 0.1, 0.03}) {
        for (const double moved : {0., 0.03, 0.1, 0.3}) row(contrast, moved, count);
    }
}
