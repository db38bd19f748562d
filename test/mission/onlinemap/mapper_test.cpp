// SPDX-License-Identifier: BSD-3-Clause
#include "onlinemap/mapper.hpp"

#include <gtest/gtest.h>

#include "tracking/rooms.hpp"

namespace photonav {
namespace {

/// A camera looks down from 2 m on a floor.
class MapperTest : public testing::Test {
  protected:
    MapperTest() {
        config.camera.width = 94;
        config.camera.height = 60;
        camera = config.camera.camera();
        tracked.T_c_w = {lookFrom({0., 0., 2.}, test::kDown), 1e-4 * Matrix6::Identity()};
        MeshRenderer(test::floorOf(valueNoise({.size = {20., 20.}, .seed = 3})))
            .render(camera, tracked.T_c_w.mean, image);
        empty.intensity = ImageF(60, 94, 0.F);
        empty.depth = ImageF(60, 94, 0.F);
    }

    Config config;
    Camera camera;
    TrackedFrame tracked;
    View image, empty;
};

/// Whose errors the map has are those of the keyframes whose surfaces it was made of, as soon as
/// the tracker uses the map with them.
TEST_F(MapperTest, ErrorsAreThoseOfSurfacesInRange) {
    for (const double range : {4., 0.4}) {
        config.explore.range = range;
        Mapper mapper(config);
        const auto input = mapper.choose(tracked, image, empty, false);
        ASSERT_TRUE(input && input->keyframe);
        const auto isMapped = [&] {
            return mapper.errors()->relate(image, camera, tracked.T_c_w).isMapped;
        };
        EXPECT_FALSE(isMapped());
        mapper.setFused(*input);
        EXPECT_EQ(isMapped(), range > 2.);
    }
}

/// What the map forgets because it contradicts the images has the errors of the image that is fused
/// in its place.
TEST_F(MapperTest, ErrorsOfForgottenSurfacesAreForgotten) {
    Mapper mapper(config);
    const auto before = mapper.choose(tracked, image, empty, false);
    ASSERT_TRUE(before);
    mapper.setFused(*before);
    tracked.isMapInconsistent = true;
    tracked.T_c_w.covariance *= 100.;
    const auto anew = mapper.choose(tracked, image, image, false);
    ASSERT_TRUE(anew && anew->isMapInconsistent && anew->keyframe);
    mapper.setFused(*anew);
    const Matrix6 ofMap = mapper.errors()->relate(image, camera, tracked.T_c_w).ofMap;
    EXPECT_NEAR(ofMap.trace(), tracked.T_c_w.covariance.trace(), 1e-3 * ofMap.trace());
}

/// While another thread fuses the first image, the next ones do not lack the same surfaces.
TEST_F(MapperTest, ChoosesASurfaceOnceUntilTheMapShowsIt) {
    Mapper mapper(config);
    const auto first = mapper.choose(tracked, image, empty, false);
    ASSERT_TRUE(first);
    EXPECT_FALSE(mapper.choose(tracked, image, empty, false));
    mapper.setFused(*first);
    EXPECT_TRUE(mapper.choose(tracked, image, empty, false));  // the map has lost it
}

TEST_F(MapperTest, AsksForAnUpdateOnlyWhereTheMapChanges) {
    Mapper mapper(config);
    ASSERT_TRUE(mapper.choose(tracked, image, empty, false));
    EXPECT_FALSE(mapper.choose(tracked, image, image, false));  // nothing new
    EXPECT_TRUE(mapper.choose(tracked, image, image, true));
    EXPECT_EQ(mapper.keyframes(), 2);
    tracked.rejected = true;
    tracked.alignment.verdict = Verdict::lostResidual;
    EXPECT_FALSE(mapper.choose(tracked, image, image, true));
    tracked.isMapInconsistent = true;
    const auto input = mapper.choose(tracked, image, image, false);
    ASSERT_TRUE(input && input->keyframe);
    EXPECT_TRUE(input->isMapInconsistent);
}

/// There is no depth yet, but the robot waits: the plan is to be made again.
TEST_F(MapperTest, ASingleCameraThatWaitsHasNothingToFuse) {
    config.explore.sensor = ExploreSensor::monocular;
    Mapper mapper(config);
    EXPECT_FALSE(mapper.choose(tracked, image, empty, false));
    const auto input = mapper.choose(tracked, image, empty, true);
    ASSERT_TRUE(input);
    EXPECT_FALSE(input->keyframe || input->isMapInconsistent);
}

}  // namespace
}  // namespace photonav
