// SPDX-License-Identifier: BSD-3-Clause
#include "estimation/measured_surfaces.hpp"

#include <gtest/gtest.h>

#include "estimation/tracker.hpp"
#include "tracking/rooms.hpp"

namespace photonav {
namespace {

constexpr DepthAccuracy kAccuracy{.sigmaAtOneMetre = 2e-3, .ofMap = 0.05};

const Camera& smallCamera() {
    static const Camera small = makeCamera(160, 120, 1.1);
    return small;
}

UncertainPose known(const Pose& T_c_w, double sigma) {
    return {T_c_w, sigma * sigma * Matrix6::Identity()};
}

/// A floor that the map shows whole. In truth a large box stands on it, on the right of the image.
class BoxThatIsNotInTheMap : public ::testing::Test {
  protected:
    static Scene floor() {
        return test::floorOf(valueNoise(
            {.size = {20., 20.}, .cells = {0.5, 0.2}, .amplitudes = {0.1, 0.08}, .seed = 4}));
    }
    static Scene withBox() {
        Scene scene = floor();
        addBox(scene, {0.15, -2., 0.}, {2., 2., 0.4},
               addTexture(scene, valueNoise({.size = {2., 2.},
                                             .cells = {0.5, 0.2},
                                             .amplitudes = {0.2, 0.1},
                                             .seed = 7})));
        return scene;
    }
    BoxThatIsNotInTheMap() { map->render(smallCamera(), here, expected); }

    /// Seen by the camera.
    View seen() const {
        View view;
        world.render(smallCamera(), here, view);
        return view;
    }
    /// Share of pixels without depth in a view of the map, on the box and beside it.
    struct Erased {
        double onBox = 0., beside = 0.;
    };
    Erased erasedIn(const MeasuredSurfaces& surfaces, const Camera& camera) const {
        View view, truth, bare;
        surfaces.render(camera, here, view);
        world.render(camera, here, truth);
        map->render(camera, here, bare);
        Erased erased;
        double box = 0.;
        for (unsigned i = 0; i < view.depth.getSize(); ++i) {
            const bool isBox = truth.depth.bitmap[i] < bare.depth.bitmap[i] - 0.1F;
            box += isBox;
            (isBox ? erased.onBox : erased.beside) += !(view.depth.bitmap[i] > 0.F);
        }
        erased.onBox /= box;
        erased.beside /= view.depth.getSize() - box;
        return erased;
    }

