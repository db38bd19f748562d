// SPDX-License-Identifier: BSD-3-Clause
#include "exploration/explorations.hpp"

#include <gtest/gtest.h>

#include "flight/flight_statistics.hpp"
#include "io/error.hpp"
#include "mission/exploration/room_to_explore.hpp"

namespace photonav {
namespace {

/// An exposure whose position is believed this far off, in x.
FlightSample sampleWith(double error, double variance) {
    FlightSample sample;
    sample.belief.mean.translation().x() = error;
    sample.belief.covariance = variance * Matrix6::Identity();
    return sample;
}

ExplorationResult flightWith(FlightEnd end, double goalError, std::vector<FlightSample> samples) {
    ExplorationResult flight;
    flight.planner = "rrt_star";
    flight.end = end;
    flight.goalError = goalError;
    flight.samples = std::move(samples);
    return flight;
}

PlanUpdate updateTaking(double fuse, double clearance, double plan) {
    PlanUpdate update;
    update.fuseSeconds = fuse;
    update.clearanceSeconds = clearance;
    update.viewSeconds = 0.5 * plan;  // part of planning
    update.planSeconds = plan;
    return update;
}

TEST(ExplorationSummary, CountsEndsAndAveragesTheRest) {
    std::vector<ExplorationResult> flights{
        flightWith(FlightEnd::arrived, 0.1, {sampleWith(0.1, 0.01)}),
        flightWith(FlightEnd::collided, 4., {}),
        flightWith(FlightEnd::lost, 0.3,
                   {sampleWith(0.3, 0.01), sampleWith(0.3, 0.01), sampleWith(0.3, 0.04)})};
    for (std::size_t i = 0; i < 3; ++i) {
        flights[i].duration = 10. * static_cast<double>(i + 1);
        flights[i].flown = static_cast<double>(i);
    }
    flights[0].decidedAfter = 1.5;
    const ExplorationSummary s = summarise(flights, 2.);
    EXPECT_EQ(s.planner, "rrt_star");
    EXPECT_EQ(s.flights, 3U);
    EXPECT_EQ(s.arrived, 1U);
    EXPECT_EQ(s.collisions, 1U);
    EXPECT_EQ(s.goalError, 0.3);
    EXPECT_NEAR(s.duration, 20., 1e-9);
    EXPECT_NEAR(s.length, 1., 1e-9);
    EXPECT_EQ(s.decidedAfter, 1.5);  // of those that arrived
    // Over exposures, not over flights: a long flight counts for more.
    EXPECT_NEAR(s.positionRmse, std::sqrt((0.01 + 3. * 0.09) / 4.), 1e-9);
    const double unit = 3. + 3. * 4.;  // a radian counts as two metres
    EXPECT_NEAR(s.meanTrace, unit * (0.01 + 0.01 + 0.01 + 0.04) / 4., 1e-9);
    EXPECT_NEAR(s.goalTrace, unit * (0.01 + 0.04) / 2., 1e-9);
    // One per degree of freedom of each flight: 0.01 / 0.01 / 6 and 0.09 (2 / 0.01 + 1 / 0.04)
    // / 18.
    EXPECT_NEAR(s.nees, 0.5 * (1. / 6. + 0.09 * 225. / 18.), 1e-9);
    EXPECT_NEAR(s.neesMedian, s.nees, 1e-9);  // of two
}

TEST(ExplorationSummary, TimesOfUpdatesAreOverAllFlights) {
    std::vector<ExplorationResult> flights(2);
    for (int i = 1; i <= 100; ++i) {
        flights[i % 2].updates.push_back(updateTaking(0.001, 0.002, 0.01 * i - 0.003));
    }
    EXPECT_NEAR(seconds(flights[1].updates[0]), 0.01, 1e-9);
    const ExplorationSummary s = summarise(flights, 1.);
    EXPECT_NEAR(s.updateMedian, 0.51, 1e-9);
    EXPECT_NEAR(s.update95, 0.95, 1e-9);
}

TEST(ExplorationSummary, HasNoNumbersWhereNoFlightGaveOne) {
    const ExplorationSummary none = summarise({}, 1.);
    EXPECT_EQ(none.flights, 0U);
    EXPECT_TRUE(std::isnan(none.positionRmse) && std::isnan(none.goalError));
    const std::vector<ExplorationResult> flights{flightWith(FlightEnd::stopped, 5., {})};
    const ExplorationSummary s = summarise(flights, 1.);
    EXPECT_EQ(s.flights, 1U);
    EXPECT_EQ(s.goalError, 5.);
    for (const double value : {s.positionRmse, s.nees, s.neesMedian, s.meanTrace, s.goalTrace,
                               s.updateMedian, s.update95}) {
        EXPECT_TRUE(std::isnan(value));
    }
}

/// A start that is known exactly has no error to compare with: its flight has no NEES.
TEST(ExplorationSummary, FlightsWithoutANeesDoNotHideThatOfOthers) {
    const std::vector<ExplorationResult> flights{
        flightWith(FlightEnd::arrived, 0.1, {sampleWith(0.1, 0.)}),
        flightWith(FlightEnd::arrived, 0.1, {sampleWith(0.1, 0.01)})};
    const ExplorationSummary s = summarise(flights, 1.);
    EXPECT_NEAR(s.nees, 1. / 6., 1e-9);
    EXPECT_NEAR(s.neesMedian, 1. / 6., 1e-9);
}

TEST(ExplorationSummary, ThereIsOneForEachPlanner) {
    std::vector<ExplorationResult> flights(5);
    for (std::size_t i = 0; i < 5; ++i) flights[i].planner = i < 2 ? "rrbt" : "rrt_star";
    const auto summaries = summariesByPlanner(flights, 1.);
    ASSERT_EQ(summaries.size(), 2U);
    EXPECT_EQ(summaries[0].planner, "rrbt");
    EXPECT_EQ(summaries[0].flights, 2U);
    EXPECT_EQ(summaries[1].planner, "rrt_star");
    EXPECT_EQ(summaries[1].flights, 3U);
    EXPECT_TRUE(summariesByPlanner({}, 1.).empty());
}

/// A flight of half a metre.
class ShortFlight : public testing::Test {
  protected:
    ShortFlight() {
        config.goal.position.x() = 1.5;
        config.explore.vertices = 60;
        world.emplace(test::roomToExplore(), config);
        problem.emplace(config, *world);
    }

