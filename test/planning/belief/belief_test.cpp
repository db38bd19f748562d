// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <random>

#include "geometry/se3.hpp"
#include "planning/fixture.hpp"

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
Belief propagated(Flight& flight) {
    Motion motion = flight.model.motion(flight.a.get(), flight.b.get());
    return flight.model.propagate(flight.model.root(flight.a.get()), motion);
}

class EveryKind : public testing::TestWithParam<std::tuple<StateKind, CostRule>> {};

TEST_P(EveryKind, PropagateAgreesWithPlainEvaluationBothWays) {
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
            const Belief root = flight.model.root(flight.a.get());
            const Belief fast = flight.model.propagate(root, motion, backward);
            const auto points = flight.model.evaluate({flight.a.get(), flight.b.get()});
            const BeliefPoint& plain = points.back();
            EXPECT_NEAR(fast.cost, plain.cost, 1e-11 * plain.cost);
            const Matrix6 covariance = flight.model.cameraCovariance(flight.b.get(), fast);
            EXPECT_LT((covariance - plain.covariance).norm(), 1e-10 * plain.covariance.norm());
        }
    }
}

INSTANTIATE_TEST_SUITE_P(
    Belief, EveryKind,
    testing::Combine(testing::Values(StateKind::position, StateKind::positionYaw, StateKind::se3),
                     testing::Values(CostRule::integral, CostRule::perVertex)));

TEST(Belief, GivesUpAMotionAsSoonAsItIsSureToCostTooMuch) {
    for (const bool backward : {false, true}) {
        Flight flight{Problem{}};
        flight.between({3, 1, 2}, {3, 9, 2});
        const auto motion = [&] {
            return backward ? flight.model.motion(flight.b.get(), flight.a.get())
                            : flight.model.motion(flight.a.get(), flight.b.get());
        };
        const Belief root = flight.model.root(flight.a.get());
        const auto viewsWithin = [&](double limit, bool isPossible) {
            flight.model.field().clear();
            Motion fresh = motion();
            EXPECT_EQ(flight.model.propagateWithin(limit, root, fresh, backward).has_value(),
                      isPossible);
            return flight.model.field().views();
        };
        Motion whole = motion();
        const Belief end = flight.model.propagate(root, whole, backward);
        Motion again = motion();
        const auto within =
            flight.model.propagateWithin(end.cost * (1. + 1e-12), root, again, backward);
        ASSERT_TRUE(within);
        EXPECT_EQ(within->cost, end.cost);
        EXPECT_EQ(within->covariance, end.covariance);
        const std::size_t all = viewsWithin(kInfinity, true);
        EXPECT_LT(viewsWithin(root.cost + 0.5 * (end.cost - root.cost), false), 0.9 * all);
        EXPECT_EQ(viewsWithin(root.cost, false), 0U);
        EXPECT_LT(root.cost + flight.model.lowerBound(whole), end.cost);
    }
}

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
        return propagated(flight).cost;
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
    const Belief belief = propagated(flight);
    // One shot: Sigma' = Ad Sigma Ad^T + sum of the noise carried over the rest of the way. Body
    // axes are those of the world here.
    const double way = 3.;
    const int steps = 12;
    Matrix6 Ad = Matrix6::Identity();
    Ad.topRightCorner<3, 3>() = hat({0., -way / steps, 0.});
    Matrix6 expected = problem.belief.initialCovariance;
    for (int k = 0; k < steps; ++k) {
        expected = Ad * expected * Ad.transpose() + way / steps * problem.belief.motionNoise;
    }
    EXPECT_LT((belief.covariance - expected).norm(), 1e-12);
    EXPECT_GT(expected.trace(), problem.belief.initialCovariance.trace());
}

TEST(Belief, StripesHelpAlongOneAxisOnly) {
    Flight flight{Problem{}};
    flight.between({2., 1., 2.}, {4.9, 1., 2.});
    const Belief belief = propagated(flight);
    EXPECT_LT(belief.covariance(0, 0), 0.01);  // world x, across the stripes
    EXPECT_GT(belief.covariance(1, 1), 0.04);  // world y, along them
}

/// States a quarter of a metre apart along y whose heading wanders within 3 degrees.
std::vector<ob::ScopedState<>> wanderingHeading(const FlightSpace& space) {
    std::vector<ob::ScopedState<>> states;
    std::mt19937 random(3);
    std::uniform_real_distribution<> yaw(-0.05, 0.05);
    for (int i = 0; i <= 30; ++i) {
        states.emplace_back(space.space());
        space.setState(states.back().get(), {4.5, 1. + 0.25 * i, 2.}, yaw(random));
    }
    return states;
}

