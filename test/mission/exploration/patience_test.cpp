// SPDX-License-Identifier: BSD-3-Clause
#include "exploration/patience.hpp"

#include <gtest/gtest.h>

namespace photonav {
namespace {

TEST(Patience, EndsAfterSeveralUpdatesWithoutAWay) {
    Patience patience;
    for (int i = 0; i < 5; ++i) patience.onNoWay(10. + i);
    EXPECT_FALSE(patience.hasNoWay(100.));
    patience.onNoWay(15.);
    EXPECT_TRUE(patience.hasNoWay(15.));
    patience.onWay(false, 16.);
    EXPECT_FALSE(patience.hasNoWay(100.));
}

TEST(Patience, ManyUpdatesAtOnceAreNoLongTime) {
    Patience patience;
    for (int i = 0; i < 20; ++i) patience.onNoWay(10.);
    EXPECT_FALSE(patience.hasNoWay(11.));
    EXPECT_TRUE(patience.hasNoWay(12.));
}

TEST(Patience, EndsBeforeAnObstacleThatDoesNotEnterTheMap) {
    Patience patience;
    EXPECT_FALSE(patience.isStopped(100.));
    patience.onWay(true, 10.);
    patience.onWay(true, 15.);
    EXPECT_FALSE(patience.isStopped(19.));
    EXPECT_TRUE(patience.isStopped(21.));
    patience.onWay(false, 21.);
    patience.onWay(true, 22.);
    EXPECT_FALSE(patience.isStopped(30.));
}

TEST(Patience, EndsAroundTheGoalUnlessTheRobotWasCarriedAway) {
    Patience patience;
    patience.onStep(1., false, 10.);
    EXPECT_FALSE(patience.isStuckAtGoal(100.));
    patience.onStep(0.1, true, 20.);
    patience.onStep(1., false, 45.);
    EXPECT_FALSE(patience.isStuckAtGoal(49.));
    EXPECT_TRUE(patience.isStuckAtGoal(51.));
    patience.onStep(3., false, 52.);
    EXPECT_FALSE(patience.isStuckAtGoal(100.));
}

}  // namespace
}  // namespace photonav
