// SPDX-License-Identifier: BSD-3-Clause
#include "config/explore_planner.hpp"

#include <gtest/gtest.h>

#include <numbers>

#include "geometry/se3.hpp"
#include "mission/exploration/room_to_explore.hpp"
#include "replanning/online_planner.hpp"

namespace photonav {
namespace {

TEST(ExplorePlanner, IsNamedByPlannerAndPolicy) {
    EXPECT_EQ(explorePlanner("pa_rrt_star").replanning, Replanning::repair);
    EXPECT_FALSE(explorePlanner("pa_rrt_star").headings);
    EXPECT_EQ(explorePlanner("rrt_star/fixed").headings, Headings::fixed);
    EXPECT_EQ(explorePlanner("rrt_star/forward").headings, Headings::forward);
    EXPECT_EQ(explorePlanner("rrt_star/forward").name, "rrt_star");
    EXPECT_EQ(explorePlanner("belief_rrt_star/replan").replanning, Replanning::scratch);
    EXPECT_EQ(explorePlanner("belief_rrt_star/once").replanning, Replanning::never);
    for (const char* unknown : {"rrt", "", "/once", "rrt_star/", "rrt_star/sometimes"}) {
        EXPECT_THROW(explorePlanner(unknown), std::invalid_argument) << unknown;
    }
}

/// A robot that plans over 5 m of unknown space and then sees a wall, or nothing.
class OnlinePlannerTest : public ::testing::Test {
  protected:
    OnlinePlannerTest() {
        config_.bounds = {Eigen::Vector3d(-0.5, -2., 0.8), Eigen::Vector3d(6., 2., 1.2)};
        config_.start.position = {0., 0., 1.};
        config_.goal.position = {5., 0.5, 1.};
        config_.camera.width = 40;
        config_.camera.height = 30;
        config_.explore.vertices = 150;
        map_ = std::make_unique<OnlineMap>(config_);
    }

    OnlinePlanner planner(const std::string& name) {
        return {config_, *map_, explorePlanner(name), 1};
    }

    /// @param p_w of the robot, which looks along x
    PlanUpdate updateAt(OnlinePlanner& planner, const Eigen::Vector3d& p_w,
                        const MapChange& change = {}, double seconds = kInfinity) {
        return updateAt(planner, levelPose(p_w, 0.), change, seconds);
    }

    PlanUpdate updateAt(OnlinePlanner& planner, const Pose& T_w_b, const MapChange& change = {},
                        double seconds = kInfinity) {
        PlanUpdate update;
        planner.update(
            change, {(T_w_b * config_.camera.T_b_c()).inverse(), config_.explore.initialCovariance},
            update, {kNotInterrupted, seconds});
        return update;
    }

    /// A wall across the straight way, with room beside it if it is not wider than 3 m.
    MapChange seeWall(double width = 2.) {
        MapChange change{.resolution = config_.explore.cell()};
        for (double y = -width / 2.; y < width / 2.; y += change.resolution) {
            for (double z = 0.5; z < 1.5; z += change.resolution) {
                map_->obstacles()->updateNode(
                    octomap::point3d(2.5F, static_cast<float>(y), static_cast<float>(z)), true);
                const Eigen::Array3d brick =
                    Eigen::Array3d(2.5, y, z) / (MapChange::kBrickEdge * change.resolution);
                change.occupancy.emplace_back(brick.floor().cast<int>());
            }
        }
        change.normalize();
        return change;
    }

