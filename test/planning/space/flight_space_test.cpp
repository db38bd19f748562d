// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include "geometry/se3.hpp"
#include "planning/fixture.hpp"

namespace photonav::test {
namespace {

using Eigen::Vector3d;

class EverySpace : public testing::TestWithParam<StateKind> {};

TEST_P(EverySpace, PosesBetweenStatesAgreeWithOmplInterpolation) {
    const FlightSpace space(GetParam(), box({-5, -5, 0}, {5, 5, 3}));
    const auto si = makeSpaceInformation(
        space, [](const Vector3d&) { return 1.; }, 0.1);
    const auto sampler = space.sampler(7);
    ob::ScopedState<> a(si);
    ob::ScopedState<> b(si);
    ob::ScopedState<> between(si);
    for (int i = 0; i < 200; ++i) {
        sampler->sampleUniform(a.get());
        sampler->sampleUniform(b.get());
        const double t = 0.01 * (i % 101);
        space.space()->interpolate(a.get(), b.get(), t, between.get());
        const Pose expected = space.bodyPose(between.get());
        EXPECT_TRUE(space.poseBetween(a.get(), b.get(), t).isApprox(expected, 1e-7)) << i;
    }
}

TEST_P(EverySpace, SamplerDependsOnItsSeedOnly) {
    const FlightSpace space(GetParam(), box({-5, -5, 0}, {5, 5, 3}));
    ob::ScopedState<> a(space.space());
    ob::ScopedState<> b(space.space());
    const auto first = space.sampler(3);
    first->sampleUniform(a.get());
    const auto unrelated = space.space()->allocStateSampler();
    unrelated->sampleUniform(b.get());
    const auto second = space.sampler(3);
    second->sampleUniform(b.get());
    EXPECT_EQ(space.space()->distance(a.get(), b.get()), 0.);
    const auto other = space.sampler(4);
    other->sampleUniform(b.get());
    EXPECT_GT(space.space()->distance(a.get(), b.get()), 0.);
}

TEST_P(EverySpace, SetStateIsWhatBodyPoseReads) {
    const FlightSpace space(GetParam(), box({-5, -5, 0}, {5, 5, 3}));
    ob::ScopedState<> state(space.space());
    space.setState(state.get(), {1., -2., 0.5}, 4.);  // beyond pi: wraps
    EXPECT_TRUE(space.position(state.get()).isApprox(Vector3d(1., -2., 0.5)));
    const double yaw = GetParam() == StateKind::position ? 0. : 4. - 2. * std::numbers::pi;
    EXPECT_NEAR(yawOf(space.bodyPose(state.get())), yaw, 1e-12);
}

TEST_P(EverySpace, AHeadingOfPiIsWithinBounds) {
    const FlightSpace space(GetParam(), box({-5, -5, 0}, {5, 5, 3}));
    ob::ScopedState<> state(space.space());
    for (const double yaw : {std::numbers::pi, -std::numbers::pi, 3. * std::numbers::pi}) {
        space.setState(state.get(), {0., 0., 1.}, yaw);
        EXPECT_TRUE(space.space()->satisfiesBounds(state.get())) << yaw;
    }
}

INSTANTIATE_TEST_SUITE_P(FlightSpace, EverySpace,
                         testing::Values(StateKind::position, StateKind::positionYaw,
                                         StateKind::se3));

TEST(FlightSpace, FlatBoundsPlanInOneDimensionLess) {
    EXPECT_EQ(FlightSpace(StateKind::position, box({0, 0, 2}, {10, 10, 2})).dimension(), 2);
    EXPECT_EQ(FlightSpace(StateKind::positionYaw, box({0, 0, 1}, {10, 10, 2})).dimension(), 4);
    EXPECT_DOUBLE_EQ(FlightSpace(StateKind::position, box({0, 0, 2}, {10, 5, 2})).measure(), 50.);
}

TEST(FlightSpace, UnitBallIsThatOfTheMetric) {
    // Share of uniform samples within a small distance of the middle, against ball by measure.
    const auto expectShare = [](const FlightSpace& space) {
        const double radius = 0.3;
        const auto sampler = space.sampler(5);
        ob::ScopedState<> middle(space.space());
        ob::ScopedState<> sample(space.space());
        space.setState(middle.get(), {0., 0., 1.}, 0.);
        int inside = 0;
        const int samples = 400000;
        for (int i = 0; i < samples; ++i) {
            sampler->sampleUniform(sample.get());
            inside += space.space()->distance(middle.get(), sample.get()) < radius ? 1 : 0;
        }
        const double share =
            space.unitBallMeasure() * std::pow(radius, space.dimension()) / space.measure();
        EXPECT_NEAR(inside / (share * samples), 1., 0.1) << inside;
    };
    expectShare({StateKind::position, box({-.5, -.5, .5}, {.5, .5, 1.5})});
    expectShare({StateKind::position, box({-.5, -.5, 1}, {.5, .5, 1})});
    expectShare({StateKind::positionYaw, box({-.5, -.5, .5}, {.5, .5, 1.5})});
    expectShare({StateKind::positionYaw, box({-.5, -.5, 1}, {.5, .5, 1})});
    expectShare({StateKind::se3, box({-.3, -.3, .7}, {.3, .3, 1.3}), 0.25});
}

TEST(FlightSpace, RejectsEmptyBoundsAndNegativeWeight) {
    EXPECT_THROW(FlightSpace(StateKind::position, box({1, 0, 0}, {0, 1, 1})),
                 std::invalid_argument);
    EXPECT_THROW(FlightSpace(StateKind::position, box({0, 0, 0}, {1, 1, 1}), -1.),
                 std::invalid_argument);
}

TEST(FlightSpace, MotionsNeverStepOverAThinWall) {
    // A wall of zero thickness at x = 5; clearance is the distance to it.
    const FlightSpace space(StateKind::position, box({0, 0, 0}, {10, 10, 10}));
    const auto si = makeSpaceInformation(
        space, [](const Vector3d& p) { return std::abs(p.x() - 5.); }, 0.01);
    ob::ScopedState<> a(si);
    ob::ScopedState<> b(si);
    const auto sampler = space.sampler(1);
    for (int i = 0; i < 500; ++i) {
        sampler->sampleUniform(a.get());
        sampler->sampleUniform(b.get());
        const bool crosses = (a[0] - 5.) * (b[0] - 5.) < 0.;
        if (std::abs(a[0] - 5.) < 0.02 || std::abs(b[0] - 5.) < 0.02) continue;
        EXPECT_EQ(si->checkMotion(a.get(), b.get()), !crosses);
    }
}

TEST(FlightSpace, LastValidStateIsBeforeTheObstacle) {
    const FlightSpace space(StateKind::position, box({0, 0, 0}, {10, 10, 10}));
    const auto si = makeSpaceInformation(
        space, [](const Vector3d& p) { return 5. - p.x(); }, 0.5);
    ob::ScopedState<> a(si);
    ob::ScopedState<> b(si);
    ob::ScopedState<> last(si);
    space.setState(a.get(), {1., 1., 1.}, 0.);
    space.setState(b.get(), {9., 1., 1.}, 0.);
    std::pair<ob::State*, double> lastValid{last.get(), -1.};
    EXPECT_FALSE(si->checkMotion(a.get(), b.get(), lastValid));
    EXPECT_TRUE(si->isValid(last.get()));
    EXPECT_NEAR(last[0], 4.5, 0.05);
}

}  // namespace
}  // namespace photonav::test
