// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <set>

#include "estimation/tracker.hpp"
#include "tracking/rooms.hpp"

namespace photonav {
namespace {

const Camera& hoverCamera() {
    static const Camera small = makeCamera(160, 120, 1.1);
    return small;
}

/// With odometry: a hovering camera that looks down, and what it sees in a map.
class HoverOver {
  public:
    /// @param errors of a map made on the flight; null: the map is exact
    HoverOver(std::shared_ptr<const ViewSource> map, const UncertainPose& start,
              std::shared_ptr<MapErrors> errors = {})
        : map_(std::move(map)), tracker(map_, hoverCamera(), start, options(std::move(errors))) {}

    /// @param T_next_now measured since the image before
    TrackedFrame see(const ImageF& image, const Pose& T_next_now = Pose::Identity()) {
        time_ += 0.25;
        Observation observation;
        observation.time = time_ + latency;
        observation.T_next_now = UncertainPose{T_next_now, 1e-6 * Matrix6::Identity()};
        observation.frames.push_back({time_, {image, {}}});
        return tracker.update(observation).front();
    }
    TrackedFrame see(const ViewSource& world, const Pose& T_c_w) {
        View view;
        world.render(hoverCamera(), T_c_w, view);
        return see(test::noisy(view.intensity, 0.02, random_));
    }

  private:
    static TrackerOptions options(std::shared_ptr<MapErrors> errors) {
        TrackerOptions options;
        options.searchPrior = true;
        options.mapErrors = std::move(errors);
        return options;
    }
    std::shared_ptr<const ViewSource> map_;
    double time_ = 0.;
    std::mt19937_64 random_{1};

