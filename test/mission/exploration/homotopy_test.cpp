// SPDX-License-Identifier: BSD-3-Clause
#include "exploration/homotopy.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace photonav {
namespace {

/// A column of 1 x 1 m around (5, 0), from the floor up to `top`, in bounds of 10 x 6 x 1 m.
class Column : public testing::Test {
  protected:
    static HomotopyClasses classesFor(double top) {
        const auto clearance = [top](const Eigen::Vector3d& p_w) {
            const Eigen::Vector3d above = (p_w - Eigen::Vector3d(5., 0., top)).cwiseMax(0.);
            const double aside = (p_w.head<2>() - Eigen::Vector2d(5., 0.)).cwiseAbs().maxCoeff();
            return std::hypot(std::max(aside - 0.5, 0.), above.z());
        };
        return {clearance, 0.3, {Eigen::Vector3d(0., -3., 1.), Eigen::Vector3d(10., 3., 2.)}};
    }

    const GroundTrack left{{0., 0.}, {5., 1.5}, {10., 0.}};
    const GroundTrack farLeft{{0., 0.1}, {2., 2.5}, {8., 2.5}, {9.9, 0.}};
    const GroundTrack right{{0., 0.}, {5., -1.5}, {10., 0.}};
    const GroundTrack through{{0., 0.}, {10., 0.}};
};

TEST_F(Column, PartsTheWaysThatPassItOnDifferentSides) {
    const HomotopyClasses classes = classesFor(3.);
    EXPECT_TRUE(classes.areSame(left, farLeft));
    EXPECT_FALSE(classes.areSame(left, right));
    EXPECT_FALSE(classes.areSame(left, through));
    // A detour, and back again
    const GroundTrack detour{{0., 0.}, {5., -1.5}, {6., -1.5}, {5., -1.5},
                             {0., 0.}, {5., 1.5},  {10., 0.}};
    EXPECT_TRUE(classes.areSame(left, detour));
}

TEST_F(Column, ThatCanBeFlownOverPartsNone) {
    const HomotopyClasses classes = classesFor(1.5);
    EXPECT_TRUE(classes.areSame(left, right));
    EXPECT_FALSE(classesFor(1.8).areSame(left, right));  // too little room above
}

/// A flight around the left side of the column, one metre per second and sample.
ExplorationResult flightLeft() {
    ExplorationResult flight;
    for (int i = 0; i <= 10; ++i) {
        FlightSample sample;
        sample.time = sample.distance = i;
        sample.T_c_w.translation() << -i, -1.5 * std::sin(0.1 * std::numbers::pi * i),
            0.;  // minus the position
        flight.samples.push_back(sample);
    }
    return flight;
}

TEST_F(Column, AFlightHasDecidedWhenNoLaterPlanIsOfAnotherClass) {
    ExplorationResult flight = flightLeft();
    const auto plan = [&](double time, GroundTrack way) {
        flight.updates.emplace_back().time = time;
        flight.plans.push_back(std::move(way));
    };
    const auto decided = [&] {
        return flownUntilDecided(flight, Pose::Identity(), classesFor(3.));
    };
    EXPECT_TRUE(std::isnan(decided()));  // without a plan
    plan(0.5, {});
    plan(1., {{1., 0.5}, {5., 1.5}, {10., 0.}});  // left
    EXPECT_EQ(decided(), 0.);
    plan(2., {{2., 0.9}, {5., -1.5}, {10., 0.}});  // right
    EXPECT_TRUE(std::isnan(decided()));
    plan(3., {});
    plan(4., {{4., 1.4}, {5., 1.5}, {10., 0.}});  // left again
    plan(5., {{5., 1.5}, {10., 0.}});
    EXPECT_EQ(decided(), 3.);
}

}  // namespace
}  // namespace photonav
