// SPDX-License-Identifier: BSD-3-Clause
// Flights against their plan and against the truth, in numbers.
#pragma once

#include <limits>
#include <optional>
#include <span>
#include <string>
#include <utility>

#include "flight/flight.hpp"

namespace photonav {

/// Standard deviation of the position (root of the trace of its covariance) predicted at a way
/// along the plan, interpolated [m].
double predictedSigma(std::span<const PlannedView> plan, double distance);

/// Error of a believed position, and its standard deviation in flight and in the plan.
struct PositionError {
    double distance = 0.;   ///< along the plan [m]
    double error = 0.;      ///< distance from the true position [m]
    double believed = 0.;   ///< standard deviation in flight [m]
    double predicted = 0.;  ///< and in the plan [m]
};
PositionError positionError(const FlightSample& sample, std::span<const PlannedView> plan);

/// Squared normalised error (evaluation.hpp) / 6 of the believed against the true pose: 1 on
/// average for consistent covariances. Nothing where the belief has no error to compare with, as a
/// start that is known exactly in some direction.
std::optional<double> neesPerDof(const FlightSample& sample);
/// Mean over the exposures of a flight; NaN without any.
double neesPerDof(const FlightResult& flight);
/// Root mean square error of the believed position, over the exposures of a flight [m]; NaN
/// without any.
double positionRmse(const FlightResult& flight);

/// 95 % bounds of the mean NEES per degree of freedom of so many independent samples with six
/// degrees of freedom each, if covariances are consistent.
std::pair<double, double> neesBounds(std::size_t samples);

/// Numbers are NaN where no flight gave one.
struct FlightSummary {
    static constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

    std::size_t flights = 0, arrived = 0, astray = 0, uncertain = 0, collisions = 0, lost = 0,
                outOfTime = 0;
    double positionRmse = kNone;    ///< of the believed position, over all exposures [m]
    double predictedSigma = kNone;  ///< root mean square over the same [m]
    double within3Sigma = kNone;   ///< share of the exposures with an error within 3 predicted ones
    double believedSigma = kNone;  ///< root mean square over the same [m]
    double nees = kNone;           ///< per degree of freedom, mean over all exposures
    double neesMedian = kNone;     ///< of the median flight: one wrong flight may rule the mean
    double neesAtGoal = kNone;     ///< per degree of freedom, mean over the flights' ends
    double neesLow = kNone, neesHigh = kNone;  ///< neesBounds() of neesAtGoal
    double lostTime = 0.;                      ///< sum [s]
    double duration = kNone;                   ///< mean [s]
    double meanSpeed = kNone;                  ///< mean over the flights [m/s]
    double goalError = kNone;                  ///< median true distance to the goal at the end [m]
    std::size_t photometric = 0;               ///< flights that ended on the goal's image
    double photometricBefore = kNone;          ///< their median goal error when that began [m]
    double photometricAfter = kNone;           ///< and at the end [m]
};
FlightSummary summarise(std::span<const FlightResult> flights, std::span<const PlannedView> plan);

}  // namespace photonav
