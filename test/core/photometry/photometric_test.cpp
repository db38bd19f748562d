// SPDX-License-Identifier: BSD-3-Clause
#include "photometry/photometric.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <numbers>
#include <random>

#include "analytic_plane.hpp"
#include "core/photometry/random_view.hpp"
#include "geometry/se3.hpp"

namespace photonav {
namespace {

using test::countingPixels;
using test::randomView;

struct Case {
    const char* name;
    AnalyticPlane plane;
    Pose T_c_w;
};

/// The floor from above, at 45 degrees, and from a hand's breadth. Wavelengths of 40 pixels or so.
std::vector<Case> cases() {
    AnalyticPlane floor;
    AnalyticPlane fine = floor;
    fine.wavelength = 0.15;
    return {{"downward", floor, lookFrom({0.3, -0.2, 2.}, std::numbers::pi / 2., 0.4)},
            {"oblique", floor, lookFrom({0.1, 0.5, 1.5}, std::numbers::pi / 4., -0.7)},
            {"close", fine, lookFrom({0.3, -0.2, 0.25}, 1.4, 1.)}};
}

/// The camera whose pixel factor * (u, v) looks along the same ray as pixel (u, v) of `camera`.
Camera refined(const Camera& camera, unsigned factor) {
    return {factor * (camera.width - 1) + 1, factor * (camera.height - 1) + 1,
            vpCameraParameters(factor * camera.fx(), factor * camera.fy(), factor * camera.cx(),
                               factor * camera.cy())};
}

/// Derivative of the rendered intensity of one pixel under T_c_w <- exp(xi^) T_c_w.
Vector6 renderedDerivative(const Case& c, const Camera& camera, unsigned u, unsigned v,
                           double step) {
    Vector6 derivative;
    for (int i = 0; i < 6; ++i) {
        const Vector6 xi = step * Vector6::Unit(i);
        derivative[i] = (c.plane.intensity(camera, expSE3(xi) * c.T_c_w, u, v) -
                         c.plane.intensity(camera, expSE3(-xi) * c.T_c_w, u, v)) /
                        (2. * step);
    }
    return derivative;
}

/// Pixels spread over the image, among them the first and last that can count.
std::vector<std::pair<unsigned, unsigned>> somePixels(const Camera& camera) {
    std::vector<std::pair<unsigned, unsigned>> pixels;
    for (unsigned u : {1U, 40U, 93U, 150U, camera.width - 2}) {
        for (unsigned v : {1U, 33U, 60U, 99U, camera.height - 2}) pixels.emplace_back(u, v);
    }
    return pixels;
}

Matrix6 informationByPixels(const View& view, const Camera& camera,
                            const PhotometricOptions& options = {}) {
    Matrix6 sum = Matrix6::Zero();
    for (unsigned v = 0; v < camera.height; ++v) {
        for (unsigned u = 0; u < camera.width; ++u) {
            const Vector6 J = pixelJacobian(view, camera, u, v, options);
            sum += J * J.transpose();
        }
    }
    return options.scale * options.stride * options.stride / (options.sigma * options.sigma) * sum;
}

double relative(const Matrix6& a, const Matrix6& b) { return (a - b).norm() / b.norm(); }

double traceOfInverse(const Matrix6& information) { return information.inverse().trace(); }

// --- The Jacobian against the rendered intensity ------------------------------------------------

/// A surface point moves with xi, so its grey value arrives elsewhere: rendered intensity changes
/// by -J xi. Halving the pixel pitch must quarter the error, in every column.
TEST(PixelJacobian, ConvergesToTheRenderedDerivativeWithThePixelPitch) {
    const Camera camera = defaultCamera();
    for (const Case& c : cases()) {
        std::vector<Vector6> error;
        Vector6 size = Vector6::Zero();
        for (unsigned factor : {1U, 2U, 4U}) {
            const Camera fine = refined(camera, factor);
            const View view = c.plane.view(fine, c.T_c_w);
            Vector6 sum = Vector6::Zero();
            for (const auto& [u, v] : somePixels(camera)) {
                const Vector6 truth = -renderedDerivative(c, camera, u, v, 1e-5);
                const Vector6 J = pixelJacobian(view, fine, factor * u, factor * v);
                ASSERT_FALSE(J.isZero()) << c.name << " " << u << " " << v;
                sum += (J - truth).cwiseAbs2();
                size += truth.cwiseAbs2();
            }
            error.push_back(sum.cwiseSqrt());
        }
        for (int i = 0; i < 6; ++i) {
            EXPECT_LT(error[0][i], 0.04 * std::sqrt(size[i] / 3.)) << c.name << " column " << i;
            EXPECT_NEAR(error[0][i] / error[1][i], 4., 0.3) << c.name << " column " << i;
            EXPECT_NEAR(error[1][i] / error[2][i], 4., 0.3) << c.name << " column " << i;
        }
    }
}

/// The square's gradient is that of its middle. Its depth is that of the pixel, so that the error
/// falls with the pitch, not with its square.
TEST(PixelJacobian, OfASquareIsTheDerivativeAtItsMiddle) {
    const Camera camera = defaultCamera();
    const PhotometricOptions options{.gradient = GradientStencil::square};
    for (const Case& c : cases()) {
        std::vector<double> error;
        for (unsigned factor : {2U, 4U, 8U}) {
            const Camera fine = refined(camera, factor);
            const View view = c.plane.view(fine, c.T_c_w);
            double sum = 0., size = 0.;
            for (const auto& [u, v] : somePixels(camera)) {
                // the square to the left of and above a pixel has its middle at (u, v) in this
                // camera
                Camera shifted = fine;
                shifted.intrinsics.initPersProjWithoutDistortion(fine.fx(), fine.fy(),
                                                                 fine.cx() - 0.5, fine.cy() - 0.5);
                const Vector6 truth = -renderedDerivative(c, shifted, factor * u, factor * v, 1e-5);
                const Vector6 J = pixelJacobian(view, fine, factor * u, factor * v, options);
                ASSERT_FALSE(J.isZero()) << c.name << " " << u << " " << v;
                sum += (J - truth).squaredNorm();
                size += truth.squaredNorm();
            }
            error.push_back(std::sqrt(sum / size));
        }
        EXPECT_LT(error[0], 0.02) << c.name;
        EXPECT_LT(error[1], 0.55 * error[0]) << c.name;
        EXPECT_LT(error[2], 0.55 * error[1]) << c.name;
    }
}

/// The other second-order error: halving the pose step must quarter the distance to J, once the
/// error of the pixel pitch is extrapolated away.
TEST(PixelJacobian, IsTheLimitOfPoseDifferences) {
    const Camera camera = defaultCamera();
    const Camera fine = refined(camera, 2);
    const Camera finer = refined(camera, 4);
    for (const Case& c : cases()) {
        const View fineView = c.plane.view(fine, c.T_c_w);
        const View finerView = c.plane.view(finer, c.T_c_w);
        std::vector<Vector6> error;
        for (double step : {0.016, 0.008, 0.004}) {  // rad and wavelengths
            Vector6 sum = Vector6::Zero();
            for (const auto& [u, v] : somePixels(camera)) {
                const Vector6 J = (4. * pixelJacobian(finerView, finer, 4 * u, 4 * v) -
                                   pixelJacobian(fineView, fine, 2 * u, 2 * v)) /
                                  3.;
                Vector6 truth = renderedDerivative(c, camera, u, v, step);
                truth.head<3>() =
                    renderedDerivative(c, camera, u, v, c.plane.wavelength * step).head<3>();
                sum += (J + truth).cwiseAbs2();
            }
            error.push_back(sum.cwiseSqrt());
        }
        for (int i = 0; i < 6; ++i) {
            EXPECT_NEAR(error[0][i] / error[1][i], 4., 0.3) << c.name << " column " << i;
            EXPECT_NEAR(error[1][i] / error[2][i], 4., 0.3) << c.name << " column " << i;
        }
    }
}

TEST(Information, IsThatOfTheRenderedImage) {
    const Camera camera = defaultCamera();
    const double sigma = PhotometricOptions{}.sigma;
    for (const Case& c : cases()) {
        Matrix6 truth = Matrix6::Zero();
        for (unsigned v = 1; v + 1 < camera.height; ++v) {
            for (unsigned u = 1; u + 1 < camera.width; ++u) {
                const Vector6 d = renderedDerivative(c, camera, u, v, 1e-5) / sigma;
                truth += d * d.transpose();
            }
        }
        const Matrix6 information = photometricInformation(c.plane.view(camera, c.T_c_w), camera);
        // Element by element, relative to its row and column: units do not mix.
        const Vector6 unit = truth.diagonal().cwiseSqrt().cwiseInverse();
        const Matrix6 error = unit.asDiagonal() * (information - truth) * unit.asDiagonal();
        EXPECT_LT(error.cwiseAbs().maxCoeff(), 0.05) << c.name;
    }
}

// --- The kernel against the plain sum -----------------------------------------------------------

TEST(Information, KernelAgreesWithTheSumOverPixels) {
    const Camera camera = defaultCamera();
    for (const Case& c : cases()) {
        const View view = c.plane.view(camera, c.T_c_w);
        const Matrix6 kernel = photometricInformation(view, camera);
        const Matrix6 plain = informationByPixels(view, camera);
        EXPECT_LT(relative(kernel, plain), 1e-6) << c.name;
        EXPECT_NEAR(traceOfInverse(kernel) / traceOfInverse(plain), 1., 1e-6) << c.name;
        EXPECT_EQ(kernel, kernel.transpose());
    }
}

/// Sideways motion and rotation look nearly alike from high above: rounding must not matter, nor
/// the horizon.
TEST(Information, KernelKeepsTheCovarianceFromAnyHeightAndTilt) {
    const Camera camera = defaultCamera();
    for (int k = 0; k < 24; ++k) {
        const Pose T_c_w =
            lookFrom({0.1 * k, 0.05 * k, 0.6 + 0.1 * k}, std::numbers::pi / 2. - 0.06 * k, 0.3 * k);
        const View view = AnalyticPlane{}.view(camera, T_c_w);
        EXPECT_NEAR(traceOfInverse(photometricInformation(view, camera)) /
                        traceOfInverse(informationByPixels(view, camera)),
                    1., 5e-7)
            << k;
    }
}

TEST(Information, KernelAgreesAtAnySizeStrideAndAspect) {
    for (unsigned width : {3U, 4U, 5U, 9U, 10U, 11U, 17U, 18U, 19U, 34U, 35U, 66U, 67U, 131U}) {
        for (unsigned height : {3U, 4U, 7U, 30U}) {
            Camera camera = makeCamera(width, height, 1.2);
            camera.intrinsics.initPersProjWithoutDistortion(camera.fx(), 1.3 * camera.fy(),
                                                            0.4 * width, 0.7 * height);
            const View view = randomView(camera, width);
            for (int stride : {1, 2, 3, 4, 7}) {
                for (const auto gradient : {GradientStencil::central, GradientStencil::square}) {
                    PhotometricOptions options;
                    options.stride = stride;
                    options.gradient = gradient;
                    const Matrix6 plain = informationByPixels(view, camera, options);
                    const Matrix6 kernel = photometricInformation(view, camera, options);
                    EXPECT_LE((kernel - plain).norm(), 1e-6 * plain.norm())
                        << width << "x" << height << " stride " << stride;
                }
            }
        }
    }
}

TEST(Information, KernelAgreesWithHolesEdgesAndSaturation) {
    const Camera camera = defaultCamera();
    View view = randomView(camera, 7);
    std::mt19937 random(7);
    const auto somewhere = [&](ImageF& image) -> float& {
        return image.bitmap[random() % image.getSize()];
    };
    for (int i = 0; i < 700; ++i) {
        somewhere(view.depth) = 0.F;
        somewhere(view.depth) *= 0.8F;
        somewhere(view.intensity) = 1.F;
        somewhere(view.intensity) = 0.F;
    }
    const unsigned counting = countingPixels(view, camera);
    EXPECT_GT(counting, 8000U);
    EXPECT_LT(counting, 18000U);
    EXPECT_LT(relative(photometricInformation(view, camera), informationByPixels(view, camera)),
              1e-6);
}

TEST(Information, ImagesTooSmallForAGradientCarryNothing) {
    for (auto [width, height] : {std::pair{1U, 1U}, {2U, 50U}, {50U, 2U}}) {
        const Camera camera = makeCamera(width, height, 1.);
        EXPECT_EQ(photometricInformation(randomView(camera, 1), camera), Matrix6::Zero());
    }
}

TEST(Information, ScalesWithNoiseAndFactor) {
    const Camera camera = defaultCamera();
    const View view = cases()[0].plane.view(camera, cases()[0].T_c_w);
    PhotometricOptions options;
    const Matrix6 once = photometricInformation(view, camera, options);
    options.sigma *= 2.;
    options.scale = 0.3;
    EXPECT_LT(relative(photometricInformation(view, camera, options), 0.3 / 4. * once), 1e-14);
}

TEST(Information, StrideKeepsTheCovariance) {
    const Camera camera = defaultCamera();
    for (const Case& c : cases()) {
        const View view = c.plane.view(camera, c.T_c_w);
        const double full = traceOfInverse(photometricInformation(view, camera));
        for (int stride : {2, 4}) {
            PhotometricOptions options;
            options.stride = stride;
            const double strided = traceOfInverse(photometricInformation(view, camera, options));
            EXPECT_NEAR(strided / full, 1., 0.12) << c.name << " stride " << stride;
        }
    }
}

/// Columns that alternate are blank to central differences, rows that do as well.
TEST(Information, ASquareObservesWhatAlternatesFromPixelToPixel) {
    const Camera camera = makeCamera(40, 30, 1.2);
    for (const bool inRows : {false, true}) {
        View view = randomView(camera, 3);
        view.depth = 2.F;
        for (unsigned v = 0; v < camera.height; ++v) {
            for (unsigned u = 0; u < camera.width; ++u) {
                view.intensity[v][u] = (inRows ? v : u) % 2 == 0 ? 0.3F : 0.7F;
            }
        }
        EXPECT_TRUE(photometricInformation(view, camera).isZero(0.));
        const PhotometricOptions options{.gradient = GradientStencil::square};
        const Matrix6 information = photometricInformation(view, camera, options);
        EXPECT_GT(information(inRows ? 1 : 0, inRows ? 1 : 0), 1e3);
        EXPECT_LT(relative(information, informationByPixels(view, camera, options)), 1e-6);
    }
}

TEST(Information, WhiteFloorHasNoInformation) {
    const Camera camera = defaultCamera();
    View view = cases()[1].plane.view(camera, cases()[1].T_c_w);
    for (float grey : {0.F, 0.3F, 0.7F, 1.F}) {
        view.intensity = grey;
        EXPECT_EQ(photometricInformation(view, camera), Matrix6::Zero());
    }
}

TEST(Information, StripesInformAboutOneAxisOnly) {
    const Camera camera = defaultCamera();
    AnalyticPlane floor;
    floor.stripes = true;
    const Pose T_c_w = lookFrom({0., 0., 2.}, std::numbers::pi / 2.);
    const Matrix6 information = photometricInformation(floor.view(camera, T_c_w), camera);
    // Moving along the stripes (world y, image x) shows nothing; across them (image y) it does.
    EXPECT_LT(information(0, 0), 1e-9 * information(1, 1));
}

// --- Contribution images ------------------------------------------------------------------------

TEST(Contribution, SumsToTheQuadraticForm) {
    const Camera camera = defaultCamera();
    const View view = cases()[1].plane.view(camera, cases()[1].T_c_w);
    std::srand(1);
    for (int stride : {1, 2}) {
        PhotometricOptions options;
        options.scale = 0.7;
        options.stride = stride;
        const Matrix6 information = photometricInformation(view, camera, options);
        for (const Vector6& d : {Vector6(Vector6::Unit(0)), Vector6(Vector6::Random())}) {
            const double sum = contributionImage(view, camera, d, options).getSum();
            EXPECT_NEAR(sum / d.dot(information * d), 1., 1e-5);
        }
    }
}

TEST(Contribution, OverAllDirectionsWeighsRotationsByDepth) {
    const Camera camera = defaultCamera();
    View view = randomView(camera, 8);
    view.depth = 2.F;
    const Matrix6 information = photometricInformation(view, camera);
    const double expected =
        information.diagonal().head<3>().sum() + information.diagonal().tail<3>().sum() / 4.;
    EXPECT_NEAR(contributionImage(view, camera).getSum() / expected, 1., 1e-5);
    view.depth = 0.F;
    EXPECT_EQ(contributionImage(view, camera).getSum(), 0.);
}

}  // namespace
}  // namespace photonav