TEST(Belief, AWanderingHeadingDoesNotObserveTheBlindAxisOfStripes) {
    Problem problem;
    problem.kind = StateKind::positionYaw;
    problem.belief.initialCovariance = vector6(1., 1., 1., 0., 0., 0.).asDiagonal();
    problem.belief.motionNoise = vector6(1e-3, 1e-3, 1e-3, 0., 0., 0.).asDiagonal();
    problem.information = [](const Pose& T_c_w) {
        const Matrix6 alongX = vector6(1e6, 0., 0., 0., 0., 0.).asDiagonal();
        return inRotatedAxes(alongX, T_c_w.linear());
    };
    BeliefModel model = *problem.model();
    const auto states = wanderingHeading(model.space());
    std::vector<const ob::State*> path;
    for (const auto& state : states) path.push_back(state.get());
    Belief belief = model.root(path.front());
    for (std::size_t i = 1; i < path.size(); ++i) {
        Motion motion = model.motion(path[i - 1], path[i]);
        belief = model.propagate(belief, motion);
    }
    EXPECT_LT(belief.covariance(0, 0), 2e-6);
    EXPECT_GT(belief.covariance(1, 1), 1.);
    EXPECT_GT(model.evaluate(path).back().trace, 2.);
}

/// Covariance in world-oriented axes at the end of a turning flight, by sampling the noise of every
/// step in the body frame.
Matrix6 sampledCovariance(const Problem& problem, const FlightSpace& space, const Motion& motion) {
    std::mt19937 random(8);
    std::normal_distribution<> normal;
    const auto draw = [&](const Matrix6& diagonal) {
        Vector6 xi;
        for (int i = 0; i < 6; ++i) xi[i] = std::sqrt(diagonal(i, i)) * normal(random);
        return xi;
    };
    const Pose T_c_b = cameraMount(std::numbers::pi / 4).inverse();
    const auto poseAt = [&](int k) {
        return space.poseBetween(motion.from, motion.to, double(k) / motion.steps);
    };
    const double step = motion.length / motion.steps;
    Matrix6 sum = Matrix6::Zero();
    constexpr int kSamples = 40000;
    for (int n = 0; n < kSamples; ++n) {
        Pose T_b_w = expSE3(draw(problem.belief.initialCovariance)) * poseAt(0).inverse();
        for (int k = 1; k <= motion.steps; ++k) {
            T_b_w = expSE3(draw(step * problem.belief.motionNoise)) * poseAt(k).inverse() *
                    poseAt(k - 1) * T_b_w;
        }
        const Pose T_w_c = poseAt(motion.steps) * T_c_b.inverse();
        const Vector6 xi = logSE3(T_c_b * T_b_w * T_w_c);
        const Eigen::Matrix3d R_w_c = T_w_c.linear();
        Vector6 inWorldAxes;
        inWorldAxes.head<3>() = R_w_c * xi.head<3>();
        inWorldAxes.tail<3>() = R_w_c * xi.tail<3>();
        sum += inWorldAxes * inWorldAxes.transpose() / kSamples;
    }
    return sum;
}

TEST(Belief, WorldAxesAgreeWithSamplesOfATurningFlight) {
    Problem problem;
    problem.kind = StateKind::positionYaw;
    problem.information = {};
    problem.mount = cameraMount(std::numbers::pi / 4);
    problem.belief.ds = 0.5;
    problem.belief.initialCovariance = vector6(.02, .01, .03, 2e-3, 1e-3, 4e-2).asDiagonal();
    problem.belief.motionNoise = vector6(4e-2, 1e-3, 5e-3, 2e-4, 1e-3, 1e-2).asDiagonal();
    Flight flight(problem);
    flight.between({1., 1., 2.}, {4., 5., 2.}, 0.3, 2.);
    const Belief belief = propagated(flight);
    const Motion motion = flight.model.motion(flight.a.get(), flight.b.get());
    const Matrix6 samples = sampledCovariance(problem, flight.space, motion);
    EXPECT_LT((belief.covariance - samples).norm(), 0.03 * samples.norm());
}

TEST(Belief, TheViewAtTheStartCountsUnlessLeftOut) {
    Problem problem;
    problem.belief.motionNoise.setZero();
    problem.belief.alpha = 0.;
    problem.belief.kappa = 1.;
    problem.belief.order = PropagationOrder::second;
    problem.belief.initialCovariance = vector6(1., 1., 1., 0., 0., 0.).asDiagonal();
    problem.information = [](const Pose&) { return Matrix6(1e12 * Matrix6::Identity()); };
    for (const bool viewAtStart : {true, false}) {
        problem.belief.viewAtStart = viewAtStart;
        Flight flight(problem);
        flight.between({1., 1., 2.}, {2., 1., 2.});
        const auto points = flight.model.evaluate({flight.a.get(), flight.b.get()});
        EXPECT_NEAR(points.front().traceBefore, 3., 1e-12);
        EXPECT_NEAR(points.front().trace, viewAtStart ? 0. : 3., 1e-6);
        EXPECT_NEAR(flight.model.root(flight.a.get()).covariance.trace(), viewAtStart ? 0. : 3.,
                    1e-6);
        // Without it, half a step is charged at the initial trace.
        EXPECT_NEAR(propagated(flight).cost, viewAtStart ? 0. : 0.125 * 3. + 0.125 * 3., 1e-6);
    }
}

