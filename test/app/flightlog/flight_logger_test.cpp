// SPDX-License-Identifier: BSD-3-Clause
#include "flightlog/flight_logger.hpp"

#include <gtest/gtest.h>

#include <set>

#include "report/report.hpp"
#include "scene/scene.hpp"

namespace photonav {
namespace {

Config straightFlight() {
    Config config;
    config.bounds = {Eigen::Vector3d(0.5, 0.5, 0.8), Eigen::Vector3d(4.5, 2.5, 1.4)};
    config.start.position = {1., 1.5, 1.1};
    config.start.yaw = 0.;
    config.goal.position = {3., 1.5, 1.1};
    config.space = StateKind::positionYaw;
    config.camera.mount = "front45";
    config.camera.width = 94;
    config.camera.height = 60;
    config.planner = "rrt_star";
    config.explore.vertices = 60;
    config.explore.resolution = 0.1;
    config.explore.timeLimit = 30.;
    return config;
}

Scene room() {
    Scene scene;
    const auto floor = addTexture(scene, valueNoise({.size = {5., 3.}, .seed = 1}));
    addBox(scene, {0., 0., 0.}, {5., 3., 2.5}, floor, BoxInside::hollow);
    return scene;
}

TEST(FlightLogger, HoldsTheMapAndAsManyPicturesAsItMay) {
    const Config config = straightFlight();
    const World world(room(), config);
    const PlanningProblem problem(config, world);
    const TrialItem item{"rrt_star", 1};
    FlightLogger whole(config, world, item), thin(config, world, item, 2);
    std::size_t mostThin = 0;
    const auto pictures = [](const FlightLog& log) {
        return std::count_if(log.moments.begin(), log.moments.end(),
                             [](const LoggedMoment& m) { return !m.pictures.empty(); });
    };
    const ExplorationResult flight =
        explore(setUpExploration(problem), item.planner, item.seed, kNotInterrupted,
                {.moment = [&](const ExplorationMoment& moment) {
                    whole.add(moment);
                    thin.add(moment);
                    mostThin = std::max<std::size_t>(mostThin, pictures(thin.log()));
                }});
    whole.finish(flight);
    thin.finish(flight);
    ASSERT_EQ(flight.end, FlightEnd::arrived) << flight.reason;
    ASSERT_GT(whole.log().moments.size(), 4U);
    EXPECT_EQ(pictures(whole.log()), static_cast<long>(whole.log().moments.size()));
    EXPECT_EQ(thin.log().moments.size(), whole.log().moments.size());
    EXPECT_LE(mostThin, 2U);
    EXPECT_FALSE(thin.log().moments.front().pictures.empty());

    std::set<std::array<int, 3>> cells;
    for (const LoggedMoment& moment : whole.log().moments) {
        for (std::size_t i = 0; i < moment.cells.greys.size(); ++i) {
            const auto* at = moment.cells.indices.data() + 3 * i;
            const std::array<int, 3> index{at[0], at[1], at[2]};
            if (moment.cells.greys[i] == CellChanges::kGone) {
                cells.erase(index);
            } else {
                cells.insert(index);
            }
        }
    }
    EXPECT_EQ(cells.size(), makeReportVoxels(*flight.map).grey.size());
    EXPECT_EQ(whole.log().cell, 0.1);
    // The points flown are all there, and end where the flight ended.
    EXPECT_NEAR(whole.log().rest.back().time, flight.samples.back().time, 1e-4);
    const Eigen::Vector3f last = flight.samples.back().T_c_w.inverse().translation().cast<float>();
    EXPECT_LT((whole.log().rest.back().truth - last).norm(), 1e-5);
}

}  // namespace
}  // namespace photonav
