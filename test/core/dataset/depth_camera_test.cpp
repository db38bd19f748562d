// SPDX-License-Identifier: BSD-3-Clause
#include "dataset/depth_camera.hpp"

#include <gtest/gtest.h>

#include <numbers>

#include "geometry/se3.hpp"
#include "render/mesh_renderer.hpp"

namespace photonav {
namespace {

/// A wall at x = 4, a crate of a metre before it.
const MeshRenderer& crateBeforeWall() {
    static const MeshRenderer renderer([] {
        Scene scene;
        const auto grey = addTexture(scene, uniformTexture(0.5));
        addPlane(scene, {4., 10., -10.}, {0., -20., 0.}, {0., 0., 20.}, grey);
        addBox(scene, {2., -0.5, -0.5}, {3., 0.5, 0.5}, grey);
        return scene;
    }());
    return renderer;
}

Pose ahead() { return cameraMount(0.).inverse(); }

DepthCamera beside(const Eigen::Vector3d& position, double turn) {
    DepthCamera depth{makeCamera(160, 120, 1.1)};
    depth.T_c_d.translation() = position;
    depth.T_c_d.linear() =
        Eigen::AngleAxisd(turn, Eigen::Vector3d(1., 2., 1.).normalized()).toRotationMatrix();
    return depth;
}

ImageF depthSeenBy(const Camera& camera, const Pose& T_c_w) {
    View view;
    crateBeforeWall().render(camera, T_c_w, view);
    return view.depth;
}

TEST(RegisteredDepth, IsWhatTheColourCameraWouldMeasure) {
    const Camera colour = makeCamera(140, 100, 1.);
    const DepthCamera depth = beside({0.04, -0.01, 0.02}, 0.02);
    const ImageF seen =
        registeredDepth(depthSeenBy(depth.camera, depth.T_c_d.inverse() * ahead()), depth, colour);
    const ImageF truth = depthSeenBy(colour, ahead());
    unsigned measured = 0, wrong = 0;
    for (unsigned i = 0; i < truth.getSize(); ++i) {
        if (!(seen.bitmap[i] > 0.F)) continue;
        ++measured;
        if (std::abs(seen.bitmap[i] - truth.bitmap[i]) > 1e-3F * truth.bitmap[i]) ++wrong;
    }
    // Missing: a shadow of the crate, and the pixels of its outline.
    EXPECT_GT(measured, 0.9 * truth.getSize());
    EXPECT_LT(wrong, 0.01 * measured);
}

TEST(RegisteredDepth, OfTheSameCameraAtTheSamePlaceIsItself) {
    const DepthCamera depth{makeCamera(160, 120, 1.1)};
    const ImageF measured = depthSeenBy(depth.camera, ahead());
    const ImageF seen = registeredDepth(measured, depth, depth.camera);
    for (unsigned v = 1; v + 1 < 120; ++v) {
        for (unsigned u = 1; u + 1 < 160; ++u) {
            if (seen[v][u] > 0.F) {
                EXPECT_NEAR(seen[v][u], measured[v][u], 1e-4);
            }
        }
    }
    EXPECT_GT(seen[60][80], 0.F);
}

TEST(RegisteredDepth, TheNearerSurfaceHidesTheFartherOne) {
    // From the side the depth camera sees the wall behind the crate.
    const Camera colour = makeCamera(160, 120, 1.);
    const DepthCamera depth = beside({0.6, 0., 0.}, 0.);
    const ImageF seen =
        registeredDepth(depthSeenBy(depth.camera, depth.T_c_d.inverse() * ahead()), depth, colour);
    EXPECT_NEAR(seen[60][90], 2., 1e-3);
    EXPECT_NEAR(seen[60][150], 4., 1e-3);
}

TEST(RegisteredDepth, NothingIsMeasuredAcrossDepthEdgesAndWhereNothingWas) {
    const DepthCamera depth{makeCamera(8, 6, 1.)};
    ImageF measured(6, 8, 1.F);
    measured[2][3] = 0.F;
    for (unsigned v = 0; v < 6; ++v) measured[v][7] = 2.F;
    const ImageF seen = registeredDepth(measured, depth, depth.camera);
    EXPECT_EQ(seen[2][3], 0.F);
    EXPECT_EQ(seen[3][7], 0.F);
    EXPECT_NEAR(seen[4][1], 1., 1e-6);
}

TEST(RegisteredDepth, WantsTheSizeOfTheDepthCamera) {
    const DepthCamera depth{makeCamera(8, 6, 1.)};
    EXPECT_THROW(registeredDepth(ImageF(6, 9, 1.F), depth, depth.camera), std::invalid_argument);
}

}  // namespace
}  // namespace photonav
