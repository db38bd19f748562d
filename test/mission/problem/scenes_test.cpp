// SPDX-License-Identifier: BSD-3-Clause
// The configs of unknown scenes: they load, and start and goal are where they are said to be.
#include <gtest/gtest.h>
#include <ompl/base/goals/GoalStates.h>

#include "problem/planning_problem.hpp"

namespace photonav {
namespace {

struct UnknownScene {
    const char* name;
    double distance;     // from start to goal [m]
    bool isWayStraight;  // whether the robot can fly directly
};

class UnknownScenes : public testing::TestWithParam<UnknownScene> {};
INSTANTIATE_TEST_SUITE_P(Configs, UnknownScenes,
                         testing::Values(UnknownScene{"unknown_room_1", 7.3, false},
                                         UnknownScene{"unknown_room_2", 8.8, true},
                                         UnknownScene{"unknown_room_3", 8.4, false},
                                         UnknownScene{"labyrinth", 25., false},
                                         UnknownScene{"labyrinth_one_side", 25., false},
                                         UnknownScene{"kitchen", 12.5, false}));

TEST_P(UnknownScenes, LeadFromAFreeStartToAFreeGoal) {
    const UnknownScene scene = GetParam();
    const Config config =
        loadConfig(std::string(PHOTONAV_SOURCE_DIR "/config/") + scene.name + ".yaml");
    EXPECT_EQ(config.belief.alpha, 0.1);
    EXPECT_NEAR((config.goal.position - config.start.position).norm(), scene.distance, 0.05);
    const World world(config);
    PlanningProblem problem(config, world);
    EXPECT_NO_THROW(problem.checkPlaces());
    const auto definition = problem.definition();
    const auto* goal = definition->getGoal()->as<ompl::base::GoalStates>()->getState(0);
    EXPECT_EQ(problem.spaceInformation()->checkMotion(definition->getStartState(0), goal),
              scene.isWayStraight);
    EXPECT_GT(problem.informationAt(problem.space().bodyPose(definition->getStartState(0)))(0, 0),
              1e3);
}

}  // namespace
}  // namespace photonav
