// SPDX-License-Identifier: BSD-3-Clause
#include "alignment/hole_margin.hpp"

#include <gtest/gtest.h>

#include "alignment/dense_aligner.hpp"
#include "tracking/rooms.hpp"

namespace photonav {
namespace {

using test::kDown;

TEST(HoleMargin, IsABoxAroundEveryHole) {
    View view{ImageF(7, 9, 0.5F), ImageF(7, 9, 2.F)};
    view.depth[3][4] = 0.F;
    view.depth[0][8] = 0.F;
    widenHoles(view, {.columns = 2, .rows = 1});
    for (int v = 0; v < 7; ++v) {
        for (int u = 0; u < 9; ++u) {
            const bool isHole =
                (std::abs(v - 3) <= 1 && std::abs(u - 4) <= 2) || (v <= 1 && u >= 6);
            EXPECT_EQ(view.depth[v][u], isHole ? 0.F : 2.F) << v << ", " << u;
        }
    }
}

TEST(HoleMargin, IsAsWideAsThePoseIsUncertain) {
    const Camera camera = makeCamera(188, 120, 1.2);
    Matrix6 covariance = Matrix6::Zero();
    EXPECT_EQ(holeMargin(covariance, camera, 2.).columns, 0);
    const double pixel = 2. / camera.fx();  // [m]
    covariance(0, 0) = pixel * pixel;
    EXPECT_NEAR(holeMargin(covariance, camera, 2.).columns, 3, 1);
    EXPECT_EQ(holeMargin(covariance, camera, 2.).rows, 0);
    covariance(0, 0) = 100.;
    EXPECT_LE(holeMargin(covariance, camera, 2.).columns, 6);
}

/// A joint in a white floor is black in the image and unknown to the map. Where exactly it is in
/// view is not known either: the image agrees with the map.
TEST(HoleMargin, AJointThatIsNotWhereItWasThoughtIsNoContradiction) {
    Scene scene;
    const auto white = addTexture(scene, uniformTexture(0.9F));
    addPlane(scene, {-10., -10., 0.}, {10.5, 0., 0.}, {0., 20., 0.}, white);
    addPlane(scene, {0.56, -10., 0.}, {10., 0., 0.}, {0., 20., 0.}, white);
    const MeshRenderer floor(scene);
    const Camera camera = makeCamera(188, 120, 1.2);
    View seen;
    floor.render(camera, lookFrom({0.05, 0., 2.}, kDown), seen);
    std::mt19937_64 random{1};
    const ImageF image = test::noisy(seen.intensity, 0.02, random);
    AlignmentOptions options;
    options.photometric = {.sigma = 0.02, .scale = 0.08};
    DenseAligner aligner(floor, camera, options);
    UncertainPose prior{lookFrom({0., 0., 2.}, kDown), 1e-8 * Matrix6::Identity()};
    EXPECT_TRUE(isLost(aligner.align(image, prior).verdict)) << "too easy";
    prior.covariance.topLeftCorner<3, 3>() = 0.03 * 0.03 * Eigen::Matrix3d::Identity();
    const Alignment a = aligner.align(image, prior);
    EXPECT_EQ(a.verdict, Verdict::degenerate) << describe(a);
    EXPECT_TRUE(isUninformative(a));
}

}  // namespace
}  // namespace photonav
