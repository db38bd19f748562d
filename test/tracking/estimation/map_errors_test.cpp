// SPDX-License-Identifier: BSD-3-Clause
#include "estimation/map_errors.hpp"

#include <gtest/gtest.h>

#include "tracking/rooms.hpp"

namespace photonav {
namespace {

constexpr double kResolution = 0.05;

/// A camera that looks down on a floor of texture, at places along x.
class OwnMapErrors : public ::testing::Test {
  protected:
    View viewAt(double x) const {
        View view;
        floor.render(camera, poseAt(x), view);
        return view;
    }
    static Pose poseAt(double x) { return lookFrom({x, 0., 2.}, test::kDown); }

    void addKeyframe(double x, const Matrix6& covariance) {
        errors.addSurfaces(errors.addPose({poseAt(x), covariance}), viewAt(x).depth, camera);
    }
    /// The bricks of a map around the camera that lie above (0) or below (-1) the floor's plane.
    static std::vector<Eigen::Array3i> layerOfBricks(int z) {
        std::vector<Eigen::Array3i> bricks;
        for (int x = -40; x < 40; ++x) {
            for (int y = -40; y < 40; ++y) bricks.emplace_back(x, y, z);
        }
        return bricks;
    }
    /// The camera moves; its covariance grows as much.
    Matrix6 moved(double from, double to, const Matrix6& covariance, double variance) {
        const Pose motion = poseAt(to) * poseAt(from).inverse();
        errors.propagate(motion);
        return compound({motion, variance * Matrix6::Identity()}, {poseAt(from), covariance},
                        PropagationOrder::second)
            .covariance;
    }
    /// After an image that determines the pose in the map to a millimetre.
    Matrix6 aligned(double x, const Matrix6& covariance) {
        const auto relation = errors.relate(viewAt(x), camera, {poseAt(x), covariance});
        Alignment alignment;
        alignment.information = 1e6 * Matrix6::Identity();
        alignment.covariance = updateCovariance(relation.relative, alignment.information);
        return errors.align(relation, alignment);
    }

