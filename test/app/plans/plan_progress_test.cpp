// SPDX-License-Identifier: BSD-3-Clause
#include "plans/plan_progress.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "geometry/constants.hpp"

namespace photonav {
namespace {

/// Progress of a growth whose time follows a power of the number of vertices.
RemainingGrowth growthTo(std::size_t vertices, unsigned all, double power) {
    RemainingGrowth growth(all);
    for (std::size_t n = 50; n <= vertices; n += 50) {
        growth.add({n, std::pow(static_cast<double>(n) / 1000., power), 1., 0});
    }
    return growth;
}

TEST(PlanProgress, TheTimeLeftFollowsThePowerOfTheGrowth) {
    for (const double power : {1., 1.5, 2.}) {
        const auto growth = growthTo(1000, 4000, power);
        EXPECT_NEAR(growth.seconds().value(), std::pow(4., power) - 1., 1e-9) << power;
    }
}

/// Growth alone takes microseconds per vertex, until a first path is found and searched.
TEST(PlanProgress, TheFirstSearchIsNoMeasureOfTheGrowth) {
    RemainingGrowth growth(2500);
    growth.add({50, 0.001, kInfinity, 0});
    growth.add({100, 0.002, 25., 0});  // a path that is free, but not searched for
    growth.add({150, 0.5, 20., 0});
    EXPECT_FALSE(growth.seconds());
    growth.add({200, 0.6, 20., 0});
    EXPECT_FALSE(growth.seconds());
    growth.add({300, 0.8, 20., 0});
    EXPECT_LT(growth.seconds().value(), 100.);
    EXPECT_NEAR(growthTo(1000, 4000, 5.).seconds().value(), 15., 1e-9);  // of 1 s: power 2
}

TEST(PlanProgress, NoTimeIsPromisedForTheLastSearchAndTheDescent) {
    EXPECT_FALSE(RemainingGrowth(100).seconds());
    EXPECT_FALSE(growthTo(1000, 1000, 1.).seconds());
    const std::string growing = progressText({500, 0.5, 4., 7}, 1000, growthTo(500, 1000, 1.));
    EXPECT_EQ(growing,
              "500 of 1000 vertices, best cost 4.000, 7 views, about 1 s to the last vertex");
    const std::string early = progressText({500, 2., kInfinity, 7}, 1000, RemainingGrowth(1000));
    EXPECT_EQ(early, "500 of 1000 vertices, no path yet, 7 views, 2 s so far");
    const std::string last = progressText({1000, 11., 3.25, 7}, 1000, growthTo(1000, 1000, 1.));
    EXPECT_EQ(last,
              "1000 of 1000 vertices, best cost 3.250, 7 views, improving the path, 11 s so far");
}

}  // namespace
}  // namespace photonav
