// SPDX-License-Identifier: BSD-3-Clause
#include "estimation/map_errors.hpp"

#include <gtest/gtest.h>

#include <random>

#include "geometry/gaussian.hpp"
#include "geometry/se3.hpp"
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
        alignment.T_c_w = poseAt(x);
        return errors.align(relation, {poseAt(x), covariance}, alignment).covariance;
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
    EXPECT_FALSE(elsewhere.isMapped);
    EXPECT_EQ(elsewhere.relative, covariance);
}

/// The errors of a camera that hovers where it has mapped its first keyframe. It measures its
/// rotation by other means as well.
class HoverAtAKeyframe : public OwnMapErrors {
  protected:
    void begin(const Matrix6& covariance) {
        errors = MapErrors{kResolution};
        covariance_ = covariance;
        xi_ = draw(rootOf(covariance), random_);
        displaced_ = xi_ + draw(rootOf(noise_), random_);
        addKeyframe(0., covariance);
    }
    void hover() {
        errors.propagate(Pose::Identity());
        covariance_ += motion_ * Matrix6::Identity();
        xi_ += std::sqrt(motion_) * draw(Matrix6::Identity(), random_);
    }
    void measureRotation() {
        Matrix6 information = Matrix6::Zero();
        information.bottomRightCorner<3, 3>().diagonal().setConstant(1e6);
        Vector6 measured = xi_;
        measured.tail<3>() += 1e-3 * draw(Matrix6::Identity(), random_).tail<3>();
        errors.observe(covariance_, information);
        covariance_ = updateCovariance(covariance_, information);
        xi_ -= covariance_ * information * measured;
    }
    void align() {
        const UncertainPose before{poseAt(0.), covariance_};
        const auto relation = errors.relate(view_, camera, before);
        Alignment alignment;
        alignment.information = noise_.inverse();
        alignment.covariance = updateCovariance(relation.relative, alignment.information);
        const Vector6 measured = xi_ - displaced_ + draw(rootOf(noise_), random_);
        const Vector6 moved = alignment.covariance * alignment.information * measured;
        alignment.T_c_w = expSE3(moved) * before.mean;
        const UncertainPose after = errors.align(relation, before, alignment);
        xi_ -= deviation(after.mean, before.mean);
        covariance_ = after.covariance;
    }
    double nees() const { return xi_.dot(covariance_.ldlt().solve(xi_)) / 6.; }

    std::mt19937_64 random_{1};
    View view_ = viewAt(0.);
    const Matrix6 noise_ =
        Vector6{{4e-6, 9e-6, 4e-6, 1e-6, 1e-6, 1e-6}}.asDiagonal();  // of an image
    double motion_ = 1e-5;                                           // variance between two images
    Matrix6 covariance_;
    Vector6 xi_;         // error of the pose
    Vector6 displaced_;  // the keyframe's image: by the error of its pose, and by its noise
};

/// With odometry that is worse than the images, and with one that is far better.
TEST_F(HoverAtAKeyframe, ItsBeliefIsConsistent) {
    for (const double motion : {1e-5, 1e-7}) {
        motion_ = motion;
        double sum = 0.;
        constexpr int kFlights = 200;
        for (int i = 0; i < kFlights; ++i) {
            begin(1e-5 * Matrix6::Identity());
            for (int k = 0; k < 20; ++k) {
                hover();
                if (k % 4 == 0) measureRotation();
                align();
            }
            sum += nees() / kFlights;
        }
        EXPECT_NEAR(sum, 1., 0.15) << "variance of the motion " << motion;
    }
}

TEST_F(HoverAtAKeyframe, AMapThatIsTurnedDoesNotTurnACameraThatKnowsBetter) {
    begin(Vector6{{1e-5, 1e-5, 1e-5, 1e-4, 1e-4, 1e-4}}.asDiagonal());
    xi_ << 0., 0., 0., 0.02, 0., 0.;
    displaced_ = xi_;
    for (int k = 0; k < 20; ++k) {
        hover();
        measureRotation();
        align();
        EXPECT_LT(xi_.tail<3>().norm(), 5e-3) << k;
    }
    EXPECT_LT((covariance_.bottomRightCorner<3, 3>().trace()), 3. * 1e-6);
}

/// Back at a start that is known to millimetres, after a long way: its pose is that of the image.
TEST_F(HoverAtAKeyframe, ALongWayIsForgottenWhereTheStartIsSeenAgain) {
    begin(1e-6 * Matrix6::Identity());
    align();  // for the noise of the keyframe's image
    errors.propagate(Pose::Identity());
    const UncertainPose lost{poseAt(0.), 0.5 * Matrix6::Identity()};
    const auto relation = errors.relate(view_, camera, lost);
    Vector6 moved;
    moved << 0.3, 0., 0.1, 0., 0.02, 0.;
    Alignment alignment;
    alignment.information = noise_.inverse();
    alignment.covariance = updateCovariance(relation.relative, alignment.information);
    alignment.T_c_w = expSE3(moved) * lost.mean;
    const UncertainPose found = errors.align(relation, lost, alignment);
    EXPECT_LT(deviation(found.mean, alignment.T_c_w).norm(), 1e-4);
    // Of the start, of its image, and of this one.
    const Matrix6 expected = 1e-6 * Matrix6::Identity() + 2. * noise_;
    EXPECT_NEAR(found.covariance.trace(), expected.trace(), 0.05 * expected.trace());
}

/// A keyframe that is added after an alignment has the noise of this image; the next one, whose
/// image is not aligned, too.
TEST_F(HoverAtAKeyframe, KeyframesHaveTheNoiseOfTheirImages) {
    begin(1e-6 * Matrix6::Identity());
    align();
    for (const double x : {8., -8.}) {
        errors.propagate(Pose::Identity());
        addKeyframe(x, 1e-4 * Matrix6::Identity());
        const UncertainPose far{poseAt(x), 1e-2 * Matrix6::Identity()};
        const Matrix6 expected = 1e-4 * Matrix6::Identity() + noise_;
        EXPECT_LT((errors.relate(viewAt(x), camera, far).ofMap - expected).norm(),
                  0.02 * noise_.norm());
    }
}

/// An image that does not inform, seen after a keyframe, must not hide that the pose has the error
/// of this keyframe.
TEST_F(HoverAtAKeyframe, AnImageThatDoesNotInformChangesNothing) {
    begin(1e-6 * Matrix6::Identity());
    const UncertainPose there{poseAt(0.), 1e-2 * Matrix6::Identity()};
    addKeyframe(8., there.covariance);
    Alignment open;
    open.T_c_w = there.mean;
    open.covariance = there.covariance;
    open.information = noise_.inverse();
    open.openDirections.assign(kTwistAxes.begin(), kTwistAxes.end());
    const auto before = errors.relate(view_, camera, there);
    const UncertainPose after = errors.align(before, there, open);
    EXPECT_EQ(after.covariance, there.covariance);
    EXPECT_EQ(errors.relate(view_, camera, there).relative, before.relative);
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
        EXPECT_TRUE(relation.isMapped) << "layer " << layer;
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
