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

/// An error of the pose moves edges of the depth image, and all depths.
TEST_F(BoxThatIsNotInTheMap, AnUncertainPoseContradictsNoSurfaceThatIsThere) {
    const auto complete = std::make_shared<MeshRenderer>(withBox());
    View shown;
    Vector6 error;
    error << 0.05, -0.05, 0.1, 0., 0., 0.;
    const UncertainPose prior = known(expSE3(error) * here, 0.04);
    complete->render(smallCamera(), prior.mean, shown);
    MeasuredSurfaces surfaces(complete, kAccuracy);
    surfaces.measure(shown, seen().depth, smallCamera(), prior);
    View view;
    surfaces.render(smallCamera(), here, view);
    double erased = 0.;
    for (unsigned i = 0; i < view.depth.getSize(); ++i) erased += !(view.depth.bitmap[i] > 0.F);
    EXPECT_LT(erased / view.depth.getSize(), 0.01);
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

}  // namespace
}  // namespace photonav
