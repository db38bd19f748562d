// SPDX-License-Identifier: BSD-3-Clause
// Where was this image taken? Render the model from the estimated pose, compare pixel by pixel,
// take a Gauss-Newton step, render again. The residual images are shown in a window, if there is a
// screen, and written as PNG.
#include <visp3/core/vpDisplayException.h>
#include <visp3/core/vpImageConvert.h>
#include <visp3/gui/vpDisplayX.h>

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <random>

#include "alignment/dense_aligner.hpp"
#include "exercises.hpp"
#include "figures/images.hpp"
#include "geometry/constants.hpp"
#include "geometry/se3.hpp"
#include "render/mesh_renderer.hpp"
#include "scene/scene.hpp"

using namespace photonav;

namespace {

const PhotometricOptions kPhotometric{.sigma = 0.02};

/// A crate on a carpet.
Scene crateOnCarpet() {
    Scene scene;
    const auto carpet = addTexture(scene, valueNoise({.size = {14., 12.}, .seed = 1}));
    const auto boards = addTexture(scene, checker({.cell = 0.28, .softEdge = 0.06}));
    addPlane(scene, {-4., 6., 0.}, {14., 0., 0.}, {0., -12., 0.}, carpet);
    addBox(scene, {0.61, -0.43, 0.}, {1.44, 0.42, 0.7}, boards);
    return scene;
}

ImageF noisy(ImageF image, double sigma) {
    std::mt19937_64 random(1);
    std::normal_distribution<float> noise(0.F, static_cast<float>(sigma));
    for (unsigned i = 0; i < image.getSize(); ++i) image.bitmap[i] += noise(random);
    return image;
}

/// Grey where prediction and image agree.
ImageF residual(const ImageF& observed, const ImageF& predicted) {
    ImageF difference = observed;
    for (unsigned i = 0; i < difference.getSize(); ++i) {
        difference.bitmap[i] = 0.5F + observed.bitmap[i] - predicted.bitmap[i];
    }
    return difference;
}

//! [window]
/// A window of ViSP for a picture that changes, if there is a screen to show it on.
class Window {
  public:
    void show(const ImageF& picture) {
        if (!hasScreen_) return;
        vpImageConvert::convert(picture, image_);  // the largest value white, the smallest black
        try {
            if (!display_) display_ = std::make_unique<vpDisplayX>(image_, 40, 40, "alignment");
        } catch (const vpDisplayException&) {
            hasScreen_ = false;
            return;
        }
        vpDisplay::display(image_);
        vpDisplay::flush(image_);
        vpTime::wait(500.);  // [ms]
    }

