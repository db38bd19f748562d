// SPDX-License-Identifier: BSD-3-Clause
#include "alignment/wide_aligner.hpp"

#include <gtest/gtest.h>

#include "alignment/search_grid.hpp"
#include "geometry/gaussian.hpp"
#include "map/map_fusion.hpp"
#include "render/voxel_renderer.hpp"
#include "tracking/rooms.hpp"

namespace photonav {
namespace {

using test::kDown;

class WideAlignerTest : public ::testing::Test {
  protected:
    ImageF seen(const ViewSource& world, const Pose& T_c_w) {
        View view;
        world.render(camera, T_c_w, view);
        return test::noisy(view.intensity, 0.02, random);
    }
    static UncertainPose prior(const Pose& T_c_w, double sigma) {
        UncertainPose belief{T_c_w, 1e-5 * Matrix6::Identity()};
        belief.covariance.topLeftCorner<3, 3>() = sigma * sigma * Eigen::Matrix3d::Identity();
        return belief;
    }
    static void expectUndecided(const Alignment& a, const UncertainPose& prior) {
        EXPECT_EQ(a.verdict, Verdict::degenerate);
        EXPECT_EQ(a.covariance, prior.covariance);
        EXPECT_EQ(a.T_c_w.matrix(), prior.mean.matrix());
    }

