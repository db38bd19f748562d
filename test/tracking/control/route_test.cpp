// SPDX-License-Identifier: BSD-3-Clause
#include "control/route.hpp"

#include <gtest/gtest.h>

#include "geometry/camera.hpp"
#include "geometry/constants.hpp"
#include "geometry/se3.hpp"

namespace photonav {
namespace {

constexpr double kStep = 0.02;  // [s]

std::vector<PlannedView> straightTo(double x, int views = 2) {
    std::vector<PlannedView> plan(static_cast<std::size_t>(views));
    for (std::size_t i = 0; i < plan.size(); ++i) {
        plan[i].distance = x * static_cast<double>(i) / (views - 1);
        plan[i].T_w_b.translation().x() = plan[i].distance;
        plan[i].isWaypoint = true;
    }
    return plan;
}

/// A body whose velocity is what it is commanded, or follows with a lag.
struct Body {
    Pose T_b_c = cameraMount(90. * kDegree);
    Pose T_w_b = Pose::Identity();
    double lag = 0.;  // [s]
    Eigen::Vector3d velocity_w = Eigen::Vector3d::Zero();
    double yawRate = 0.;

    UncertainPose belief(double variance = 1e-6) const {
        return {(T_w_b * T_b_c).inverse(), variance * Matrix6::Identity()};
    }
    void move(const BodyVelocity& command) {
        const double left = lag > 0. ? std::exp(-kStep / lag) : 0.;
        const Eigen::Vector3d wanted_w = T_w_b.linear() * command.linear;
        velocity_w = (wanted_w + left * (velocity_w - wanted_w)).eval();
        yawRate = command.yawRate + left * (yawRate - command.yawRate);
        T_w_b.translation() += kStep * velocity_w;
        T_w_b.rotate(Eigen::AngleAxisd(kStep * yawRate, Eigen::Vector3d::UnitZ()));
    }
};

/// The way is the body's, wherever the camera sits on it.
TEST(Route, EndsAtTheGoalOfTheBody) {
    Body body;
    body.T_b_c.translation().x() = 0.3;
    Route route(straightTo(2.), body.T_b_c, {.responseTime = 0.});
    double time = 0.;
    for (; !route.isAtGoal() && time < 10.; time += kStep) {
        EXPECT_NEAR(route.distance(), body.T_w_b.translation().x(), 0.05);
        body.move(route.advance(body.belief(), kStep).velocity);
    }
    EXPECT_NEAR(time, 2.5, 0.15);
    EXPECT_NEAR(body.T_w_b.translation().x(), 2., 0.05);
    EXPECT_NEAR(route.distance(), 2., 0.05);
    EXPECT_EQ(route.lastWaypoint().distance, 2.);
}

TEST(Route, AnticipatesTheBodysResponse) {
    const auto mostBehind = [](double responseTime) {
        Body body{.lag = 0.25};
        Route route(straightTo(4.), body.T_b_c, {.responseTime = responseTime});
        double most = 0.;
        for (double time = 0.; time < 2.; time += kStep) {
            const Route::Reference reference = route.advance(body.belief(), kStep);
            const double x = body.T_w_b.translation().x();
            most = std::max(most, reference.T_w_b.translation().x() - x);
            body.move(reference.velocity);
        }
        return most;
    };
    EXPECT_LT(mostBehind(0.25), 0.5 * mostBehind(0.));
}

/// A body that turns fast and responds late is commanded along the route, not aside of it.
TEST(Route, StaysOnItsWayWhileTheBodyTurns) {
    Body body{.lag = 0.25};
    std::vector<PlannedView> plan = straightTo(6., 5);
    for (std::size_t i = 0; i < plan.size(); ++i)
        plan[i].T_w_b.rotate(Eigen::AngleAxisd(3. * double(i), Eigen::Vector3d::UnitZ()));
    Route route(plan, body.T_b_c, {.responseTime = body.lag});
    double aside = 0.;
    for (double time = 0.; !route.isAtGoal() && time < 20.; time += kStep) {
        body.move(route.advance(body.belief(), kStep).velocity);
        aside = std::max(aside, std::abs(body.T_w_b.translation().y()));
    }
    EXPECT_NEAR(body.T_w_b.translation().x(), 6., 0.1);
    EXPECT_LT(aside, 0.02);
}

TEST(Route, PassesCloseWaypointsWithoutSlowingDown) {
    Body body;
    Route route(straightTo(5., 101), body.T_b_c, {});
    double slowest = 1.;
    for (double time = 0.; time < 4.; time += kStep) {
        const BodyVelocity velocity = route.advance(body.belief(), kStep).velocity;
        if (time > 1.) slowest = std::min(slowest, velocity.linear.x());
        body.move(velocity);
    }
    EXPECT_GT(slowest, 0.99);
    EXPECT_GT(route.lastWaypoint().distance, 3.);
    EXPECT_LE(route.lastWaypoint().distance, route.ahead().front().distance);
}

/// A belief that an image has corrected.
TEST(Route, WaitsForABeliefThatIsBesideItAndGoesOnFromOneAlongIt) {
    Body body;
    Route route(straightTo(5.), body.T_b_c, {});
    const auto fly = [&](double seconds) {
        Route::Reference reference;
        for (double time = 0.; time < seconds; time += kStep) {
            reference = route.advance(body.belief(), kStep);
            body.move(reference.velocity);
        }
        return reference;
    };
    fly(1.5);
    body.T_w_b.translation().y() += 0.12;  // more than twice the tolerance
    const double before = route.distance();
    EXPECT_TRUE(route.advance(body.belief(), kStep).velocity.linear.isZero());
    EXPECT_LT(route.distance(), before + 0.02);
    EXPECT_FALSE(route.advance(body.belief(0.02), kStep).velocity.linear.isZero())
        << "the position is no better known";
    body.T_w_b.translation().y() = 0.;
    body.T_w_b.translation().x() += 0.6;
    const Route::Reference ahead = fly(1.5);
    EXPECT_NEAR(ahead.T_w_b.translation().x(), body.T_w_b.translation().x(), 0.05);
    EXPECT_NEAR(ahead.velocity.linear.x(), 1., 1e-9);
    body.T_w_b.translation().x() -= 0.6;
    const Route::Reference behind = fly(1.5);
    EXPECT_NEAR(behind.T_w_b.translation().x(), body.T_w_b.translation().x(), 0.05);
}

/// From standstill it goes on as it began.
TEST(Route, HaltsAndGoesOn) {
    Body body;
    Route route(straightTo(5.), body.T_b_c, {});
    for (double time = 0.; time < 2.; time += kStep) {
        body.move(route.advance(body.belief(), kStep).velocity);
    }
    EXPECT_NEAR(body.velocity_w.x(), 1., 1e-9);
    route.halt();
    EXPECT_LT(route.advance(body.belief(), kStep).velocity.linear.x(), 0.5);
}

/// The body flies along a route; another one begins where it is.
TEST(Route, ANewRouteGoesOnAtTheBodysVelocity) {
    Body body;
    const BodyVelocity moving{{0.8, 0., 0.}, 0.};
    const auto first = [&](double x) {
        return Route(straightTo(x), body.T_b_c, {}, moving).advance(body.belief(), kStep).velocity;
    };
    EXPECT_NEAR(first(3.).linear.x(), 1., 0.21);
    EXPECT_GE(first(3.).linear.x(), 0.8);
    EXPECT_GE(first(-3.).linear.x(), -0.5) << "back, from standstill";
    EXPECT_LT(first(0.1).linear.x(), 0.6) << "it must stop";
    EXPECT_TRUE(first(0.).linear.isZero());
}

TEST(Route, NeedsTwoViews) {
    EXPECT_THROW(Route(std::vector<PlannedView>(1), Pose::Identity(), {}), std::invalid_argument);
}

}  // namespace
}  // namespace photonav
