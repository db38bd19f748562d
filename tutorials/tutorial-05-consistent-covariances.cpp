// SPDX-License-Identifier: BSD-3-Clause
// Are the covariances of alignments consistent? The same view with many draws of noise: squared
// errors, in units of the covariance that each alignment returns, against the chi-square
// distribution.
#include <algorithm>
#include <cstdio>
#include <random>

#include "alignment/dense_aligner.hpp"
#include "estimation/calibration.hpp"
#include "evaluation/evaluation.hpp"
#include "exercises.hpp"
#include "geometry/constants.hpp"
#include "geometry/se3.hpp"
#include "plot/figure.hpp"
#include "render/mesh_renderer.hpp"
#include "scene/scene.hpp"
#include "simulation/camera_noise.hpp"
#include "simulation/simulated_camera.hpp"

using namespace photonav;

namespace {

constexpr int kImages = 60;

/// A crate on a carpet.
Scene crateOnCarpet() {
    Scene scene;
    const auto carpet = addTexture(scene, valueNoise({.size = {14., 12.}, .seed = 1}));
    const auto boards = addTexture(scene, checker({.cell = 0.28, .softEdge = 0.06}));
    addPlane(scene, {-4., 6., 0.}, {14., 0., 0.}, {0., -12., 0.}, carpet);
    addBox(scene, {0.61, -0.43, 0.}, {1.44, 0.42, 0.7}, boards);
    return scene;
}

/// Where the camera of this tutorial really is: 1.6 m up, 45 degrees down.
Pose trueCamera() {
    Pose T_w_b = Pose::Identity();
    T_w_b.translation().z() = 1.6;
    return (T_w_b * cameraMount(45. * kDegree)).inverse();
}

AlignmentOptions assuming(double sigma, double scale = 1.) {
    AlignmentOptions options;
    options.photometric = {.sigma = sigma, .scale = scale};
    return options;
}

//! [nees]
/// Squared errors of alignments, each in units of the alignment's own covariance and divided by 6.
std::vector<double> squaredErrors(const ViewSource& model, const Camera& camera,
                                  const ImageNoise& addNoise, const AlignmentOptions& options) {
    DenseAligner aligner(model, camera, options);
    std::mt19937_64 random(1);
    std::vector<double> errors;
    for (int i = 0; i < kImages; ++i) {
        View view;
        model.render(camera, trueCamera(), view);
        addNoise(view.intensity, random, {});
        const Pose T_start_w = expSE3(0.005 * Vector6::Ones()) * trueCamera();
        const Alignment a = aligner.align(view.intensity, T_start_w);
        const auto squared = squaredNormalisedError({a.T_c_w, a.covariance}, trueCamera());
        if (!isLost(a.verdict) && squared) errors.push_back(*squared / 6.);
    }
    return errors;
}
//! [nees]

double mean(const std::vector<double>& values) {
    double sum = 0.;
    for (const double value : values) sum += value / static_cast<double>(values.size());
    return sum;
}

//! [cases]
struct Case {
    const char* name;
    ImageNoise noise;
    AlignmentOptions options;
    Color color;
};

std::vector<Case> cases() {
    const ImageNoise independent = assumedNoise({.sigma = 0.02});
    const ImageNoise correlated = assumedNoise({.sigma = 0.02, .scale = 0.08});
    const ImageNoise camera = [](ImageF& image, std::mt19937_64& random, const IsStopped&) {
        CameraNoiseOptions options;
        options.blur = 0.2;
        image = takePicture(image, options, random);
    };
    AlignmentOptions measured = photographOptions();
    return {{"independent noise, as assumed", independent, assuming(0.02), {20, 60, 160}},
            {"correlated noise, assumed independent", correlated, assuming(0.02), {200, 60, 40}},
            {"correlated noise, scale 0.08", correlated, assuming(0.02, 0.08), {38, 140, 122}},
            {"camera with vignetting, sigma assumed", camera, assuming(0.02), {230, 140, 20}},
            {"camera with vignetting, from residuals", camera, measured, {130, 90, 180}}};
}
//! [cases]

std::vector<Exercise> exercises(const ViewSource& model, const Camera& camera) {
    const auto nees = [&](double sigma, double scale, const AlignmentOptions& options) {
        const ImageNoise noise = assumedNoise({.sigma = sigma, .scale = scale});
        return mean(squaredErrors(model, camera, noise, options));
    };
    return {{[=] { return nees(0.03, 1., assuming(0.02)); }, 0.15},
            {[=] { return 1. / nees(0.02, 0.08, assuming(0.02)); }, 0.15}};
}

/// Share of the errors below each value: to the left of chi-square the covariance is too large.
void drawShares(Plot& plot, std::vector<double> errors, const Case& c) {
    std::ranges::sort(errors);
    Plot::Points points;
    for (std::size_t i = 0; i < errors.size(); ++i) {
        points.emplace_back(errors[i], double(i + 1) / double(errors.size()));
    }
    plot.curve(points, {.color = c.color, .width = 3., .name = c.name});
}

}  // namespace

int main(int argc, char** argv) {
    const MeshRenderer model(crateOnCarpet());
    const Camera camera = makeCamera(188, 120, 70. * kDegree);
    if (const auto code = checkAnswers(argc, argv, exercises(model, camera))) return *code;

    Plot plot;
    plot.x = {.min = 0.01, .max = 100., .log = true, .label = "squared error / 6, in covariances"};
    plot.y = {.min = 0., .max = 1., .label = "share of the images below"};
    Plot::Points chiSquare;
    for (double x = 0.01; x < 100.; x *= 1.1) {  // 6 degrees of freedom
        const double half = 3. * x;
        chiSquare.emplace_back(x, 1. - std::exp(-half) * (1. + half + half * half / 2.));
    }
    plot.curve(chiSquare, {.name = "consistent: chi-square", .dashed = true});

    std::puts("                                          images      NEES");
    for (const Case& c : cases()) {
        const std::vector<double> errors = squaredErrors(model, camera, c.noise, c.options);
        std::printf("%-40s %7zu  %8.2f\n", c.name, errors.size(), mean(errors));
        drawShares(plot, errors, c);
    }
    Figure{"Errors in units of the covariance", {{plot}}}.save("consistent_covariances.png");
    std::puts("wrote consistent_covariances.png");
}