    Camera camera = makeCamera(94, 60, 1.2);
    AlignmentOptions options = [] {
        AlignmentOptions o;
        o.photometric = {.sigma = 0.02, .scale = 0.08};
        return o;
    }();
    std::mt19937_64 random{1};
};

TEST_F(WideAlignerTest, FindsThePlaceFromAfar) {
    const MeshRenderer floor(test::floorOf(valueNoise({.size = {20., 20.}, .seed = 3})));
    WideAligner wide(floor, camera, options);
    DenseAligner dense(floor, camera, options);
    const Pose truth = lookFrom({0.9, -0.8, 2.1}, kDown);
    const UncertainPose belief = prior(lookFrom({0., 0., 2.}, kDown), 0.45);
    const ImageF image = seen(floor, truth);
    const auto errorOf = [&](const Alignment& a) {
        return logSE3(a.T_c_w * truth.inverse()).head<3>().norm();
    };
    EXPECT_GT(errorOf(dense.align(image, belief)), 0.1) << "too easy";
    const Alignment a = wide.align(image, belief);
    EXPECT_EQ(a.verdict, Verdict::converged);
    EXPECT_LT(errorOf(a), 0.01);
}

TEST_F(WideAlignerTest, FindsThePlaceInAnotherExposure) {
    options.exposure = {.gainSigma = 0.15, .offsetSigma = 0.01};
    const MeshRenderer floor(test::floorOf(valueNoise({.size = {20., 20.}, .seed = 3})));
    WideAligner wide(floor, camera, options);
    const Pose truth = lookFrom({0.9, -0.8, 2.1}, kDown);
    ImageF image = seen(floor, truth);
    for (unsigned i = 0; i < image.getSize(); ++i) image.bitmap[i] *= 0.65F;
    const Alignment a = wide.align(image, prior(lookFrom({0., 0., 2.}, kDown), 0.45));
    EXPECT_EQ(a.verdict, Verdict::converged) << describe(a);
    EXPECT_LT(logSE3(a.T_c_w * truth.inverse()).head<3>().norm(), 0.02);
    EXPECT_NEAR(a.exposure.gain, 0.65, 0.02);
}

/// The border of white and texture is just in view where the camera is thought to be, and not
/// where it is. That is no measurement of the border: it moves out of view, and no more is known.
TEST_F(WideAlignerTest, NothingInViewIsNoMatch) {
    Scene scene;
    addPlane(scene, {-10., -10., 0.}, {10., 0., 0.}, {0., 20., 0.},
             addTexture(scene, uniformTexture(0.5F)));
    addPlane(
        scene, {0., -10., 0.}, {10., 0., 0.}, {0., 20., 0.},
        addTexture(scene,
                   valueNoise({.size = {10., 20.}, .amplitudes = {0.03, 0.02, 0.01}, .seed = 3})));
    const MeshRenderer floor(scene);
    WideAligner wide(floor, camera, options);
    const ImageF image = seen(floor, lookFrom({-1.2, 0., 2.}, kDown));
    for (double x = -0.9; x < -0.6; x += 0.03) {
        const UncertainPose belief = prior(lookFrom({x, 0., 2.}, kDown), 0.3);
        const Alignment a = wide.align(image, belief);
        EXPECT_EQ(a.verdict, Verdict::degenerate);
        EXPECT_TRUE(a.covariance.isApprox(belief.covariance, 0.1)) << x;
    }
}

/// Some columns of texture beside white: coarse views of them are white, and lead all starts to one
/// place.
TEST_F(WideAlignerTest, AStripOfTextureIsFoundWhereItIs) {
    const Texture noise = valueNoise({.size = {20., 20.}, .amplitudes = {0.2, 0.14, 0.08}});
    const Patch half{{10., 0.}, {20., 20.}, &noise};
    const MeshRenderer floor(
        test::floorOf(patchedTexture(uniformTexture(0.9F), {half}, {20., 20.})));
    camera = makeCamera(188, 120, 1.2);
    WideAligner wide(floor, camera, options);
    UncertainPose belief = prior(lookFrom({-1.3, 0., 2.}, kDown, kDown), 0.34);  // x to the right
    belief.covariance(2, 2) = 0.2 * 0.2;
    belief.covariance(5, 5) = 0.02 * 0.02;
    const Matrix6 root = rootOf(belief.covariance);
    int shown = 0;  // enough of it: two columns may well be found in two places
    int found = 0;
    int wrong = 0;
    for (int flown = 0; flown < 60;) {
        const Pose truth = expSE3(draw(root, random)) * belief.mean;
        const Eigen::Vector3d p = truth.inverse().translation();
        const double strip = p.x() + 0.5 * camera.width / camera.fx() * p.z();  // in view [m]
        if (strip < 0.03 || strip > 0.3) continue;
        ++flown;
        shown += strip > 0.15;
        const Alignment a = wide.align(seen(floor, truth), belief);
        if (isLost(a.verdict) || a.covariance == belief.covariance) continue;
        found += strip > 0.15;
        if (squaredDistance(logSE3(truth * a.T_c_w.inverse()), a.covariance) > 60.) ++wrong;
    }
    EXPECT_GE(found, 0.8 * shown);
    EXPECT_EQ(wrong, 0);
}

/// What a strip must show to be believed is a property of the scene, not of how many pixels it is
/// seen with.
TEST_F(WideAlignerTest, AFaintStripIsAcceptedAtNoImageSize) {
    const Texture faint = valueNoise({.size = {20., 20.}, .amplitudes = {0.06, 0.04, 0.02}});
    const Patch half{{10., 0.}, {20., 20.}, &faint};
    const MeshRenderer floor(
        test::floorOf(patchedTexture(uniformTexture(0.5F), {half}, {20., 20.})));
    const Pose truth = lookFrom({-1.1, 0., 2.}, kDown, kDown);  // x to the right
    for (const unsigned times : {1U, 2U, 3U}) {
        camera = makeCamera(94 * times, 60 * times, 1.2);
        WideAligner wide(floor, camera, options);
        const UncertainPose belief = prior(lookFrom({-1.3, 0., 2.}, kDown, kDown), 0.3);
        const Alignment a = wide.align(seen(floor, truth), belief);
        std::cout << times << ": " << describe(a) << " " << a.residual.explained << "\n";
        EXPECT_EQ(a.verdict, Verdict::degenerate) << camera.width;
        EXPECT_EQ(a.covariance, belief.covariance) << camera.width;
    }
}

/// A strip of so little contrast is not believed. All over the image it is.
TEST_F(WideAlignerTest, PaleTextureIsFound) {
    const MeshRenderer floor(test::floorOf(
        valueNoise({.size = {20., 20.}, .amplitudes = {0.004, 0.003, 0.002}, .seed = 1})));
    camera = makeCamera(188, 120, 1.2);
    WideAligner wide(floor, camera, options);
    const UncertainPose belief = prior(lookFrom({0., 0., 1.6}, kDown), 0.1);
    const Pose truth = lookFrom({0.11, -0.07, 1.63}, kDown);
    const Alignment a = wide.align(seen(floor, truth), belief);
    EXPECT_FALSE(isLost(a.verdict)) << describe(a);
    EXPECT_LT(a.covariance.trace(), 0.5 * belief.covariance.trace());
    EXPECT_LT(squaredDistance(logSE3(truth * a.T_c_w.inverse()), a.covariance), 25.);
}

TEST_F(WideAlignerTest, StripesAreAmbiguous) {
    const MeshRenderer floor(test::floorOf(stripes({.width = 0.2, .softEdge = 0.05})));
    WideAligner wide(floor, camera, options);
    const UncertainPose belief = prior(lookFrom({0.05, 0., 2.}, kDown), 0.3);
    expectUndecided(wide.align(seen(floor, lookFrom({0.15, 0., 2.}, kDown)), belief), belief);
}

constexpr double kCell = 0.05;

/// Cells of 5 cm show nothing of texture that is finer.
class FineTexture : public WideAlignerTest {
  protected:
    FineTexture() { camera = makeCamera(188, 120, 1.2); }

