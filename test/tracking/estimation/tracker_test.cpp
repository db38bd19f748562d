// SPDX-License-Identifier: BSD-3-Clause
#include "estimation/tracker.hpp"

#include <gtest/gtest.h>

#include <set>

#include "geometry/gaussian.hpp"
#include "tracking/rooms.hpp"

namespace photonav {
namespace {

using test::room;

const Camera& flightCamera() {
    static const Camera small = makeCamera(160, 120, 1.1);
    return small;
}

std::shared_ptr<const ViewSource> roomMap() { return {std::shared_ptr<void>(), &room()}; }

/// Keyframes alone.
Tracker odometryFrom(const UncertainPose& start, const KeyframeChainOptions& options = {}) {
    return {nullptr, flightCamera(), start, {.keyframes = options}};
}

Tracker trackerIn(std::shared_ptr<const ViewSource> map, const UncertainPose& start) {
    return {std::move(map), flightCamera(), start};
}

View viewFrom(const Pose& T_c_w) {
    View view;
    room().render(flightCamera(), T_c_w, view);
    return view;
}

/// Forward through the room with a slow turn, 4 cm and 1.4 degrees an image.
Pose flight(int i) { return lookFrom({1. + 0.04 * i, 2.6 + 0.01 * i, 1.6}, 0.6, -0.2 + 0.025 * i); }

constexpr double kInterval = 0.1;

const UncertainPose& start() {
    static const UncertainPose pose{flight(0), Matrix6::Zero()};
    return pose;
}

View black() {
    View view = viewFrom(flight(0));
    view.intensity = 0.F;
    return view;
}

double distance(const Pose& a, const Pose& b) {
    return (a.inverse().translation() - b.inverse().translation()).norm();
}

TEST(KeyframeTracker, FollowsAFlightThroughSeveralKeyframes) {
    Tracker odometry = odometryFrom(start());
    std::set<double> keyframes;
    double last = 0.;
    for (int i = 0; i < 30; ++i) {
        const TrackedFrame frame = odometry.track(viewFrom(flight(i)), 5. + kInterval * i);
        EXPECT_FALSE(frame.rejected) << i << ": " << describe(frame.alignment);
        EXPECT_LT(distance(frame.T_c_w.mean, flight(i)), 0.02) << i;
        const double trace = frame.T_c_w.covariance.trace();
        ASSERT_TRUE(frame.keyframe);
        if (keyframes.insert(*frame.keyframe).second) {
            EXPECT_GE(trace, last);  // what keyframes add is never taken back
            last = trace;
        }
        EXPECT_TRUE(isCovariance(frame.T_c_w.covariance));
    }
    EXPECT_GE(keyframes.size(), 3U);
    EXPECT_LE(keyframes.size(), 20U);
}

/// Rounding must not add up: poses are products of poses.
TEST(KeyframeTracker, RotationsStayRotationsOverManyKeyframes) {
    KeyframeChainOptions options;
    options.maxTurn = 0.;  // every image becomes a keyframe
    Tracker odometry = odometryFrom(start(), options);
    for (int i = 0; i < 40; ++i) {
        const int there = i % 4 < 2 ? i % 4 : 4 - i % 4;
        odometry.track(viewFrom(flight(there)), kInterval * i);
    }
    const Eigen::Matrix3d R = odometry.beliefAtLastImage().mean.linear();
    EXPECT_LT((R * R.transpose() - Eigen::Matrix3d::Identity()).norm(), 1e-12);
    EXPECT_LT(distance(odometry.beliefAtLastImage().mean, flight(1)), 0.05);
}

TEST(KeyframeTracker, BlackImagesAreLostAndThenItGoesOn) {
    Tracker odometry = odometryFrom(start());
    for (int i = 0; i < 5; ++i) odometry.track(viewFrom(flight(i)), kInterval * i);
    const double before = odometry.beliefAtLastImage().covariance.trace();
    const Pose certain = odometry.beliefAtLastImage().mean;
    for (int i = 5; i < 8; ++i) {
        const TrackedFrame frame = odometry.track(black(), kInterval * i);
        EXPECT_TRUE(frame.rejected);
        EXPECT_TRUE(frame.T_c_w.mean.isApprox(certain));
    }
    EXPECT_GT(odometry.beliefAtLastImage().covariance.trace(), before + 1e-3);
    const TrackedFrame frame = odometry.track(viewFrom(flight(8)), kInterval * 8);
    EXPECT_FALSE(frame.rejected) << describe(frame.alignment);
    EXPECT_LT(distance(frame.T_c_w.mean, flight(8)), 0.02);
    EXPECT_LT(odometry.beliefAtLastImage().covariance.trace(), before + 1e-3);
}

TEST(KeyframeTracker, ComesBackToAnOldKeyframe) {
    Tracker odometry = odometryFrom(start());
    for (int i = 0; i < 30; ++i) odometry.track(viewFrom(flight(i)), kInterval * i);
    const View wall = viewFrom(lookFrom({3., 3., 1.5}, 0., 2.5));
    EXPECT_TRUE(odometry.track(wall, 3.).rejected);
    const TrackedFrame frame = odometry.track(viewFrom(flight(12)), 3.1);
    EXPECT_FALSE(frame.rejected) << describe(frame.alignment);
    EXPECT_LT(distance(frame.T_c_w.mean, flight(12)), 0.03);
    ASSERT_TRUE(frame.keyframe);
    EXPECT_NEAR(*frame.keyframe, 1.2, 0.45);
}

/// Too far from the keyframe, near enough to the image before: that becomes the keyframe.
TEST(KeyframeTracker, NamesTheKeyframeThatItAlignedTo) {
    KeyframeChainOptions options;
    options.minOverlap = 0.;
    options.maxShift = options.maxTurn = 10.;  // no keyframes of its own accord
    Tracker odometry = odometryFrom(start(), options);
    double keyframe = 0.;
    for (int i = 0; i < 60; ++i) {
        const TrackedFrame frame = odometry.track(viewFrom(flight(i)), kInterval * i);
        ASSERT_TRUE(frame.keyframe) << i;
        if (*frame.keyframe == keyframe) continue;
        EXPECT_FALSE(frame.rejected);
        EXPECT_EQ(*frame.keyframe, kInterval * (i - 1));
        keyframe = *frame.keyframe;
    }
    EXPECT_GT(keyframe, 0.);
}

TEST(KeyframeTracker, LostForLongItBeginsAnewAsUncertainAsItIs) {
    TrackerOptions options{.keyframes = KeyframeChainOptions{}};
    options.loss.freshStartAfter = 20;
    Tracker odometry(nullptr, flightCamera(), start(), options);
    int i = 0;
    for (; i < 3; ++i) odometry.track(viewFrom(flight(i)), kInterval * i);
    for (; i < 20; ++i) EXPECT_TRUE(odometry.track(black(), kInterval * i).rejected) << i;
    const double lost = odometry.beliefAtLastImage().covariance.trace();
    const auto elsewhere = [](int k) { return lookFrom({4., 1.5 + 0.03 * k, 1.6}, 0.5, 2.5); };
    TrackedFrame frame;
    for (int k = 0; k < 10; ++k, ++i) {
        frame = odometry.track(viewFrom(elsewhere(k)), kInterval * i);
        EXPECT_EQ(frame.rejected, k < 3) << k << ": 17 were black";
    }
    EXPECT_GT(frame.T_c_w.covariance.trace(), lost);
    const Pose motion = odometry.beliefAtLastImage().mean.inverse();
    odometry.track(viewFrom(elsewhere(10)), kInterval * i);
    EXPECT_NEAR(distance(motion.inverse(), odometry.beliefAtLastImage().mean), 0.03, 0.005);
}

TEST(KeyframeTracker, BlackFromTheBeginningIsLostUntilSomethingIsSeen) {
    Tracker odometry = odometryFrom(start());
    EXPECT_TRUE(odometry.track(black(), 1e9).rejected);
    EXPECT_EQ(odometry.beliefAtLastImage().covariance, start().covariance);
    EXPECT_TRUE(odometry.track(black(), 1e9 + 0.1).rejected);
    const TrackedFrame frame = odometry.track(viewFrom(flight(0)), 1e9 + 0.2);
    EXPECT_FALSE(frame.rejected);
    EXPECT_EQ(frame.keyframe, 1e9 + 0.2);
    EXPECT_TRUE(frame.T_c_w.mean.isApprox(flight(0)));
    // It may have moved in the dark.
    const Matrix6 grown = frame.T_c_w.covariance - start().covariance;
    EXPECT_NEAR(grown(0, 0), 2. * 0.05 * 0.05, 1e-4);  // half a metre per second
    EXPECT_NEAR(grown(5, 5), 2. * 0.1 * 0.1, 1e-4);
}

UncertainPose roughStart(int i) {
    Vector6 xi;
    xi << 0.02, -0.02, 0.02, 0.01, -0.01, 0.01;
    return {expSE3(xi) * flight(i), 0.03 * 0.03 * Matrix6::Identity()};
}

TEST(MapTracker, FollowsAFlightInAMap) {
    Tracker localizer = trackerIn(roomMap(), roughStart(0));
    std::mt19937_64 random(2);
    double sum = 0.;
    for (int i = 0; i < 30; ++i) {
        const ImageF image = test::noisy(viewFrom(flight(i)).intensity, 0.02, random);
        const TrackedFrame frame = localizer.track({image, {}}, kInterval * i);
        EXPECT_FALSE(frame.rejected) << i << ": " << describe(frame.alignment);
        EXPECT_LT(distance(frame.T_c_w.mean, flight(i)), 5e-3) << i;
        const Vector6 xi = logSE3(flight(i) * frame.T_c_w.mean.inverse());
        sum += squaredDistance(xi, frame.T_c_w.covariance) / 6.;
    }
    EXPECT_GT(sum / 30., 0.5);
    EXPECT_LT(sum / 30., 1.6);
}

TEST(MapTracker, LostInTheDarkItWaitsWhereItWasAndTakesUpAgain) {
    Tracker localizer = trackerIn(roomMap(), roughStart(0));
    for (int i = 0; i < 5; ++i) localizer.track(viewFrom(flight(i)), kInterval * i);
    const Pose certain = localizer.beliefAtLastImage().mean;
    for (int i = 5; i < 9; ++i) {
        EXPECT_TRUE(localizer.track(black(), kInterval * i).rejected);
        EXPECT_TRUE(localizer.beliefAtLastImage().mean.isApprox(certain));
        EXPECT_TRUE(localizer.predicted(kInterval * i + 0.1).mean.isApprox(certain));
    }
    EXPECT_GT(localizer.beliefAtLastImage().covariance.trace(), 1e-2);
    const TrackedFrame frame = localizer.track(viewFrom(flight(8)), 0.9);
    EXPECT_FALSE(frame.rejected) << describe(frame.alignment);
    EXPECT_LT(distance(frame.T_c_w.mean, flight(8)), 5e-3);
}

TEST(MapTracker, ALostBeliefStopsGrowing) {
    Tracker localizer = trackerIn(roomMap(), roughStart(0));
    for (int i = 0; i < 12; ++i) localizer.track(black(), 10. * i);
    EXPECT_LT(localizer.beliefAtLastImage().covariance.trace(), 3. * 1. + 3. * 0.25 + 1e-9);
    EXPECT_TRUE(isCovariance(localizer.beliefAtLastImage().covariance));
}

TEST(MapTracker, AnotherRoomIsNotThisOne) {
    Tracker localizer = trackerIn(
        std::make_shared<MeshRenderer>(test::floorOf(valueNoise({.size = {20., 20.}, .seed = 9}))),
        roughStart(0));
    for (int i = 0; i < 8; ++i) {
        const TrackedFrame frame = localizer.track(viewFrom(flight(i)), kInterval * i);
        EXPECT_TRUE(frame.rejected) << i;
    }
    localizer.track(viewFrom(flight(8)), kInterval * 8);
    localizer.track(black(), kInterval * 9);
    EXPECT_FALSE(localizer.loss().isStartWrong());
    localizer.track(viewFrom(flight(9)), kInterval * 10);
    EXPECT_TRUE(localizer.loss().isStartWrong()) << "10 images that show something";
}

/// It agrees with the map wherever the camera is: the motion must not be carried on by it.
TEST(MapTracker, WithoutOdometryAnImageThatDoesNotInformIsRejected) {
    const auto white = std::make_shared<MeshRenderer>(test::floorOf(uniformTexture(0.9F)));
    const Pose here = lookFrom({0., 0., 2.}, test::kDown);
    Tracker localizer = trackerIn(white, {here, 1e-4 * Matrix6::Identity()});
    View view;
    white->render(flightCamera(), here, view);
    EXPECT_TRUE(localizer.track(view, 0.).rejected);
    EXPECT_TRUE(localizer.loss().isLost());
}

/// At the velocity so far it would be a metre on.
void expectFoundWhereItStopped(Tracker tracker) {
    int i = 0;
    for (; i < 8; ++i) EXPECT_FALSE(tracker.track(viewFrom(flight(i)), kInterval * i).rejected);
    const TrackedFrame frame = tracker.track(viewFrom(flight(i)), kInterval * i + 2.5);
    EXPECT_FALSE(frame.rejected) << describe(frame.alignment);
    EXPECT_GT(distance(frame.predicted.mean, flight(i)), 0.8);
    EXPECT_LT(distance(frame.T_c_w.mean, flight(i)), 0.03);
}

TEST(MapTracker, FindsACameraThatHasStopped) {
    expectFoundWhereItStopped(trackerIn(roomMap(), roughStart(0)));
}

TEST(KeyframeTracker, FindsACameraThatHasStopped) {
    expectFoundWhereItStopped(odometryFrom(start()));
}

/// Where the camera is expected after images that were lost: they took time, too.
void expectSpeedKept(Tracker tracker) {
    const auto position = [](const Pose& T_c_w) -> Eigen::Vector3d {
        return T_c_w.inverse().translation();
    };
    for (int i = 0; i < 5; ++i) EXPECT_FALSE(tracker.track(viewFrom(flight(i)), i).rejected);
    for (int i = 5; i < 8; ++i) EXPECT_TRUE(tracker.track(black(), i).rejected);
    EXPECT_FALSE(tracker.track(viewFrom(flight(8)), 8.).rejected);
    const Eigen::Vector3d step =
        position(tracker.predicted(9.).mean) - position(tracker.beliefAtLastImage().mean);
    const Eigen::Vector3d truth = (position(flight(8)) - position(flight(4))) / 4.;
    EXPECT_LT((step - truth).norm(), 0.5 * truth.norm());
}

TEST(MapTracker, SpeedIsOverTheTimeSinceTheImageTrackedLast) {
    expectSpeedKept(trackerIn(roomMap(), roughStart(0)));
}

TEST(KeyframeTracker, SpeedIsOverTheTimeSinceTheImageTrackedLast) {
    expectSpeedKept(odometryFrom(start()));
}

/// Where the map does not explain an image, a keyframe does; the map may be exchanged for one that
/// does.
TEST(Tracker, AlignsToWhateverExplainsTheImage) {
    TrackerOptions options;
    options.keyframes.emplace();
    Tracker tracker(roomMap(), flightCamera(), roughStart(0), options);
    const auto track = [&](int i) { return tracker.track(viewFrom(flight(i)), kInterval * i); };
    for (int i = 0; i < 4; ++i) {
        const TrackedFrame frame = track(i);
        EXPECT_FALSE(frame.rejected);
        EXPECT_FALSE(frame.keyframe) << "found in the map";
    }
    const double inMap = tracker.beliefAtLastImage().covariance.trace();
    tracker.setMap(
        std::make_shared<MeshRenderer>(test::floorOf(valueNoise({.size = {20., 20.}, .seed = 9}))));
    for (int i = 4; i < 8; ++i) {
        const TrackedFrame frame = track(i);
        EXPECT_FALSE(frame.rejected) << describe(frame.alignment);
        EXPECT_TRUE(frame.keyframe);
        EXPECT_LT(distance(frame.T_c_w.mean, flight(i)), 0.02);
    }
    EXPECT_GT(tracker.beliefAtLastImage().covariance.trace(), inMap);
    tracker.setMap(roomMap());
    EXPECT_FALSE(track(8).keyframe);
    EXPECT_THROW(Tracker(nullptr, flightCamera(), start()), std::invalid_argument);
    EXPECT_THROW(trackerIn(roomMap(), start()).setMap(nullptr), std::invalid_argument);
}

}  // namespace
}  // namespace photonav