  private:
    bool hasScreen_ = std::getenv("DISPLAY") != nullptr;
    vpImage<unsigned char> image_;
    std::unique_ptr<vpDisplayX> display_;
};
//! [window]

struct Error {
    double metres, degrees;
};

Error errorOf(const Pose& T_c_w, const Pose& T_true_w) {
    const Vector6 xi = logSE3(T_c_w * T_true_w.inverse());
    return {xi.head<3>().norm(), xi.tail<3>().norm() / kDegree};
}

/// Where the camera of this tutorial really is: 1.6 m up, looking down by `pitch` [rad].
Pose trueCamera(double pitch) {
    Pose T_w_b = Pose::Identity();
    T_w_b.translation().z() = 1.6;
    return (T_w_b * cameraMount(pitch)).inverse();
}

void watchItConverge(const ViewSource& model, const Camera& camera, const ImageF& observed,
                     const Pose& T_true_w, const Vector6& offset) {
    std::puts("Gauss-Newton at full size, from 4 cm and 1.2 degrees away");
    std::puts("step   residual   error [mm]  [deg]");
    Window window;
    std::vector<std::vector<CaptionedImage>> rows;
    View view;
    //! [gauss newton]
    Pose T_c_w = expSE3(offset) * T_true_w;
    ViewComparison compare(camera, kPhotometric);
    for (int step = 0; step <= 6; ++step) {
        model.render(camera, T_c_w, view);  // anew, at the present estimate
        const NormalEquations e = compare(view, observed, Exposure{}, Loss{});
        const auto [metres, degrees] = errorOf(T_c_w, T_true_w);
        std::printf("%4d %10.4f %12.2f %6.3f\n", step, std::sqrt(e.sumSquares / e.count),
                    1000. * metres, degrees);
        const ImageF difference = residual(observed, view.intensity);
        window.show(difference);
        rows.push_back({{"observed", greyPicture(observed)},
                        {"predicted in step " + std::to_string(step), predictedPicture(view)},
                        {"residual", greyPicture(difference)}});
        const PoseEquations p = poseEquations(e, kPhotometric);
        T_c_w = expSE3(p.information.ldlt().solve(p.rhs)) * T_c_w;
    }
    //! [gauss newton]
    rows.resize(3);
    imagesFigure(rows, 376.).save("alignment.png");
}

void startFartherAway(const ViewSource& model, const Camera& camera, const ImageF& observed,
                      const Pose& T_true_w, const Vector6& offset) {
    std::puts("coarse to fine, from ever farther away");
    std::puts("start [cm]  [deg]   verdict      views  error [mm]  believed [mm]");
    //! [aligner]
    AlignmentOptions options;
    options.photometric = kPhotometric;
    DenseAligner aligner(model, camera, options);
    for (const double factor : {1., 2., 3., 4., 6., 20.}) {
        const Pose T_start = expSE3(factor * offset) * T_true_w;
        const Alignment a = aligner.align(observed, T_start);
        const Error before = errorOf(T_start, T_true_w);
        std::printf("%10.0f %6.1f   %-11s %6d %11.2f %14.2f\n", 100. * before.metres,
                    before.degrees, isLost(a.verdict) ? "lost" : describe(a).c_str(), a.iterations,
                    1000. * errorOf(a.T_c_w, T_true_w).metres,
                    1000. * std::sqrt(a.covariance.topLeftCorner<3, 3>().trace()));
    }
    //! [aligner]
}

/// Alignment of several images over stripes, with a prior of the position.
Alignment alignOverStripes(const Camera& camera, const Vector6& offset, double priorSigma,
                           int images) {
    AlignmentOptions options;
    options.photometric = kPhotometric;
    View view;
    //! [prior]
    // Stripes along the camera's x axis do not inform about x: only the prior limits this
    // direction.
    Scene stripes;
    addPlane(stripes, {-4., -4., 0.}, {8., 0., 0.}, {0., 8., 0.},
             addTexture(stripes, photonav::stripes({.width = 0.4, .softEdge = 0.05})));
    const MeshRenderer floor(stripes);
    const Pose T_down_w = trueCamera(90. * kDegree);
    floor.render(camera, T_down_w, view);
    DenseAligner onStripes(floor, camera, options);
    UncertainPose belief{expSE3(offset) * T_down_w, 1e-2 * Matrix6::Identity()};
    belief.covariance.topLeftCorner<3, 3>() *= priorSigma * priorSigma / 1e-2;
    Alignment a;
    for (int i = 0; i < images; ++i) {
        a = onStripes.align(noisy(view.intensity, kPhotometric.sigma), belief);
        belief = {a.T_c_w, a.covariance};
    }
    //! [prior]
    return a;
}

void lookAtStripes(const Camera& camera, const Vector6& offset) {
    const Alignment a = alignOverStripes(camera, offset, 0.1, 1);
    std::printf("over stripes: %s; standard deviation along x %.4f m, along y %.4f m\n",
                describe(a).c_str(), std::sqrt(a.covariance(0, 0)), std::sqrt(a.covariance(1, 1)));
}

/// The standard deviation of the position that an alignment believes [mm].
double believed(const ViewSource& model, const Camera& camera, const ImageF& observed,
                const Pose& T_start_w, double scale) {
    AlignmentOptions options;
    options.photometric = {.sigma = kPhotometric.sigma, .scale = scale};
    const Alignment a = DenseAligner(model, camera, options).align(observed, T_start_w);
    return 1000. * std::sqrt(a.covariance.topLeftCorner<3, 3>().trace());
}

}  // namespace

int main(int argc, char** argv) {
    const MeshRenderer model(crateOnCarpet());
    const Camera camera = makeCamera(188, 120, 70. * kDegree);
    const Pose T_true_w = trueCamera(45. * kDegree);
    View view;
    model.render(camera, T_true_w, view);
    const ImageF observed = noisy(view.intensity, kPhotometric.sigma);
    Vector6 offset;  // of the first guess
    offset << 0.03, -0.02, 0.02, 0.01, 0.015, -0.01;
    const std::vector<Exercise> exercises{
        {[&] { return believed(model, camera, observed, expSE3(offset) * T_true_w, 0.08); }, 0.05},
        {[&] { return std::sqrt(alignOverStripes(camera, offset, 0.3, 3).covariance(0, 0)); }}};
    if (const auto code = checkAnswers(argc, argv, exercises)) return *code;

    watchItConverge(model, camera, observed, T_true_w, offset);
    startFartherAway(model, camera, observed, T_true_w, offset);
    lookAtStripes(camera, offset);
    std::puts("wrote alignment.png");
}