    static MeshRenderer floorOf(double coarse, double fine, unsigned seed) {
        return MeshRenderer(test::floorOf(valueNoise({.size = {20., 20.},
                                                      .cells = {0.4, 0.2, 0.03},
                                                      .amplitudes = {coarse, 0.8 * coarse, fine},
                                                      .seed = seed})));
    }
    VoxelRenderer mapOf(const MeshRenderer& floor) const {
        TexturedOcTree map(kCell);
        for (int i = 0; i < 25; ++i) {
            const Pose T_c_w = lookFrom({0.4 * (i % 5 - 2), 0.4 * (i / 5 - 2), 1.5}, kDown);
            View view;
            floor.render(camera, T_c_w, view);
            fuse(map, view, camera, T_c_w);
        }
        return VoxelRenderer(map, UnknownPolicy::free);
    }

    Pose truth = lookFrom({0.25, -0.2, 1.55}, kDown);
};

/// The rest of it is enough to find the place, and does not make another floor the right one.
TEST_F(FineTexture, DoesNotContradictTheMapInASearch) {
    const MeshRenderer floor = floorOf(0.1, 0.15, 3), another = floorOf(0.1, 0.15, 4);
    const VoxelRenderer cells = mapOf(floor);
    const UncertainPose belief = prior(lookFrom({0., 0., 1.5}, kDown), 0.2);
    const auto find = [&](const ViewSource& world) {
        return WideAligner(cells, camera, options).align(seen(world, truth), belief);
    };
    EXPECT_NE(find(floor).verdict, Verdict::converged) << "nothing finer";
    options.cellSize = kCell;
    const Alignment a = find(floor);
    EXPECT_EQ(a.verdict, Verdict::converged) << describe(a);
    EXPECT_LT(test::errorOf(a, truth).head<3>().norm(), 0.02);
    EXPECT_NE(find(another).verdict, Verdict::converged) << describe(find(another));
}

/// The texture of cells is blurred itself, whatever the sharpness of the images.
TEST_F(FineTexture, OfCellsIsComparedWithImagesAsTheyAre) {
    const MeshRenderer floor = floorOf(0.1, 0.15, 3);
    const VoxelRenderer cells = mapOf(floor);
    const UncertainPose belief = prior(lookFrom({0.27, -0.19, 1.54}, kDown), 0.02);
    const ImageF image = seen(floor, truth);
    const auto poseBy = [&](double blur) {
        options.blur = blur;
        return DenseAligner(cells, camera, options).align(image, belief).T_c_w;
    };
    EXPECT_NE(poseBy(kAreaBlur).matrix(), poseBy(kRenderedBlur).matrix());
    options.cellSize = kCell;
    EXPECT_EQ(poseBy(kAreaBlur).matrix(), poseBy(kRenderedBlur).matrix());
}

TEST_F(FineTexture, DoesNotContradictTheMapNearThePose) {
    const MeshRenderer floor = floorOf(0.03, 0.3, 3), another = floorOf(0.03, 0.3, 4);
    const VoxelRenderer cells = mapOf(floor);
    const UncertainPose belief = prior(lookFrom({0.27, -0.19, 1.54}, kDown), 0.02);
    const auto align = [&](const ViewSource& world) {
        return DenseAligner(cells, camera, options).align(seen(world, truth), belief);
    };
    EXPECT_EQ(align(floor).verdict, Verdict::lostResidual) << "nothing finer";
    options.cellSize = kCell;
    const Alignment a = align(floor);
    EXPECT_FALSE(isLost(a.verdict)) << describe(a);
    EXPECT_LT(test::errorOf(a, truth).head<3>().norm(), 0.02);
    EXPECT_TRUE(isLost(align(another).verdict)) << describe(align(another));
}

TEST_F(WideAlignerTest, IsLostWhereNoPlaceExplainsTheImage) {
    const MeshRenderer floor(test::floorOf(valueNoise({.size = {20., 20.}, .seed = 3})));
    const MeshRenderer another(test::floorOf(valueNoise({.size = {20., 20.}, .seed = 4})));
    WideAligner wide(floor, camera, options);
    const Pose here = lookFrom({0., 0., 2.}, kDown);
    EXPECT_TRUE(isLost(wide.align(seen(another, here), prior(here, 0.3)).verdict));
}

/// Contrast below the noise neither confirms a place nor contradicts it, however many pixels there
/// are and whatever the noise is.
TEST_F(WideAlignerTest, LittleContrastDoesNotContradict) {
    for (const double sigma : {0.01, 0.04}) {
        const auto floorOf = [&](unsigned seed) {
            return MeshRenderer(
                test::floorOf(valueNoise({.size = {20., 20.},
                                          .amplitudes = {sigma, 0.7 * sigma, 0.3 * sigma},
                                          .seed = seed})));
        };
        const MeshRenderer floor = floorOf(3), another = floorOf(4);
        options.photometric.sigma = sigma;
        for (const unsigned times : {1U, 2U}) {
            camera = makeCamera(94 * times, 60 * times, 1.2);
            WideAligner wide(floor, camera, options);
            const Pose here = lookFrom({0., 0., 2.}, kDown);
            View view;
            another.render(camera, here, view);
            const UncertainPose belief = prior(here, 0.3);
            const Alignment a = wide.align(test::noisy(view.intensity, sigma, random), belief);
            EXPECT_EQ(a.verdict, Verdict::degenerate) << describe(a);
            EXPECT_EQ(a.covariance, belief.covariance);
        }
    }
}

/// As many views as there may be are compared at the usual distance; wider priors spread them.
TEST(WideAligner, TheSearchIsCoarserWhereThePriorIsTooWide) {
    const Camera camera = makeCamera(188, 120, 1.2217);
    const auto spacing = [&](double sigma) {
        Vector6 variances = Vector6::Constant(1e-8);
        variances.head<2>().setConstant(sigma * sigma);
        return searchSpacing(variances.asDiagonal(), camera, 2.);
    };
    EXPECT_EQ(spacing(0.01), 8.);
    EXPECT_EQ(spacing(0.5), 8.);
    // (6 sigmas / 8 pixels)^2 views are 4000 at sigma = 84.3 pixels, 1.26 m at this depth
    const double metre = camera.fx() / 2.;
    EXPECT_NEAR(spacing(2. * 84.327 / metre), 2. * 8., 1e-3);
    EXPECT_LT(spacing(1.8), kWidestSearchSpacing);
    EXPECT_GT(spacing(2.), kWidestSearchSpacing);
}

/// Whichever number of axes is wide: the search takes as long.
TEST(WideAligner, TheSearchComparesALimitedNumberOfViews) {
    for (int axes = 1; axes <= 6; ++axes) {
        for (const double sigma : {100., 1000., 1e4}) {
            Vector6 sigmas = Vector6::Constant(1e-3);
            sigmas.head(axes).setConstant(sigma);
            EXPECT_LE(placesWithin(sigmas).size(), 4200U) << axes << " axes, " << sigma;
            sigmas[0] = 10.;  // an axis that the coarser grid leaves out
            EXPECT_LE(placesWithin(sigmas).size(), 4200U) << axes << " axes, " << sigma;
        }
    }
    EXPECT_GT(placesWithin(Vector6::Unit(0) * 1e4).size(), 3800U);
}

}  // namespace
}  // namespace photonav