    Config config_ = test::flightThroughRoom();
    std::unique_ptr<OnlineMap> map_;
};

/// What a heading that drifts does to the position: the gyroscope limits it.
TEST_F(OnlinePlannerTest, PlansWithTheGyroscopeThatTheRobotHas) {
    config_.belief.motionNoise.diagonal() << 1e-6, 1e-6, 1e-6, 1e-4, 1e-4, 1e-2;
    const auto varianceAtGoal = [&](double noise, double speed) {
        config_.explore.gyroscopeNoise = noise;
        config_.fly.speed = speed;
        OnlinePlanner straight = planner("rrt_star");
        updateAt(straight, config_.start.position);
        return straight.path().back().covariance.topLeftCorner<3, 3>().trace();
    };
    const double without = varianceAtGoal(0., 1.), with = varianceAtGoal(1e-3, 1.);
    EXPECT_GT(without, 0.1);
    EXPECT_LT(with, 1e-3 * without);
    EXPECT_GT(varianceAtGoal(1e-3, 0.1), 2. * with) << "it drifts for longer";
}

TEST_F(OnlinePlannerTest, HeadingsAreThoseOfThePolicy) {
    OnlinePlanner fixed = planner("rrt_star/fixed"), forward = planner("rrt_star/forward");
    updateAt(fixed, {0., 0., 1.});
    updateAt(forward, {0., 0., 1.});
    ASSERT_FALSE(fixed.path().empty());
    ASSERT_FALSE(forward.path().empty());
    for (const BeliefPoint& point : fixed.path()) EXPECT_NEAR(yawOf(point.T_w_b), 0., 1e-9);
    for (std::size_t i = 1; i < forward.path().size(); ++i) {
        const Pose& here = forward.path()[i].T_w_b;
        const Eigen::Vector3d leg = here.translation() - forward.path()[i - 1].T_w_b.translation();
        if (leg.head<2>().norm() < 0.1) continue;
        const double off = yawOf(here) - std::atan2(leg.y(), leg.x());
        EXPECT_NEAR(std::remainder(off, 2. * std::numbers::pi), 0., 1e-6);
    }
}

TEST_F(OnlinePlannerTest, APlanMadeOnceIsFlownToItsEnd) {
    OnlinePlanner once = planner("rrt_star/once");
    const double whole = updateAt(once, {0., 0., 1.}).length;
    const Eigen::Vector3d halfWay = once.path()[once.path().size() / 2].T_w_b.translation();
    const PlanUpdate update = updateAt(once, halfWay);
    ASSERT_FALSE(once.path().empty());
    EXPECT_NEAR(update.length, whole / 2., 0.15 * whole);
    EXPECT_EQ(update.counts.verticesAdded, 0U);
}

TEST_F(OnlinePlannerTest, APlanMadeOnceEndsAtAnObstacle) {
    OnlinePlanner once = planner("rrt_star/once"), repaired = planner("rrt_star");
    updateAt(once, {0., 0., 1.});
    updateAt(repaired, {0., 0., 1.});
    const MapChange change = seeWall();
    updateAt(once, {0.5, 0., 1.}, change);
    updateAt(repaired, {0.5, 0., 1.}, change);
    EXPECT_TRUE(once.path().empty());
    EXPECT_FALSE(repaired.path().empty());
    updateAt(once, {0.5, 0., 1.});
    EXPECT_TRUE(once.path().empty()) << "it does not plan again";
}

/// From near a wall the camera may see that there is none.
TEST_F(OnlinePlannerTest, WithoutAWayToTheGoalItLooksAtTheGoalFromTheNearestPlace) {
    const Eigen::Vector3d goal = config_.goal.position;
    for (const char* name : {"pa_rrt_star", "rrt_star/forward", "belief_rrt_star/replan"}) {
        OnlinePlanner planner = this->planner(name);
        updateAt(planner, {0., 0., 1.});
        EXPECT_TRUE(planner.reachesGoal()) << name;
        const PlanUpdate update = updateAt(planner, {0.2, 0., 1.}, seeWall(5.));
        EXPECT_FALSE(planner.reachesGoal()) << name;
        EXPECT_TRUE(std::isnan(update.length)) << name;
        ASSERT_FALSE(planner.path().empty()) << name;
        const Pose& end = planner.path().back().T_w_b;
        EXPECT_NEAR(end.translation().x(), 2., 0.4) << name << ", in front of the wall";
        const Eigen::Vector3d view = goal - end.translation();
        EXPECT_NEAR(yawOf(end), std::atan2(view.y(), view.x()), 0.3) << name;
        updateAt(planner, Pose(end));
        EXPECT_TRUE(planner.path().empty()) << name << " sees the goal from there";
        map_ = std::make_unique<OnlineMap>(config_);
    }
}

TEST_F(OnlinePlannerTest, FromScratchKeepsNothing) {
    OnlinePlanner scratch = planner("rrt_star/replan"), repaired = planner("rrt_star");
    updateAt(scratch, {0., 0., 1.});
    updateAt(repaired, {0., 0., 1.});
    const std::size_t all = 10 * config_.explore.vertices;  // as rival
    EXPECT_EQ(updateAt(scratch, {0.2, 0., 1.}).counts.verticesAdded, all);
    EXPECT_LT(updateAt(repaired, {0.2, 0., 1.}).counts.verticesAdded, all / 2);
}

/// Without any time there is a path, but nothing is improved; with time again, it is.
TEST_F(OnlinePlannerTest, TheClockEndsImprovementsAfterTheFirstPath) {
    for (const char* name : {"rrt_star", "belief_rrt_star"}) {
        OnlinePlanner hurried = planner(name);
        EXPECT_TRUE(updateAt(hurried, {0., 0., 1.}, {}, 0.).isEndedByClock) << name;
        ASSERT_FALSE(hurried.path().empty()) << name;
        const std::size_t few = hurried.planner().samples();
        EXPECT_FALSE(updateAt(hurried, {0., 0., 1.}).isEndedByClock) << name;
        EXPECT_LT(few, hurried.planner().samples()) << name;
    }
}

}  // namespace
}  // namespace photonav