    Camera camera = makeCamera(94, 60, 1.2);
    MeshRenderer floor{test::floorOf(valueNoise({.size = {20., 20.}, .seed = 3}))};
    MapErrors errors{kResolution};
};

constexpr double kFirst = 1e-4;  // variance of the first keyframe

TEST_F(OwnMapErrors, NoLookAtTheOwnMapMakesThePoseBetterThanTheMap) {
    const Matrix6 start = kFirst * Matrix6::Identity();
    addKeyframe(0., start);
    Matrix6 covariance = start;
    for (int i = 0; i < 50; ++i) {
        covariance = aligned(0., moved(0., 0., covariance, 1e-5));
        EXPECT_GT(covariance.trace(), 0.99 * start.trace());
        EXPECT_LT(covariance.trace(), 1.2 * start.trace());
    }
}

TEST_F(OwnMapErrors, TheBeliefGrowsOnTheWayOutAndFallsWhereTheStartIsSeenAgain) {
    const Matrix6 start = kFirst * Matrix6::Identity();
    addKeyframe(0., start);
    const Matrix6 out = moved(0., 8., start, 1e-2);
    addKeyframe(8., out);
    const Matrix6 there = aligned(8., moved(8., 8., out, 1e-3));
    EXPECT_GT(there.trace(), 0.99 * out.trace());
    EXPECT_LT(there.trace(), out.trace() + 6. * 2e-4);
    const Matrix6 back = aligned(0., moved(8., 0., there, 1e-2));
    EXPECT_LT(back.trace(), start.trace() + 6. * 1e-4);
    EXPECT_GT(back.trace(), 0.99 * start.trace());
}

/// What is known of the pose in the map in view is far more than what is known of it in the world.
TEST_F(OwnMapErrors, ThePriorOfAnAlignmentIsThatOfThePoseInTheMap) {
    const Matrix6 wide = 1e-2 * Matrix6::Identity();
    addKeyframe(0., wide);
    const Matrix6 covariance = moved(0., 0.1, wide, 1e-4);
    const auto relation = errors.relate(viewAt(0.1), camera, {poseAt(0.1), covariance});
    EXPECT_NEAR(relation.relative.trace(), 6e-4, 1e-4);
    const auto elsewhere = errors.relate(viewAt(8.), camera, {poseAt(8.), covariance});
    EXPECT_EQ(elsewhere.views, 0.);
    EXPECT_EQ(elsewhere.relative, covariance);
}

/// A surface that was removed and is mapped again has the errors of its new image alone. Elsewhere,
/// and until then, errors stay as they were.
TEST_F(OwnMapErrors, RemovedSurfacesHaveTheErrorsOfTheirNextImage) {
    const Matrix6 small = 1e-6 * Matrix6::Identity(), large = 1e-2 * Matrix6::Identity();
    const auto ofMap = [&](double x) {
        return errors.relate(viewAt(x), camera, {poseAt(x), large}).ofMap;
    };
    addKeyframe(0., small);
    addKeyframe(8., small);
    errors.removeSurfaces(viewAt(0.).depth, camera, poseAt(0.));
    EXPECT_LT((ofMap(0.) - small).norm(), 1e-2 * small.norm());
    addKeyframe(0., large);
    addKeyframe(8., large);
    EXPECT_LT((ofMap(0.) - large).norm(), 1e-2 * large.norm());
    EXPECT_LT(ofMap(8.).norm(), 0.6 * large.norm());  // of both keyframes
}

TEST_F(OwnMapErrors, WhatAnImageHardlyInformsOfStaysAsItWas) {
    const UncertainPose prior{poseAt(0.), 1e-4 * Matrix6::Identity()};
    Vector6 moved;
    moved << 2e-3, 5e-3, 0., 0., 0., 0.;
    Alignment alignment;
    alignment.meanDepth = 1.;
    alignment.information = Vector6{{1e6, 5e3, 1e6, 1e6, 1e6, 1e6}}.asDiagonal();
    alignment.covariance = updateCovariance(prior.covariance, alignment.information);
    alignment.T_c_w = expSE3(moved) * prior.mean;
    const Alignment strong = MapErrors::withoutWeak(alignment, prior);
    const Vector6 kept = deviation(strong.T_c_w, prior.mean);
    EXPECT_NEAR(kept[0], 2e-3, 1e-6);
    EXPECT_NEAR(kept[1], 0., 1e-6);
    EXPECT_NEAR(strong.covariance(1, 1), 1e-4, 1e-7);
    EXPECT_NEAR(strong.covariance(0, 0), alignment.covariance(0, 0), 1e-8);
    alignment.information(1, 1) = 1e6;
    EXPECT_EQ(MapErrors::withoutWeak(alignment, prior).T_c_w.matrix(), alignment.T_c_w.matrix());
}

/// The map, made at the pose of before, keeps the errors that the pose has lost.
TEST_F(OwnMapErrors, WhatElseInformsOfThePoseDoesNotCorrectTheMap) {
    const Matrix6 before = 1e-2 * Matrix6::Identity();
    addKeyframe(0., before);
    Matrix6 information = Matrix6::Zero();
    information.diagonal() << 0., 0., 0., 400., 900., 0.;
    errors.observe(before, information);
    const Matrix6 after = updateCovariance(before, information);
    const auto relation = errors.relate(viewAt(0.), camera, {poseAt(0.), after});
    EXPECT_LT((relation.relative - (before - after)).norm(), 1e-3 * before.norm());
    EXPECT_LT((relation.ofMap - before).norm(), 1e-3 * before.norm());
}

TEST_F(OwnMapErrors, ALossIsResolvedToTheErrorsOfTheMapInView) {
    const Matrix6 start = kFirst * Matrix6::Identity();
    addKeyframe(0., start);
    const Matrix6 lost = moved(0., 0.2, start, 1.);
    const auto relation = errors.relate(viewAt(0.2), camera, {poseAt(0.2), lost});
    Alignment alignment;
    alignment.covariance = 1e-6 * Matrix6::Identity();
    const Matrix6 found = errors.relocalize(relation, alignment);
    EXPECT_NEAR(found.trace(), start.trace(), 0.2 * start.trace());
}

/// The error of a map that was known before has nothing to do with that of the start.
TEST_F(OwnMapErrors, AKnownMapNarrowsAPoseToItsOwnError) {
    errors.addMap(poseAt(0.), kFirst * Matrix6::Identity(), layerOfBricks(0));
    const Matrix6 start = 1e-2 * Matrix6::Identity();
    const Matrix6 there = aligned(0., start);
    EXPECT_LT(there.trace(), 1.2 * 6. * kFirst);
    EXPECT_GT(there.trace(), 0.99 * 6. * kFirst);
    addKeyframe(0., there);  // whose error is that of the map
    EXPECT_GT(aligned(0., there).trace(), 0.99 * 6. * kFirst);
    EXPECT_EQ(errors.keyframes(), 2U);
}

/// The floor is the border of two layers of bricks, and may be in either.
TEST_F(OwnMapErrors, ASurfaceOnTheBorderOfTwoBricksHasTheErrorsOfEither) {
    for (const int layer : {-1, 0}) {
        MapErrors known{kResolution};
        known.addMap(poseAt(0.), kFirst * Matrix6::Identity(), layerOfBricks(layer));
        const auto relation = known.relate(viewAt(0.), camera, {poseAt(0.), Matrix6::Identity()});
        EXPECT_EQ(relation.views, 1.) << "layer " << layer;
    }
}

/// The wall in view is before the border; the back of what is behind it is of another keyframe.
TEST_F(OwnMapErrors, ASurfaceBesideABorderHasTheErrorsOfItsOwnBrick) {
    const Matrix6 small = 1e-6 * Matrix6::Identity(), large = 1e-2 * Matrix6::Identity();
    errors.addMap(poseAt(0.), small, layerOfBricks(0));
    errors.addMap(poseAt(0.), large, layerOfBricks(-1));
    View view = viewAt(0.);
    for (unsigned i = 0; i < view.depth.getSize(); ++i) view.depth.bitmap[i] -= 5e-4F;
    const auto relation = errors.relate(view, camera, {poseAt(0.), large});
    EXPECT_LT(relation.ofMap.norm(), 0.1 * large.norm());
}

}  // namespace
}  // namespace photonav
