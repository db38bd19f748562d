// SPDX-License-Identifier: BSD-3-Clause
#include "flightlog/flight_logger.hpp"

#include <gtest/gtest.h>

#include <set>

#include "mission/exploration/room_to_explore.hpp"
#include "shapes/surroundings.hpp"

namespace photonav {
namespace {

Config straightFlight() {
    Config config = test::flightThroughRoom();
    config.goal.position.x() = 3.;
    config.explore.vertices = 60;
    config.explore.resolution = 0.1;
    config.explore.timeLimit = 30.;
    return config;
}

TEST(FlightLogger, HoldsTheMapAndAsManyPicturesAsItMay) {
    const Config config = straightFlight();
    const World world(test::roomToExplore(), config);
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
    EXPECT_EQ(cells.size(), drawnVoxels(*flight.map).grey.size());
    EXPECT_EQ(whole.log().cell, 0.1);
    // The points flown are all there, and end where the flight ended.
    EXPECT_NEAR(whole.log().rest.back().time, flight.samples.back().time, 1e-4);
    const Eigen::Vector3f last = flight.samples.back().T_c_w.inverse().translation().cast<float>();
    EXPECT_LT((whole.log().rest.back().truth - last).norm(), 1e-5);
}

}  // namespace
}  // namespace photonav
