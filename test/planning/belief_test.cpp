// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <random>

#include "fixture.hpp"
#include "se3.hpp"

namespace photonav::test {
namespace {

using Eigen::Vector3d;

struct Flight {
    explicit Flight(const Problem& problem)
        : space(problem.space()), model(*problem.model()), a(space.space()), b(space.space()) {}

    void between(const Vector3d& from, const Vector3d& to, double yawFrom = 0., double yawTo = 0.) {
        space.setState(a.get(), from, yawFrom);
        space.setState(b.get(), to, yawTo);
    }

    FlightSpace space;
    BeliefModel model;
    ob::ScopedState<> a, b;
};

/// The belief at the end of a -> b, starting at the root.
Belief flown(Flight& flight) {
    Motion motion = flight.model.motion(flight.a.get(), flight.b.get());
    return flight.model.fly(flight.model.root(), motion);
}

class EveryKind : public testing::TestWithParam<std::tuple<StateKind, CostRule>> {};

TEST_P(EveryKind, FlyAgreesWithPlainEvaluationBothWays) {
    Problem problem;
    std::tie(problem.kind, problem.belief.cost) = GetParam();
    problem.bounds = box({0, 0, 0}, {10, 10, 4});
    Flight flight(problem);
    const auto sampler = flight.space.sampler(11);
    for (int i = 0; i < 40; ++i) {
        sampler->sampleUniform(flight.a.get());
        sampler->sampleUniform(flight.b.get());
        for (const bool backward : {false, true}) {
            Motion motion = backward ? flight.model.motion(flight.b.get(), flight.a.get())
                                     : flight.model.motion(flight.a.get(), flight.b.get());
            const Belief fast = flight.model.fly(flight.model.root(), motion, backward);
            const auto points = flight.model.evaluate({flight.a.get(), flight.b.get()});
            const BeliefPoint& plain = points.back();
            EXPECT_NEAR(fast.cost, plain.cost, 1e-11 * plain.cost);
            EXPECT_LT((fast.covariance - plain.covariance).norm(), 1e-10 * plain.covariance.norm());
        }
    }
}

INSTANTIATE_TEST_SUITE_P(
    Belief, EveryKind,
    testing::Combine(testing::Values(StateKind::position, StateKind::positionYaw, StateKind::se3),
                     testing::Values(CostRule::integral, CostRule::perVertex)));

TEST(Belief, CutsMotionsInStepsNoLongerThanDs) {
    Flight flight{Problem{}};
    flight.between({0, 0, 2}, {1, 0, 2});
    EXPECT_EQ(flight.model.motion(flight.a.get(), flight.b.get()).steps, 4);
    flight.between({0, 0, 2}, {1.01, 0, 2});
    EXPECT_EQ(flight.model.motion(flight.a.get(), flight.b.get()).steps, 5);
}

TEST(Belief, TheSameWayCostsTheSameWhateverItsVertices) {
    Flight flight{Problem{}};
    // Steps of 0.25 m whole and cut at every 0.5 m: the same views at the same places.
    flight.between({3., 1., 2.}, {9., 1., 2.});
    const auto whole = flight.model.evaluate({flight.a.get(), flight.b.get()});
    std::vector<ob::ScopedState<>> states;
    std::vector<const ob::State*> path;
    for (int i = 0; i <= 12; ++i) {
        states.emplace_back(flight.space.space());
        flight.space.setState(states.back().get(), {3. + 0.5 * i, 1., 2.}, 0.);
    }
    for (const auto& state : states) path.push_back(state.get());
    const auto cut = flight.model.evaluate(path);
    EXPECT_EQ(whole.size(), cut.size());
    EXPECT_NEAR(whole.back().cost, cut.back().cost, 1e-9);
    EXPECT_NEAR(whole.back().trace, cut.back().trace, 1e-9);
}

TEST(Belief, CostHardlyDependsOnTheStep) {
    // The trapezoid is exact enough at any step; what is left is that news comes half a step late.
    const auto cost = [](double ds, const Vector3d& to) {
        Problem problem;
        problem.belief.ds = ds;
        Flight flight(problem);
        flight.between({1., 1., 2.}, to);
        return flown(flight).cost;
    };
    const Vector3d white(3.5, 9., 2.);
    for (const double ds : {1., 0.5, 0.25}) {
        EXPECT_NEAR(cost(ds, white) / cost(0.1, white), 1., 6e-3) << ds;
    }
    const Vector3d texture(7., 5., 2.);
    EXPECT_NEAR(cost(0.25, texture) / cost(0.05, texture), 1., 0.05);
    EXPECT_NEAR(cost(0.1, texture) / cost(0.05, texture), 1., 0.02);
}

TEST(Belief, WithoutViewsTheTraceGrowsByTheMotionNoiseAndTheLever) {
    Problem problem;
    problem.belief.order = PropagationOrder::second;
    Flight flight(problem);
    flight.between({1., 1., 2.}, {1., 4., 2.});
    const Belief belief = flown(flight);
    // One shot: Sigma' = Ad Sigma Ad^T + sum of the noise carried over the rest of the way.
    const double way = 3.;
    const int steps = 12;
    const Vector3d step_c =
        -cameraMount(std::numbers::pi / 2).linear().transpose() * Vector3d(0., way / steps, 0.);
    Pose T_step = Pose::Identity();
    T_step.translation() = step_c;
    const Matrix6 Ad = adjoint(T_step);
    const Matrix6 mount = adjoint(cameraMount(std::numbers::pi / 2).inverse());
    Matrix6 expected = flight.model.root().covariance;
    for (int k = 0; k < steps; ++k) {
        expected = Ad * expected * Ad.transpose() +
                   way / steps * mount * problem.belief.motionNoise * mount.transpose();
    }
    EXPECT_LT((belief.covariance - expected).norm(), 1e-12);
    EXPECT_GT(expected.trace(), flight.model.root().covariance.trace());
}

TEST(Belief, StripesHelpAlongOneAxisOnly) {
    Flight flight{Problem{}};
    flight.between({2., 1., 2.}, {4.9, 1., 2.});
    const Belief belief = flown(flight);
    EXPECT_LT(belief.covariance(1, 1), 0.01);  // world x, across the stripes
    EXPECT_GT(belief.covariance(0, 0), 0.04);  // world y, along them
}

TEST(Belief, ChargesTheTraceBeforeTheUpdate) {
    // Noise-free flight over perfect texture: the first half step still pays for the initial trace.
    Problem problem;
    problem.belief.motionNoise.setZero();
    problem.belief.alpha = 0.;
    problem.belief.kappa = 1.;
    problem.belief.order = PropagationOrder::second;
    problem.belief.initialCovariance = vector6(1., 1., 1., 0., 0., 0.).asDiagonal();
    problem.information = [](const Pose&) { return Matrix6(1e12 * Matrix6::Identity()); };
    Flight flight(problem);
    flight.between({1., 1., 2.}, {2., 1., 2.});
    EXPECT_NEAR(flown(flight).cost, 0.25 * 3., 1e-6);  // one step at the initial trace, then none
}

TEST(Belief, AlphaOneIsThePathLength) {
    Problem problem;
    problem.belief.alpha = 1.;
    Flight flight(problem);
    flight.between({1., 1., 2.}, {4., 5., 2.});
    EXPECT_DOUBLE_EQ(flown(flight).cost, 5.);
}

TEST(Belief, PerVertexIsThePapersCost) {
    Problem problem;
    problem.belief.cost = CostRule::perVertex;
    Flight flight(problem);
    flight.between({1., 1., 2.}, {4., 5., 2.});
    const Belief belief = flown(flight);
    EXPECT_NEAR(belief.cost, 0.05 * 5. + 0.95 * 2.5 * belief.covariance.trace(), 1e-12);
    EXPECT_EQ(flight.model.field().views(), 2U);  // both ends, nothing in between
}

TEST(Belief, AFixedHeadingTurnsBodyAndCamera) {
    // Heading along world y: what the body calls x is world y, and fly() agrees with evaluate().
    Problem problem;
    problem.belief.initialCovariance = vector6(1., 2., 3., .1, .2, .3).asDiagonal();
    const FlightSpace space(StateKind::position, problem.bounds, 0.25, std::numbers::pi / 2);
    BeliefModel model(
        space,
        std::make_shared<InformationField>(problem.information, cameraMount(std::numbers::pi / 2),
                                           InformationField::Options{}),
        problem.belief);
    ob::ScopedState<> a(space.space());
    ob::ScopedState<> b(space.space());
    space.setState(a.get(), {3., 1., 2.}, 0.);
    space.setState(b.get(), {7., 4., 2.}, 0.);
    EXPECT_NEAR(yawOf(space.bodyPose(a.get())), std::numbers::pi / 2, 1e-12);
    Motion motion = model.motion(a.get(), b.get());
    const Belief fast = model.fly(model.root(), motion);
    const BeliefPoint plain = model.evaluate({a.get(), b.get()}).back();
    EXPECT_NEAR(fast.cost, plain.cost, 1e-11 * plain.cost);
    EXPECT_LT((fast.covariance - plain.covariance).norm(), 1e-10 * plain.covariance.norm());
    // The camera's image x (right) is the body's -y, here world +x.
    const Pose T_w_c = space.bodyPose(a.get()) * cameraMount(std::numbers::pi / 2);
    EXPECT_TRUE(T_w_c.linear().col(0).isApprox(Eigen::Vector3d::UnitX(), 1e-12));
}

TEST(Belief, NoiseIsGivenInTheBodyFrame) {
    // Forward camera: the body's x is the optical axis, so x noise ends up in camera z.
    Problem problem;
    problem.belief.initialCovariance = vector6(1., 2., 3., .1, .2, .3).asDiagonal();
    BeliefModel model(problem.space(),
                      std::make_shared<InformationField>(problem.information, cameraMount(0.),
                                                         InformationField::Options{}),
                      problem.belief);
    const Vector6 camera = model.root().covariance.diagonal();
    EXPECT_TRUE(camera.isApprox(vector6(2., 3., 1., .2, .3, .1), 1e-12)) << camera.transpose();
}

TEST(Belief, RejectsWhatIsNoCovarianceAndNoTradeOff) {
    BeliefOptions options;
    EXPECT_NO_THROW(options.check());
    options.alpha = 1.5;
    EXPECT_THROW(options.check(), std::invalid_argument);
    options = {};
    options.motionNoise(0, 0) = -1.;
    EXPECT_THROW(options.check(), std::invalid_argument);
    options = {};
    options.initialCovariance(0, 1) = 1.;
    EXPECT_THROW(options.check(), std::invalid_argument);
    options = {};
    options.ds = 0.;
    EXPECT_THROW(options.check(), std::invalid_argument);
}

}  // namespace
}  // namespace photonav::test
