// SPDX-License-Identifier: BSD-3-Clause
#include "flight/flight_statistics.hpp"

#include <algorithm>
#include <boost/math/distributions/chi_squared.hpp>
#include <cmath>
#include <tuple>

#include "evaluation/averages.hpp"
#include "evaluation/evaluation.hpp"

namespace photonav {
namespace {

double positionSigma(const Matrix6& covariance) {
    return std::sqrt(covariance.topLeftCorner<3, 3>().trace());
}

Matrix6 predictedCovariance(std::span<const PlannedView> plan, double distance) {
    const auto next =
        std::upper_bound(plan.begin(), plan.end(), distance,
                         [](double d, const PlannedView& view) { return d < view.distance; });
    if (next == plan.begin()) return plan.front().covariance;
    if (next == plan.end()) return plan.back().covariance;
    const auto last = next - 1;
    const double t = (distance - last->distance) / (next->distance - last->distance);
    return (1. - t) * last->covariance + t * next->covariance;
}

void append(const std::optional<double>& value, std::vector<double>& values) {
    if (value) values.push_back(*value);
}

void countEnds(std::span<const FlightResult> flights, FlightSummary& s) {
    const auto n = static_cast<double>(flights.size());
    std::vector<double> errors, before, after, speeds;
    s.duration = 0.;
    for (const FlightResult& flight : flights) {
        s.arrived += flight.end == FlightEnd::arrived;
        s.astray += flight.end == FlightEnd::astray;
        s.uncertain += flight.end == FlightEnd::uncertain;
        s.collisions += flight.end == FlightEnd::collided;
        s.lost += flight.end == FlightEnd::lost;
        s.outOfTime += flight.end == FlightEnd::outOfTime;
        s.lostTime += flight.lostTime;
        s.duration += flight.duration / n;
        append(flight.meanSpeed, speeds);
        errors.push_back(flight.goalError);
        if (!flight.photometric) continue;
        before.push_back(flight.goalErrorBefore);
        after.push_back(flight.goalError);
    }
    s.meanSpeed = mean(speeds, FlightSummary::kNone);
    s.goalError = median(errors, FlightSummary::kNone);
    s.photometric = before.size();
    s.photometricBefore = median(before, FlightSummary::kNone);
    s.photometricAfter = median(after, FlightSummary::kNone);
}

/// RMS position error, RMS predicted and believed sigmas, and mean NEES over all exposures.
void summariseExposures(std::span<const FlightResult> flights, std::span<const PlannedView> plan,
                        FlightSummary& s) {
    double error = 0., predicted = 0., believed = 0., within = 0., n = 0.;
    std::vector<double> nees;
    for (const FlightResult& flight : flights) {
        for (const FlightSample& sample : flight.samples) {
            const PositionError e = positionError(sample, plan);
            error += e.error * e.error;
            predicted += e.predicted * e.predicted;
            believed += e.believed * e.believed;
            append(neesPerDof(sample), nees);
            within += e.error <= 3. * e.predicted;
            ++n;
        }
    }
    s.positionRmse = std::sqrt(error / n);
    s.predictedSigma = std::sqrt(predicted / n);
    s.believedSigma = std::sqrt(believed / n);
    s.within3Sigma = within / n;
    s.nees = mean(nees, FlightSummary::kNone);
}

}  // namespace

double predictedSigma(std::span<const PlannedView> plan, double distance) {
    return positionSigma(predictedCovariance(plan, distance));
}

PositionError positionError(const FlightSample& sample, std::span<const PlannedView> plan) {
    const Eigen::Vector3d believed = sample.belief.mean.inverse().translation();
    return {.distance = sample.distance,
            .error = (believed - sample.T_c_w.inverse().translation()).norm(),
            .believed = positionSigma(sample.belief.covariance),
            .predicted = predictedSigma(plan, sample.distance)};
}

std::optional<double> neesPerDof(const FlightSample& sample) {
    const auto squared = squaredNormalisedError(sample.belief, sample.T_c_w);
    if (!squared) return {};
    return *squared / 6.;
}

double neesPerDof(const FlightResult& flight) {
    std::vector<double> values;
    for (const FlightSample& sample : flight.samples) append(neesPerDof(sample), values);
    return mean(values, FlightSummary::kNone);
}

double positionRmse(const FlightResult& flight) {
    double sum = 0.;
    for (const FlightSample& sample : flight.samples) {
        const Eigen::Vector3d believed = sample.belief.mean.inverse().translation();
        sum += (believed - sample.T_c_w.inverse().translation()).squaredNorm();
    }
    return std::sqrt(sum / static_cast<double>(flight.samples.size()));
}

std::pair<double, double> neesBounds(std::size_t samples) {
    const double degrees = 6. * static_cast<double>(samples);
    const boost::math::chi_squared distribution(degrees);
    return {quantile(distribution, 0.025) / degrees, quantile(distribution, 0.975) / degrees};
}

FlightSummary summarise(std::span<const FlightResult> flights, std::span<const PlannedView> plan) {
    FlightSummary s;
    s.flights = flights.size();
    if (flights.empty()) return s;
    countEnds(flights, s);
    summariseExposures(flights, plan, s);
    std::vector<double> nees, atGoal;
    for (const FlightResult& flight : flights) {
        if (const double x = neesPerDof(flight); !std::isnan(x)) nees.push_back(x);
        append(neesPerDof(flight.samples.back()), atGoal);
    }
    s.neesAtGoal = mean(atGoal, FlightSummary::kNone);
    s.neesMedian = median(nees, FlightSummary::kNone);
    std::tie(s.neesLow, s.neesHigh) = neesBounds(s.flights);
    return s;
}

}  // namespace photonav
