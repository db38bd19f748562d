// SPDX-License-Identifier: BSD-3-Clause
#include "flight/flight_statistics.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "flight/flight_set.hpp"

namespace photonav {
namespace {

/// Believed positions known to be off by 3 and 9 sigma in one direction, of which one in six
/// counts.
TEST(FlightSummary, ComparesErrorsWithWhatWasPredicted) {
    FlightSet set;
    PlannedView from, to;
    from.covariance = 0.01 * Matrix6::Identity();
    to.covariance = 0.04 * Matrix6::Identity();
    to.distance = 2.;
    set.plan = {from, to};
    FlightResult flight;
    flight.end = FlightEnd::arrived;
    FlightSample sample;
    sample.distance = 1.;
    sample.belief.covariance = 0.01 * Matrix6::Identity();
    sample.T_c_w.translation().x() = 0.3;
    FlightSample worse = sample;
    worse.T_c_w.translation().x() = 0.9;
    flight.samples = {sample, worse};
    set.flights = {flight};
    const FlightSummary s = summarise(set);
    EXPECT_EQ(s.arrived, 1U);
    EXPECT_NEAR(s.positionRmse, std::sqrt(0.45), 1e-12);
    EXPECT_NEAR(positionRmse(flight), std::sqrt(0.45), 1e-12);
    EXPECT_EQ(std::pair(s.neesLow, s.neesHigh), neesBounds(1)) << "at the goal, of one flight";
    EXPECT_NEAR(s.believedSigma, std::sqrt(0.03), 1e-12);
    EXPECT_NEAR(s.predictedSigma, std::sqrt(0.075), 1e-12);
    EXPECT_NEAR(s.nees, 0.5 * (9. + 81.) / 6., 1e-12);
    EXPECT_NEAR(s.neesAtGoal, 81. / 6., 1e-12);
    EXPECT_NEAR(s.neesMedian, s.nees, 1e-12);
    EXPECT_EQ(s.within3Sigma, 0.5);
    EXPECT_NEAR(neesBounds(100).second, 669.77 / 600., 1e-4);  // tables: 669.77
    EXPECT_NEAR(neesBounds(1).first, 1.237 / 6., 1e-3);        // tables: 1.237
}

/// Where a belief is certain there is nothing to divide an error by.
TEST(FlightSummary, BeliefsWithoutAnErrorDoNotCount) {
    FlightSample certain, sample;
    sample.belief.covariance = 0.01 * Matrix6::Identity();
    sample.T_c_w.translation().x() = 0.3;
    EXPECT_FALSE(neesPerDof(certain));
    FlightResult flight;
    flight.samples = {certain, sample};
    EXPECT_NEAR(neesPerDof(flight), 1.5, 1e-12);
    FlightSet set;
    set.plan = {PlannedView{}};
    set.flights = {flight};
    EXPECT_NEAR(summarise(set).nees, 1.5, 1e-12);
}

TEST(FlightSummary, CountsEndsAndAveragesTheRest) {
    FlightSet set;
    set.plan = {PlannedView{}};
    for (const FlightEnd end : {FlightEnd::arrived, FlightEnd::arrived, FlightEnd::astray,
                                FlightEnd::uncertain, FlightEnd::collided, FlightEnd::lost,
                                FlightEnd::lost, FlightEnd::lost, FlightEnd::outOfTime}) {
        FlightResult flight;
        flight.end = end;
        flight.samples.resize(1);
        flight.duration = 9.;
        flight.lostTime = 0.5;
        flight.goalError = 0.1 * static_cast<double>(set.flights.size());
        set.flights.push_back(flight);
    }
    set.flights[1].meanSpeed = 0.5;
    set.flights[2].meanSpeed = 1.;
    set.flights[1].photometric = true;
    set.flights[1].goalErrorBefore = 0.3;
    const FlightSummary s = summarise(set);
    EXPECT_EQ(s.flights, 9U);
    EXPECT_EQ(s.arrived, 2U);
    EXPECT_EQ(s.astray, 1U);
    EXPECT_EQ(s.uncertain, 1U);
    EXPECT_EQ(s.collisions, 1U);
    EXPECT_EQ(s.lost, 3U);
    EXPECT_EQ(s.outOfTime, 1U);
    EXPECT_NEAR(s.lostTime, 4.5, 1e-12);
    EXPECT_NEAR(s.duration, 9., 1e-12);
    EXPECT_NEAR(s.meanSpeed, 0.75, 1e-12) << "of the flights that have one";
    EXPECT_NEAR(s.goalError, 0.4, 1e-12) << "the median";
    EXPECT_EQ(s.photometric, 1U);
    EXPECT_EQ(s.photometricBefore, 0.3);
    EXPECT_NEAR(s.photometricAfter, 0.1, 1e-12);
}

TEST(FlightSummary, CountsErrorsWithinThreePredictedSigmas) {
    FlightSet set;
    set.plan = {PlannedView{}};
    set.plan.front().covariance = 0.01 * Matrix6::Identity();  // 3 sigma: 0.52 m
    FlightResult flight;
    for (const double error : {0.4, 0.5, 0.55}) {
        FlightSample sample;
        sample.belief.covariance = 1e-4 * Matrix6::Identity();
        sample.T_c_w.translation().y() = error;
        flight.samples.push_back(sample);
    }
    set.flights = {flight};
    EXPECT_NEAR(summarise(set).within3Sigma, 2. / 3., 1e-12);
}

TEST(PredictedSigma, IsInterpolatedBetweenViewsAndConstantBeyond) {
    std::vector<PlannedView> plan(3);
    for (int i = 0; i < 3; ++i) {
        plan[i].distance = i;
        plan[i].covariance = 0.01 * (i + 1.) * Matrix6::Identity();
    }
    EXPECT_NEAR(predictedSigma(plan, 1.25), std::sqrt(3. * 0.0225), 1e-12);
    EXPECT_NEAR(predictedSigma(plan, -1.), std::sqrt(0.03), 1e-12);
    EXPECT_NEAR(predictedSigma(plan, 7.), std::sqrt(0.09), 1e-12);
}

}  // namespace
}  // namespace photonav
