// SPDX-License-Identifier: BSD-3-Clause
#include "geometry/camera.hpp"

#include <gtest/gtest.h>

#include <numbers>

namespace photonav {
namespace {

constexpr double kPi = std::numbers::pi;

TEST(Camera, FieldOfViewReachesTheOuterEdgesOfThePixels) {
    const Camera camera = makeCamera(188, 120, 70. * kPi / 180.);
    const double left = (-0.5 - camera.cx()) / camera.fx();
    const double right = (187.5 - camera.cx()) / camera.fx();
    EXPECT_NEAR(std::atan(right) - std::atan(left), 70. * kPi / 180., 1e-12);
    EXPECT_DOUBLE_EQ(camera.fx(), camera.fy());
    // The footprint at 2 m that the paper's scenes are designed for.
    EXPECT_NEAR(2. * (right - left), 2.80, 0.005);
    EXPECT_NEAR(2. * 120. / camera.fy(), 1.79, 0.005);
}

TEST(Camera, ScalingKeepsTheFieldOfViewAndTheRayOfAnImagePoint) {
    const Camera camera = makeCamera(188, 120, 1.2);
    const Camera half = scaled(camera, 0.5);
    EXPECT_EQ(half.width, 94U);
    EXPECT_EQ(half.height, 60U);
    // The corner between four pixels that are merged is the merged pixel's centre.
    EXPECT_NEAR((10.5 - camera.cx()) / camera.fx(), (5. - half.cx()) / half.fx(), 1e-12);
    EXPECT_NEAR((20.5 - camera.cy()) / camera.fy(), (10. - half.cy()) / half.fy(), 1e-12);
}

TEST(Camera, ImpossibleCamerasAreRefused) {
    EXPECT_THROW(makeCamera(0, 120, 1.), std::invalid_argument);
    EXPECT_THROW(makeCamera(188, 120, 0.), std::invalid_argument);
    EXPECT_THROW(makeCamera(188, 120, kPi), std::invalid_argument);
    EXPECT_THROW(makeCamera(188, 120, std::nan("")), std::invalid_argument);
}

TEST(CameraMount, LooksForwardObliqueAndDown) {
    for (const double angle : {0., kPi / 4., kPi / 2.}) {
        const Pose T_b_c = cameraMount(angle);
        EXPECT_TRUE((T_b_c.linear().transpose() * T_b_c.linear()).isIdentity(1e-12));
        EXPECT_NEAR(T_b_c.linear().determinant(), 1., 1e-12);
        const Eigen::Vector3d axis = T_b_c.linear().col(2);
        EXPECT_NEAR(axis.x(), std::cos(angle), 1e-12);
        EXPECT_NEAR(axis.z(), -std::sin(angle), 1e-12);
        EXPECT_TRUE(T_b_c.linear().col(0).isApprox(-Eigen::Vector3d::UnitY()));
    }
    // Looking down, the top of the image is towards the body's front.
    EXPECT_TRUE(cameraMount(kPi / 2.).linear().col(1).isApprox(-Eigen::Vector3d::UnitX()));
}

TEST(Camera, PointsOfPixelsAreProjectedToTheSamePixels) {
    const Camera camera{188, 120, vpCameraParameters(150., 140., 92., 61.)};
    for (const double z : {0.3, 1., 7.}) {
        const Eigen::Vector3d p = camera.unproject(17.25, 103., z);
        EXPECT_EQ(p.z(), z);
        EXPECT_TRUE(camera.project(p).isApprox(Eigen::Vector2d(17.25, 103.), 1e-12));
    }
    EXPECT_EQ(camera.unproject(92., 61.), Eigen::Vector3d::UnitZ());
    EXPECT_TRUE(camera.project({0.2, -0.1, 2.}).isApprox(Eigen::Vector2d(107., 54.), 1e-12));
}

TEST(Camera, JacobianOfTheProjectionIsItsDifferenceQuotient) {
    const Camera camera{188, 120, vpCameraParameters(150., 140., 92., 61.)};
    const Eigen::Vector3d p(0.4, -0.3, 1.7);
    const auto J = camera.projectionJacobian(p);
    for (int i = 0; i < 3; ++i) {
        const Eigen::Vector3d step = 1e-6 * Eigen::Vector3d::Unit(i);
        const Eigen::Vector2d numeric =
            (camera.project(p + step) - camera.project(p - step)) / 2e-6;
        EXPECT_LT((J.col(i) - numeric).norm(), 1e-6 * 150.) << i;
    }
}

}  // namespace
}  // namespace photonav
