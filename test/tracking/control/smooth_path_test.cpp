// SPDX-License-Identifier: BSD-3-Clause
#include "control/smooth_path.hpp"

#include <gtest/gtest.h>

#include <numbers>
#include <random>

#include "geometry/segment.hpp"

namespace photonav {
namespace {

using Corners = std::vector<Station>;

/// Corners that a planner might leave: some close to each other, with turns to any side.
Corners zigzag(unsigned seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> length(0.1, 1.), turn(-1.2, 1.2);
    Corners corners{Station::Zero()};
    double direction = 0.;
    for (int i = 0; i < 20; ++i) {
        direction += turn(random);
        const double leg = length(random);
        corners.push_back(corners.back() + Station(leg * std::cos(direction),
                                                   leg * std::sin(direction), 0.1 * leg,
                                                   0.5 * turn(random)));
    }
    return corners;
}

double distanceToLegs(const Eigen::Vector3d& p_w, const Corners& corners) {
    double least = 1e9;
    for (std::size_t i = 1; i < corners.size(); ++i) {
        least =
            std::min(least, distanceToSegment(p_w, corners[i - 1].head<3>(), corners[i].head<3>()));
    }
    return least;
}

struct Flown {
    double seconds = 0.;
    double speed = 0., yawRate = 0.;                 // largest
    double acceleration = 0., yawAcceleration = 0.;  // largest
    double lastRate = 0.;
};

/// As fast as the path allows, from standstill.
Flown flown(const SmoothPath& path) {
    constexpr double kPhaseStep = 1e-3;  // [s]
    Flown most;
    double phase = 0., rate = 0.;
    Station before = Station::Zero();
    for (; phase < path.end() - 1e-4 && most.seconds < 200.; most.seconds += kPhaseStep) {
        rate = std::min(rate + path.rateGrowth(phase, rate) * kPhaseStep, path.rateLimit(phase));
        const Station velocity = rate * path.at(phase).first;
        const Station change = (velocity - before) / kPhaseStep;
        before = velocity;
        most.speed = std::max(most.speed, velocity.head<3>().norm());
        most.yawRate = std::max(most.yawRate, std::abs(velocity[3]));
        most.acceleration = std::max(most.acceleration, change.head<3>().norm());
        most.yawAcceleration = std::max(most.yawAcceleration, std::abs(change[3]));
        phase += rate * kPhaseStep;
    }
    most.lastRate = rate;
    return most;
}

TEST(SmoothPath, StaysWithinToleranceOfThePlanAndEndsWhereItDoes) {
    const PathTolerance tolerance{.position = 0.04, .yaw = 0.05};
    for (const unsigned seed : {1U, 2U, 3U}) {
        const Corners corners = zigzag(seed);
        const SmoothPath path(corners, {.maxYawRate = 1.}, tolerance);
        double farthest = 0.;
        for (double phase = 0.; phase <= path.end(); phase += 0.002) {
            const Station here = path.at(phase).station;
            farthest = std::max(farthest, distanceToLegs(here.head<3>(), corners));
            const auto [from, share] = path.legAt(phase);
            const double yaw =
                corners[from][3] +
                share * (corners[std::min(from + 1, corners.size() - 1)][3] - corners[from][3]);
            EXPECT_LT(std::abs(here[3] - yaw), tolerance.yaw + 0.02);
        }
        EXPECT_LT(farthest, tolerance.position);
        EXPECT_GT(farthest, 0.5 * tolerance.position) << "it makes use of the tolerance";
        EXPECT_TRUE(path.at(0.).station.isApprox(corners.front(), 1e-9));
        EXPECT_TRUE(path.at(path.end()).station.isApprox(corners.back(), 1e-9));
    }
}

TEST(SmoothPath, KeepsAllLimitsUntilItStops) {
    for (const double speed : {0.5, 1., 2.}) {
        const MotionLimits limits{.maxSpeed = speed,
                                  .maxYawRate = 0.4,
                                  .maxAcceleration = 1.2,
                                  .maxYawAcceleration = 0.8};
        const Flown most = flown(SmoothPath(zigzag(4), limits, {}));
        EXPECT_LT(most.speed, limits.maxSpeed * 1.001);
        EXPECT_LT(most.yawRate, limits.maxYawRate * 1.001);
        // A step across a knot sees the bend behind it only afterwards.
        EXPECT_LT(most.acceleration, limits.maxAcceleration * 1.15);
        EXPECT_LT(most.yawAcceleration, limits.maxYawAcceleration * 1.15);
        EXPECT_LT(most.lastRate, 0.05);
    }
}

TEST(SmoothPath, DerivativesAreThoseOfTheStations) {
    const SmoothPath path(zigzag(5), {}, {});
    constexpr double kPhaseStep = 1e-5;
    for (double phase = 0.05; phase < path.end() - 0.05; phase += 0.0137) {
        const SmoothPath::Point here = path.at(phase);
        const SmoothPath::Point next = path.at(phase + kPhaseStep),
                                last = path.at(phase - kPhaseStep);
        EXPECT_TRUE(((next.station - last.station) / (2. * kPhaseStep)).isApprox(here.first, 1e-3));
        EXPECT_TRUE(((next.first - here.first) / kPhaseStep - here.second).norm() < 1e-4 ||
                    ((here.first - last.first) / kPhaseStep - here.second).norm() < 1e-4);
    }
}

TEST(SmoothPath, CloseWaypointsOnALineCostNoTime) {
    Corners close;
    for (int i = 0; i <= 200; ++i) close.emplace_back(0.05 * i, 0., 1., 0.3);
    const double one = flown(SmoothPath({close.front(), close.back()}, {}, {})).seconds;
    const double many = flown(SmoothPath(close, {}, {})).seconds;
    EXPECT_NEAR(many, one, 0.01);
    EXPECT_NEAR(many, 10. + 0.5, 0.1);  // from 0 to 1 m/s and back at 2 m/s^2
    const double twice = flown(SmoothPath(close, {.maxSpeed = 2.}, {})).seconds;
    EXPECT_NEAR(twice, 5. + 1., 0.1);
}

TEST(SmoothPath, SlowsDownAtSharpCornersAlone) {
    const Corners corner{{0., 0., 0., 0.}, {5., 0., 0., 0.}, {5., 5., 0., 0.}};
    const SmoothPath path(corner, {}, {});
    EXPECT_EQ(path.rateLimit(2.), 1.);
    EXPECT_LT(path.rateLimit(5.), 0.8);
    EXPECT_GT(path.rateLimit(5.), 0.3);
    const SmoothPath bend({corner[0], corner[1], {10., 1., 0., 0.}}, {}, {});
    EXPECT_EQ(bend.rateLimit(5.), 1.);
    const SmoothPath back({corner[0], corner[1], corner[0]}, {}, {});
    EXPECT_LT(back.at(5.).first.norm(), 0.1) << "it stops where it turns back";
    EXPECT_LT(flown(back).seconds, 11.5);
}

TEST(SmoothPath, TurnsOnTheSpotAndStays) {
    const double wrapped = 3. - 2. * std::numbers::pi;  // half a turn to the left of 0
    const SmoothPath turn({{1., 2., 3., 0.}, {1., 2., 3., wrapped}}, {.maxYawRate = 1.}, {});
    EXPECT_NEAR(turn.end(), 3., 1e-9);
    EXPECT_GT(turn.at(1.5).station[3], 1.);
    EXPECT_LT(flown(turn).seconds, 3.4);
    const SmoothPath stay({{1., 2., 3., 1.}, {1., 2., 3., 1.}}, {}, {});
    EXPECT_EQ(stay.end(), 0.);
    EXPECT_TRUE(stay.at(0.).station.isApprox(Station(1., 2., 3., 1.)));
    EXPECT_TRUE(stay.at(0.).first.isZero());
}

TEST(SmoothPath, RefusesWhatCannotBeFlown) {
    EXPECT_THROW(SmoothPath({}, {}, {}), std::invalid_argument);
    EXPECT_THROW(SmoothPath({Station::Zero()}, {.maxSpeed = 0.}, {}), std::invalid_argument);
    EXPECT_THROW(SmoothPath({Station::Zero()}, {}, {.position = 0.}), std::invalid_argument);
}

}  // namespace
}  // namespace photonav