    Config config = test::flightThroughRoom();
    std::optional<World> world;
    std::optional<PlanningProblem> problem;
};

TEST_F(ShortFlight, AnInterruptedSetKeepsItsFirstFlight) {
    const std::atomic<bool> interrupted{true};
    std::vector<ExplorationResult> flights;
    config.explore.trials = 3;
    exploreMany(setUpExploration(*problem), trialItems(config), 1, interrupted,
                {.end = [&](ExplorationResult flight) { flights.push_back(std::move(flight)); }});
    ASSERT_EQ(flights.size(), 1U);
    EXPECT_EQ(flights[0].end, FlightEnd::stopped);
    EXPECT_EQ(itemOf(flights[0]), trialItems(config).front());
}

TEST_F(ShortFlight, EveryEndAndEveryUpdateIsReported) {
    std::size_t ended = 0, updated = 0, updates = 0;
    const auto onEnd = [&](const ExplorationResult& flight) {
        ++ended;
        updates += flight.updates.size();
    };
    const auto onUpdate = [&](const ExplorationResult& soFar) {
        ++updated;
        EXPECT_FALSE(soFar.updates.empty());
    };
    exploreMany(setUpExploration(*problem), {{"rrt_star", 1}, {"rrt_star", 2}}, 2, kNotInterrupted,
                {onEnd, onUpdate});
    EXPECT_EQ(ended, 2U);
    EXPECT_GT(updated, 0U);
    EXPECT_EQ(updated, updates);
}

TEST_F(ShortFlight, TrialsAreListedByPlannerThenBySeed) {
    config.seed = 4294967294U;
    config.explore.trials = 2;
    config.explore.planners = {"rrt_star/once", "rrbt"};
    const std::vector<TrialItem> expected{{"rrt_star/once", 4294967294U},
                                          {"rrt_star/once", 4294967295U},
                                          {"rrbt", 4294967294U},
                                          {"rrbt", 4294967295U}};
    EXPECT_EQ(trialItems(config), expected);
    config.explore.planners = {};
    config.planner = "pa_rrt_star";
    EXPECT_EQ(trialItems(config).front().planner, "pa_rrt_star");
    config.explore.trials = 3;
    EXPECT_THROW(trialItems(config), InputError);
}

}  // namespace
}  // namespace photonav
