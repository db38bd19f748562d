// SPDX-License-Identifier: BSD-3-Clause
// Many flights of a plan, and what they amount to.
#pragma once

#include <atomic>
#include <functional>
#include <limits>
#include <optional>

#include "flight.hpp"
#include "plan_run.hpp"

namespace photonav {

/// The plan as the flight needs it. A flight looks around at the start, which plans do not count:
/// for the start, and for it alone, the covariance here is that with an image.
std::vector<PlannedView> plannedViews(const JudgedPath& path);

/// Standard deviation of the position (root of the trace of its covariance) predicted at a way
/// along the plan, interpolated [m].
double predictedSigma(const std::vector<PlannedView>& plan, double distance);

/// The flights of one plan.
struct FlightSet {
    JudgedPath path;
    std::vector<PlannedView> plan;
    std::vector<FlightResult> flights;  ///< those that were not stopped, in order of their number
};

/// "0.537 m", "3.75 mm".
std::string lengthText(double metres);

/// Error of a believed position and what was predicted and believed of it.
struct PositionError {
    double distance = 0.;   ///< along the plan [m]
    double error = 0.;      ///< of the believed against the true position [m]
    double believed = 0.;   ///< standard deviation in flight [m]
    double predicted = 0.;  ///< and in the plan [m]
};
PositionError positionError(const FlightSample& sample, const std::vector<PlannedView>& plan);

/// Squared normalised error (evaluation.hpp) / 6 of the believed against the true pose: 1 on
/// average when honest. Nothing where the belief has no error to compare with, as a start that is
/// known in some direction.
std::optional<double> neesPerDof(const FlightSample& sample);
/// Mean over its exposures; one that was misled shows.
double neesPerDof(const FlightResult& flight);

/// Numbers are NaN where no flight gave one.
struct FlightSummary {
    static constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

    std::size_t flights = 0, arrived = 0, astray = 0, collisions = 0, lost = 0, outOfTime = 0;
    double positionRmse = kNone;    ///< of the believed position, over all exposures [m]
    double predictedSigma = kNone;  ///< root mean square over the same [m]
    double within3Sigma = kNone;   ///< share of the exposures with an error within 3 predicted ones
    double believedSigma = kNone;  ///< root mean square over the same [m]
    double nees = kNone;           ///< per degree of freedom, mean over all exposures
    double neesMedian = kNone;     ///< the median flight's: a mean may be that of one misled flight
    double neesAtGoal = kNone;     ///< per degree of freedom, mean over the flights' ends
    /// Within which neesAtGoal lies in 95 % of honest cases: chi-square with 6 degrees of freedom
    /// for every flight.
    double neesLow = kNone, neesHigh = kNone;
    double lostTime = 0.;              ///< sum [s]
    double duration = kNone;           ///< mean [s]
    double goalError = kNone;          ///< median true distance to the goal at the end [m]
    std::size_t photometric = 0;       ///< flights that ended on the goal's image
    double photometricBefore = kNone;  ///< their median goal error when that began [m]
    double photometricAfter = kNone;   ///< and at the end [m]
};
FlightSummary summarise(const FlightSet& set);

/// Quantile of the chi-square distribution (Wilson and Hilferty 1931), for many degrees of freedom.
/// @param z the quantile of the normal distribution
double chiSquareQuantile(double degrees, double z);

/// Flies number 0 to `count` - 1 on `jobs` threads; the seed of a flight follows from
/// options.seed and its number, so that plans meet the same luck.
/// @param onFlight called as flights end, in any order, one at a time
/// @param onExposure of flight 0
std::vector<FlightResult> flyMany(const std::vector<PlannedView>& plan, const FlightWorld& world,
                                  const FlightOptions& options, unsigned count, unsigned jobs,
                                  const std::atomic<bool>& interrupted,
                                  const std::function<void(const FlightResult&)>& onFlight,
                                  const OnExposure& onExposure);

}  // namespace photonav