TEST(Belief, ChargesTheTraceBeforeTheUpdate) {
    // Noise-free flight over perfect texture: the first half step still pays for the initial trace.
    Problem problem;
    problem.belief.viewAtStart = false;
    problem.belief.motionNoise.setZero();
    problem.belief.alpha = 0.;
    problem.belief.kappa = 1.;
    problem.belief.order = PropagationOrder::second;
    problem.belief.initialCovariance = vector6(1., 1., 1., 0., 0., 0.).asDiagonal();
    problem.information = [](const Pose&) { return Matrix6(1e12 * Matrix6::Identity()); };
    Flight flight(problem);
    flight.between({1., 1., 2.}, {2., 1., 2.});
    EXPECT_NEAR(propagated(flight).cost, 0.25 * 3.,
                1e-6);  // one step at the initial trace, then none
}

TEST(Belief, AlphaOneIsThePathLength) {
    Problem problem;
    problem.belief.alpha = 1.;
    Flight flight(problem);
    flight.between({1., 1., 2.}, {4., 5., 2.});
    EXPECT_DOUBLE_EQ(propagated(flight).cost, 5.);
}

TEST(Belief, PerVertexIsThePapersCost) {
    Problem problem;
    problem.belief.cost = CostRule::perVertex;
    Flight flight(problem);
    flight.between({1., 1., 2.}, {4., 5., 2.});
    const Belief belief = propagated(flight);
    EXPECT_NEAR(belief.cost, 0.05 * 5. + 0.95 * 2.5 * belief.covariance.trace(), 1e-12);
    EXPECT_EQ(flight.model.field().views(), 2U);  // both ends, nothing in between
}

TEST(Belief, AFixedHeadingTurnsBodyAndCamera) {
    // Heading along world y: what the body calls x is world y, and propagate() agrees with
    // evaluate().
    Problem problem;
    problem.belief.initialCovariance = vector6(1., 2., 3., .1, .2, .3).asDiagonal();
    const FlightSpace space(StateKind::position, problem.bounds, 0.25, std::numbers::pi / 2);
    BeliefModel model(space,
                      std::make_shared<InformationField>(problem.information, problem.mount,
                                                         InformationField::Options{}),
                      problem.belief);
    ob::ScopedState<> a(space.space());
    ob::ScopedState<> b(space.space());
    space.setState(a.get(), {3., 1., 2.}, 0.);
    space.setState(b.get(), {7., 4., 2.}, 0.);
    EXPECT_NEAR(yawOf(space.bodyPose(a.get())), std::numbers::pi / 2, 1e-12);
    Motion motion = model.motion(a.get(), b.get());
    const Belief fast = model.propagate(model.root(a.get()), motion);
    const BeliefPoint plain = model.evaluate({a.get(), b.get()}).back();
    EXPECT_NEAR(fast.cost, plain.cost, 1e-11 * plain.cost);
    EXPECT_LT((model.cameraCovariance(b.get(), fast) - plain.covariance).norm(),
              1e-10 * plain.covariance.norm());
    // The camera's image x (right) is the body's -y, here world +x.
    const Pose T_w_c = space.bodyPose(a.get()) * cameraMount(std::numbers::pi / 2);
    EXPECT_TRUE(T_w_c.linear().col(0).isApprox(Eigen::Vector3d::UnitX(), 1e-12));
}

TEST(Belief, NoiseIsGivenInTheBodyFrame) {
    // Forward camera: the body's x is the optical axis, so x noise ends up in camera z.
    Problem problem;
    problem.belief.initialCovariance = vector6(1., 2., 3., .1, .2, .3).asDiagonal();
    problem.mount = cameraMount(0.);
    const auto model = problem.model();
    const Vector6 camera = model->initialCovariance().diagonal();
    EXPECT_TRUE(camera.isApprox(vector6(2., 3., 1., .2, .3, .1), 1e-12)) << camera.transpose();
    ob::ScopedState<> state(problem.space().space());
    problem.space().setState(state.get(), {1., 1., 2.}, 0.);
    const Belief root = model->root(state.get());  // body axes are those of the world
    EXPECT_LT((root.covariance - problem.belief.initialCovariance).norm(), 1e-12);
    EXPECT_LT((model->cameraCovariance(state.get(), root) - model->initialCovariance()).norm(),
              1e-12);
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