    const std::shared_ptr<const ViewSource> map = std::make_shared<MeshRenderer>(floor());
    const MeshRenderer world{withBox()};
    const Pose here = lookFrom({0., 0., 2.}, test::kDown);
    View expected;
};

TEST_F(BoxThatIsNotInTheMap, IsLeftOutOfViewsOfEverySize) {
    MeasuredSurfaces surfaces(map, kAccuracy);
    surfaces.measure(expected, seen().depth, smallCamera(), known(here, 1e-3));
    for (const Camera& camera :
         {smallCamera(), halved(smallCamera()), halved(halved(smallCamera()))}) {
        const Erased erased = erasedIn(surfaces, camera);
        EXPECT_GT(erased.onBox, 0.97) << camera.width;
        EXPECT_LT(erased.beside, 0.08) << camera.width;
    }
}

TEST_F(BoxThatIsNotInTheMap, IsNotFoundWithoutMeasuredDepth) {
    MeasuredSurfaces surfaces(map, kAccuracy);
    surfaces.measure(expected, seen().depth, smallCamera(), known(here, 1e-3));
    const ImageF nothing(smallCamera().height, smallCamera().width, 0.F);
    for (const ImageF& depth : {nothing, ImageF()}) {
        surfaces.measure(expected, depth, smallCamera(), known(here, 1e-3));
        EXPECT_EQ(erasedIn(surfaces, smallCamera()).onBox, 0.);
    }
    EXPECT_THROW(surfaces.measure(expected, ImageF(3, 4, 1.F), smallCamera(), known(here, 1e-3)),
                 std::invalid_argument);
}

/// An error of the pose moves edges of the depth image, and all depths; an error of its rotation,
/// those at the borders of the image most.
TEST_F(BoxThatIsNotInTheMap, AnUncertainPoseContradictsNoSurfaceThatIsThere) {
    const auto complete = std::make_shared<MeshRenderer>(withBox());
    const auto erasedFor = [&](const Vector6& error, const Vector6& sigma) {
        const Matrix6 covariance = sigma.cwiseAbs2().asDiagonal();
        MeasuredSurfaces surfaces(complete, kAccuracy);
        surfaces.measure(seen().depth, smallCamera(), {expSE3(error) * here, covariance});
        View view;
        surfaces.render(smallCamera(), here, view);
        double erased = 0.;
        for (unsigned i = 0; i < view.depth.getSize(); ++i) erased += !(view.depth.bitmap[i] > 0.F);
        return erased / view.depth.getSize();
    };
    const Vector6 moved = (Vector6() << 0.05, -0.05, 0.1, 0., 0., 0.).finished();
    EXPECT_LT(erasedFor(moved, Vector6::Constant(0.04)), 0.01);
    const Vector6 turned = (Vector6() << 0., 0., 0., 0.05, 0.05, 0.).finished();
    const Vector6 tilt = (Vector6() << 1e-3, 1e-3, 1e-3, 0.03, 0.03, 0.01).finished();
    EXPECT_LT(erasedFor(turned, tilt), 0.05);  // edges of the box move farther than the margin
    EXPECT_GT(erasedFor(turned, 0.1 * tilt), 0.1);
}

/// More of the image shows the box than the floor: without its depth the map seems to be wrong.
TEST_F(BoxThatIsNotInTheMap, DoesNotDisturbTracking) {
    const UncertainPose start = known(here, 5e-3);
    Vector6 error;
    error << 0.006, -0.004, 0.005, 0.003, -0.003, 0.004;
    const View image = seen();
    TrackerOptions options;
    options.searchPrior = true;
    const auto trackedWith = [&](const std::optional<DepthAccuracy>& depth) {
        options.depth = depth;
        Tracker tracker(map, smallCamera(), {expSE3(error) * start.mean, start.covariance},
                        options);
        std::mt19937_64 random(1);
        return tracker.track({test::noisy(image.intensity, 0.02, random), image.depth}, 0.1);
    };
    const TrackedFrame frame = trackedWith(kAccuracy);
    EXPECT_EQ(frame.alignment.verdict, Verdict::converged) << describe(frame.alignment);
    EXPECT_LT(deviation(frame.T_c_w.mean, here).head<3>().norm(), 6e-3);
    EXPECT_LT(test::neesOf(frame.alignment, here), 3.);
    const TrackedFrame blind = trackedWith({});
    EXPECT_TRUE(blind.rejected || test::neesOf(blind.alignment, here) > 3.)
        << describe(blind.alignment);
}

/// Measured depth contradicts the whole view from a height that is wrong by far more than its
/// sigma.
TEST_F(BoxThatIsNotInTheMap, AWrongBeliefDoesNotKeepALostCameraFromBeingFound) {
    TrackerOptions options;
    options.searchPrior = true;
    options.depth = kAccuracy;
    Vector6 error;
    error << 0., 0., 0.25, 0., 0., 0.;
    Tracker tracker(map, smallCamera(), known(expSE3(error) * here, 5e-3), options);
    View image;
    map->render(smallCamera(), here, image);
    std::mt19937_64 random(1);
    const UncertainPose still{Pose::Identity(), 1e-8 * Matrix6::Identity()};
    for (int i = 1; i <= 10; ++i) {
        const double time = 0.1 * i;
        tracker.update(
            {time, still, {{time, {test::noisy(image.intensity, 0.02, random), image.depth}}}});
    }
    EXPECT_EQ(tracker.loss().timesLost(), 1);
    EXPECT_FALSE(tracker.loss().isLost());
    EXPECT_LT(deviation(tracker.belief().mean, here).head<3>().norm(), 6e-3);
}

}  // namespace
}  // namespace photonav