  public:
    Tracker tracker;
    double latency = 0.;  ///< of images [s]
};

UncertainPose narrow(const Pose& T_c_w) { return {T_c_w, 1e-6 * Matrix6::Identity()}; }

TEST(TrackerWithOdometry, TheVerticalCorrectsRollAndPitchAlone) {
    const auto white = std::make_shared<MeshRenderer>(test::floorOf(uniformTexture(0.9F)));
    const Pose truth = lookFrom({0., 0., 2.}, test::kDown);
    Vector6 error;
    error << 0.01, -0.02, 0.03, 0., 0., 0.;
    const Eigen::Vector3d up_c = truth.linear().col(2);
    const Eigen::Vector3d level_c = up_c.unitOrthogonal();
    error.tail<3>() = 0.03 * level_c + 0.05 * up_c;
    const UncertainPose start{expSE3(error) * truth, 1e-3 * Matrix6::Identity()};
    Tracker tracker(white, hoverCamera(), start);
    View view;
    white->render(hoverCamera(), truth, view);
    Observation observation;
    observation.time = 0.25;
    observation.T_next_now = UncertainPose{};
    observation.frames.push_back({0.25, {view.intensity, {}}, MeasuredVertical{up_c, 1e-3}});
    const TrackedFrame frame = tracker.update(observation).front();
    EXPECT_TRUE(frame.predicted.mean.isApprox(start.mean));
    EXPECT_TRUE(frame.predicted.covariance.isApprox(start.covariance, 1e-6));
    const UncertainPose& belief = frame.T_c_w;
    const Vector6 left = deviation(belief.mean, truth);
    EXPECT_NEAR(left.tail<3>().dot(level_c), 0., 1e-3);
    EXPECT_NEAR(left.tail<3>().dot(up_c), 0.05, 2e-3);
    const Eigen::Matrix3d covariance = belief.covariance.bottomRightCorner<3, 3>();
    EXPECT_NEAR(level_c.dot(covariance * level_c), 1e-6, 1e-7);
    EXPECT_NEAR(up_c.dot(covariance * up_c), 1e-3, 1e-5);
    EXPECT_NEAR(belief.covariance(0, 0), 1e-3, 1e-5);
}

/// A plan may lead over a surface without texture: such an image agrees with the map.
TEST(TrackerWithOdometry, AnImageThatDoesNotInformIsNoLoss) {
    const auto white = std::make_shared<MeshRenderer>(test::floorOf(uniformTexture(0.9F)));
    const Pose here = lookFrom({0., 0., 2.}, test::kDown);
    HoverOver hover(white, narrow(here));
    for (int i = 0; i < 6; ++i) EXPECT_FALSE(hover.see(*white, here).rejected);
    EXPECT_FALSE(hover.tracker.loss().isLost());
}

/// Flown on over white, it is the view before that the pose was known by.
TEST(TrackerWithOdometry, TheLastCertainViewDeterminesAllDirections) {
    const auto white = std::make_shared<MeshRenderer>(test::floorOf(uniformTexture(0.9F)));
    const auto floor =
        std::make_shared<MeshRenderer>(test::floorOf(valueNoise({.size = {20., 20.}, .seed = 4})));
    const Pose here = lookFrom({0., 0., 2.}, test::kDown);
    const Pose T_next_now(Eigen::Translation3d(0.1, 0., 0.));
    for (const auto& [map, isInformative] : {std::pair(white, false), std::pair(floor, true)}) {
        HoverOver hover(map, narrow(here));
        View view;
        map->render(hoverCamera(), T_next_now * here, view);
        EXPECT_FALSE(hover.see(view.intensity, T_next_now).rejected);
        const double moved = deviation(hover.tracker.lastCertainView(), here).norm();
        EXPECT_NEAR(moved, isInformative ? 0.1 : 0., 0.01);
    }
}

/// Not when it was exposed: until then odometry was all there was.
TEST(TrackerWithOdometry, ALossBeginsWhenTheImageHasArrived) {
    const auto white = std::make_shared<MeshRenderer>(test::floorOf(uniformTexture(0.9F)));
    HoverOver hover(white, narrow(lookFrom({0., 0., 2.}, test::kDown)));
    hover.latency = 0.1;
    const ImageF black(hoverCamera().height, hoverCamera().width, 0.F);
    for (int i = 0; i < 3; ++i) EXPECT_TRUE(hover.see(black).rejected);
    ASSERT_TRUE(hover.tracker.loss().isLost());
    EXPECT_DOUBLE_EQ(*hover.tracker.loss().since(), 0.85);
}

/// What a map made on the flight does not show yet is no reason to doubt the pose; nothing where a
/// given map should show something is.
TEST(TrackerWithOdometry, WhatItsOwnMapLacksIsNoLoss) {
    Scene elsewhere;
    addPlane(elsewhere, {50., 50., 0.}, {1., 0., 0.}, {0., 1., 0.},
             addTexture(elsewhere, uniformTexture(0.5F)));
    const auto map = std::make_shared<MeshRenderer>(std::move(elsewhere));
    const MeshRenderer floor(test::floorOf(valueNoise({.size = {20., 20.}, .seed = 4})));
    const Pose here = lookFrom({0., 0., 2.}, test::kDown);
    HoverOver own(map, narrow(here), std::make_shared<MapErrors>(0.05));
    HoverOver given(map, narrow(here));
    for (int i = 0; i < 8; ++i) {
        const TrackedFrame frame = own.see(floor, here);
        EXPECT_TRUE(frame.rejected);
        EXPECT_GT(frame.T_c_w.covariance(0, 0), 1e-6 * (i + 1)) << "odometry alone";
        given.see(floor, here);
    }
    EXPECT_FALSE(own.tracker.loss().isLost());
    EXPECT_TRUE(given.tracker.loss().isLost());
}

/// After a long contradiction between odometry and a map that was made on the flight, it is the map
/// that is doubted; a given map is not, and neither is any map for a camera in the dark.
TEST(TrackerWithOdometry, DoubtsItsOwnMapAfterALongLoss) {
    const auto map =
        std::make_shared<MeshRenderer>(test::floorOf(valueNoise({.size = {20., 20.}, .seed = 4})));
    const MeshRenderer floor(test::floorOf(valueNoise({.size = {20., 20.}, .seed = 5})));
    const Pose here = lookFrom({0., 0., 2.}, test::kDown);
    HoverOver own(map, narrow(here), std::make_shared<MapErrors>(0.05));
    HoverOver dark(map, narrow(here), std::make_shared<MapErrors>(0.05));
    const ImageF black(hoverCamera().height, hoverCamera().width, 0.F);
    HoverOver given(map, narrow(here));
    int doubted = 0;
    for (int i = 0; i < 16; ++i) {
        const TrackedFrame frame = own.see(floor, here);
        EXPECT_TRUE(frame.rejected);
        EXPECT_FALSE(frame.isMapInconsistent && i < 12) << "after " << i;
        doubted += frame.isMapInconsistent;
        EXPECT_FALSE(dark.see(black).isMapInconsistent);
        EXPECT_FALSE(given.see(floor, here).isMapInconsistent);
    }
    EXPECT_EQ(doubted, 1);
    EXPECT_FALSE(own.tracker.loss().isLost());
    EXPECT_TRUE(given.tracker.loss().isLost());
}

/// But it does not find a camera that is lost, however narrow its belief.
TEST(TrackerWithOdometry, AnImageThatDoesNotInformEndsNoLoss) {
    const auto white = std::make_shared<MeshRenderer>(test::floorOf(uniformTexture(0.9F)));
    const MeshRenderer another(test::floorOf(valueNoise({.size = {20., 20.}, .seed = 4})));
    const Pose here = lookFrom({0., 0., 2.}, test::kDown);
    for (const double sigma : {1e-3, 0.8}) {
        HoverOver hover(white, {here, sigma * sigma * Matrix6::Identity()});
        for (int i = 0; i < 3; ++i) EXPECT_TRUE(hover.see(another, here).rejected);
        ASSERT_TRUE(hover.tracker.loss().isLost());
        for (int i = 0; i < 6; ++i) EXPECT_TRUE(hover.see(*white, here).rejected) << sigma;
        EXPECT_TRUE(hover.tracker.loss().isLost());
        EXPECT_EQ(hover.tracker.loss().timesLost(), 1);
    }
}

/// Nor does one that leaves open a direction that the loss has made wide; one that does not, does.
TEST(TrackerWithOdometry, StripesEndNoLossAlongThem) {
    const auto bars =
        std::make_shared<MeshRenderer>(test::floorOf(stripes({.width = 2.5, .softEdge = 0.05})));
    const Pose here = lookFrom({0.05, 0., 2.}, test::kDown);
    const ImageF black(hoverCamera().height, hoverCamera().width, 0.F);
    HoverOver hover(bars, narrow(here));
    for (int i = 0; i < 3; ++i) EXPECT_TRUE(hover.see(black).rejected);
    for (int i = 0; i < 3; ++i) EXPECT_TRUE(hover.see(*bars, here).rejected);

    // A belief that was as wide along the bars before the loss is not rejected.
    const Eigen::Vector3d along_c = here.linear().col(1);
    UncertainPose wide = narrow(here);
    wide.covariance.topLeftCorner<3, 3>() += along_c * along_c.transpose();
    HoverOver uncertain(bars, wide);
    for (int i = 0; i < 3; ++i) EXPECT_TRUE(uncertain.see(black).rejected);
    TrackedFrame frame;
    for (int i = 0; i < 3; ++i) frame = uncertain.see(*bars, here);
    EXPECT_FALSE(frame.rejected) << describe(frame.alignment);

    const auto floor =
        std::make_shared<MeshRenderer>(test::floorOf(valueNoise({.size = {20., 20.}, .seed = 3})));
    HoverOver found(floor, narrow(here));
    for (int i = 0; i < 3; ++i) EXPECT_TRUE(found.see(black).rejected);
    const Pose moved = lookFrom({0.3, 0.2, 2.}, test::kDown);
    for (int i = 0; i < 3; ++i) frame = found.see(*floor, moved);
    EXPECT_FALSE(frame.rejected) << describe(frame.alignment);
    EXPECT_LT((frame.T_c_w.mean.inverse().translation() - moved.inverse().translation()).norm(),
              0.02);
}

/// Along bars, which no image shows, the errors of all steps since a keyframe add up, as they do
/// without images. Steps are forgotten neither at an image nor at the next keyframe.
TEST(TrackerWithOdometry, OdometryAddsUpAlongWhatKeyframesDoNotShow) {
    const MeshRenderer bars(test::floorOf(stripes({.width = 2.5, .softEdge = 0.05})));
    const Pose here = lookFrom({0.05, 0., 2.}, test::kDown);
    const Eigen::Vector3d along_c = here.linear().col(1), across_c = here.linear().col(0);
    TrackerOptions options;
    options.keyframes.emplace();
    options.keyframes->keyframe.alignment.exposure.emplace();
    Tracker tracker(nullptr, hoverCamera(), {here, 1e-12 * Matrix6::Identity()}, options);
    std::mt19937_64 random(1);
    View view;
    constexpr int kImages = 12;
    Matrix6 noise = 1e-8 * Matrix6::Identity();
    noise.topLeftCorner<3, 3>() = 1e-4 * Eigen::Matrix3d::Identity();
    UncertainPose byOdometry{here, Matrix6::Zero()};
    std::set<double> keyframes;
    for (int i = 0; i <= kImages; ++i) {
        Pose step = Pose::Identity();
        if (i > 0) step.translation() = 0.06 * along_c;
        const UncertainPose T_next_now{step, (i > 0 ? 1. : 0.) * noise};
        byOdometry = compound(T_next_now, byOdometry);
        bars.render(hoverCamera(), byOdometry.mean, view);
        view.intensity = test::noisy(view.intensity, 0.02, random);
        const TrackedFrame frame = tracker.update({i + 1., T_next_now, {{i + 1., view}}}).front();
        ASSERT_FALSE(frame.rejected) << i << ": " << describe(frame.alignment);
        keyframes.insert(frame.keyframe.value());
    }
    EXPECT_GT(keyframes.size(), 1U);
    EXPECT_LT(keyframes.size(), kImages / 2U);  // several images for each
    const auto variance = [](const Matrix6& covariance, const Eigen::Vector3d& axis) {
        return axis.dot(covariance.topLeftCorner<3, 3>() * axis);
    };
    const Matrix6& covariance = tracker.beliefAtLastImage().covariance;
    const double along = variance(byOdometry.covariance, along_c);
    EXPECT_GT(variance(covariance, along_c), 0.5 * along);
    EXPECT_LT(variance(covariance, along_c), 1.01 * along);
    EXPECT_LT(variance(covariance, across_c), 0.2 * variance(byOdometry.covariance, across_c));
}

}  // namespace
}  // namespace photonav
