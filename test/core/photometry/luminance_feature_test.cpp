// SPDX-License-Identifier: BSD-3-Clause
#include "photometry/luminance_feature.hpp"

#include <gtest/gtest.h>
#include <visp3/core/vpExponentialMap.h>
#include <visp3/vs/vpServo.h>

#include <memory>
#include <numbers>

#include "analytic_plane.hpp"
#include "geometry/se3.hpp"
#include "geometry/visp_bridge.hpp"

namespace photonav {
namespace {

Pose obliquePose() { return lookFrom({0.1, 0.5, 1.5}, std::numbers::pi / 4., -0.7); }

Matrix6 gram(const vpMatrix& L, double weight) { return weight * matrix6FromVisp(L.AtA()); }

TEST(PixelDepthLuminance, InteractionMatrixIsThePhotometricJacobian) {
    const Camera camera = defaultCamera();
    View view = AnalyticPlane{}.view(camera, obliquePose());
    view.depth[40][50] = 0.F;
    PixelDepthLuminance feature;
    feature.buildFrom(view, camera);
    const vpMatrix L = feature.interaction();
    ASSERT_EQ(L.getRows(), 186U * 118U);
    double worst = 0.;
    for (unsigned v = 1; v + 1 < camera.height; ++v) {
        for (unsigned u = 1; u + 1 < camera.width; ++u) {
            const Vector6 J = pixelJacobian(view, camera, u, v);
            const Eigen::Map<const Vector6> row(L[(v - 1) * 186 + u - 1]);
            worst = std::max(worst, (J - row).norm() / std::max(1., J.norm()));
        }
    }
    EXPECT_LT(worst, 1e-13);
}

TEST(PixelDepthLuminance, InformationIsThatOfTheKernel) {
    const Camera camera = defaultCamera();
    for (const Pose& T_c_w : {lookFrom({0.3, -0.2, 2.}, std::numbers::pi / 2., 0.4), obliquePose(),
                              lookFrom({0.3, -0.2, 0.25}, 1.4, 1.)}) {
        AnalyticPlane plane;
        plane.wavelength = 0.4;
        const View view = plane.view(camera, T_c_w);
        PixelDepthLuminance feature;
        feature.buildFrom(view, camera);
        const double sigma = PhotometricOptions{}.sigma;
        const Matrix6 reference = gram(feature.interaction(), 1. / (sigma * sigma));
        const Matrix6 kernel = photometricInformation(view, camera);
        EXPECT_LT((kernel - reference).norm(), 1e-6 * reference.norm());
        EXPECT_NEAR(kernel.inverse().trace() / reference.inverse().trace(), 1., 1e-6);
    }
}

/// Why per-pixel depth: with one for the image, information about translation is wrong by a factor
/// (ViSP's default of 1 m) or in shape (the mean depth), while that about rotation does not notice.
TEST(PixelDepthLuminance, OneDepthForTheImageIsFarOffOnAnObliqueView) {
    const Camera camera = defaultCamera();
    AnalyticPlane plane;
    plane.wavelength = 0.7;
    const View view = plane.view(camera, lookFrom({0., 0., 1.}, 35. * std::numbers::pi / 180.));
    const auto information = [&](const View& seen) {
        PixelDepthLuminance feature;
        feature.buildFrom(seen, camera);
        return gram(feature.interaction(), 1.);
    };
    const Matrix6 truth = information(view);
    const Eigen::Matrix3d translation = truth.topLeftCorner<3, 3>();
    View flat = view;
    flat.depth = 1.F;
    const Eigen::Matrix3d atOneMetre = information(flat).topLeftCorner<3, 3>();
    EXPECT_GT(atOneMetre.trace(), 7. * translation.trace());

    flat.depth = static_cast<float>(view.depth.getSum() / view.depth.getSize());
    const Matrix6 atMean = information(flat);
    const Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::Matrix3d> ratios(
        translation, atMean.topLeftCorner<3, 3>());
    EXPECT_GT(ratios.eigenvalues()[2], 3.5 * ratios.eigenvalues()[0]);

    const Eigen::Matrix3d rotation = truth.bottomRightCorner<3, 3>();
    const Eigen::Matrix3d meanRotation = atMean.bottomRightCorner<3, 3>();
    EXPECT_LT((rotation - meanRotation).norm(), 1e-9 * rotation.norm());
}

TEST(PixelDepthLuminance, ErrorAndCopies) {
    const Camera camera = makeCamera(20, 15, 1.);
    const AnalyticPlane plane;
    const View here = plane.view(camera, obliquePose());
    const View there = plane.view(camera, expSE3(0.05 * Vector6::Ones()) * obliquePose());
    PixelDepthLuminance s;
    PixelDepthLuminance desired;
    s.buildFrom(here, camera);
    desired.buildFrom(there, camera);
    const vpColVector e = s.error(desired);
    ASSERT_EQ(e.getRows(), 18U * 13U);
    EXPECT_NEAR(e[18 * 4 + 6], here.intensity[5][7] - there.intensity[5][7], 1e-15);

    const std::unique_ptr<PixelDepthLuminance> copy(s.duplicate());
    EXPECT_EQ(copy->error(desired).sumSquare(), e.sumSquare());
    EXPECT_EQ((copy->interaction() - s.interaction()).sumSquare(), 0.);
    s.buildFrom(there, camera);
    EXPECT_EQ(s.error(desired).sumSquare(), 0.);
    EXPECT_GT(copy->error(desired).sumSquare(), 0.);
}

TEST(PixelDepthLuminance, ServoesACameraToTheDesiredView) {
    const Camera camera = makeCamera(60, 40, 1.);
    AnalyticPlane plane;
    plane.wavelength = 1.5;
    const Pose goal = obliquePose();
    Vector6 offset;
    offset << 0.05, -0.04, 0.06, 0.03, -0.02, 0.05;
    vpHomogeneousMatrix cMw = toVisp(Pose(expSE3(offset) * goal));

    PixelDepthLuminance s;
    PixelDepthLuminance desired;
    desired.buildFrom(plane.view(camera, goal), camera);
    s.buildFrom(plane.view(camera, fromVisp(cMw)), camera);
    vpServo servo;
    servo.setServo(vpServo::EYEINHAND_CAMERA);
    servo.setInteractionMatrixType(vpServo::CURRENT);
    servo.setLambda(0.5);
    servo.addFeature(s, desired);
    for (int i = 0; i < 30; ++i) {
        s.buildFrom(plane.view(camera, fromVisp(cMw)), camera);
        const vpColVector v = servo.computeControlLaw();
        cMw = vpExponentialMap::direct(v).inverse() * cMw;
    }
    EXPECT_LT(logSE3(fromVisp(cMw) * goal.inverse()).norm(), 1e-5);
}

}  // namespace
}  // namespace photonav
