// SPDX-License-Identifier: BSD-3-Clause
#include "commands/plan_progress.hpp"

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

TEST(PlanProgress, NoTimeIsPromisedForTheLastSearchAndTheDescent) {
    EXPECT_FALSE(RemainingGrowth(100).seconds());
    EXPECT_FALSE(growthTo(1000, 1000, 1.).seconds());
    const std::string growing =
        progressText({500, 0.5, kInfinity, 7}, 1000, growthTo(500, 1000, 1.));
    EXPECT_EQ(growing, "500 of 1000 vertices, no path yet, 7 views, about 0 s to the last search");
    const std::string last = progressText({1000, 11., 3.25, 7}, 1000, growthTo(1000, 1000, 1.));
    EXPECT_EQ(last,
              "1000 of 1000 vertices, best cost 3.250, 7 views, last search and descent, 11 s so "
              "far");
}

}  // namespace
}  // namespace photonav
