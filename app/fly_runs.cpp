// SPDX-License-Identifier: BSD-3-Clause
#include "fly_runs.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <exception>
#include <mutex>
#include <thread>

#include "averages.hpp"
#include "evaluation.hpp"

namespace photonav {
namespace {

double positionSigma(const Matrix6& covariance) {
    return std::sqrt(covariance.topLeftCorner<3, 3>().trace());
}

Matrix6 predictedCovariance(const std::vector<PlannedView>& plan, double distance) {
    const auto next =
        std::upper_bound(plan.begin(), plan.end(), distance,
                         [](double d, const PlannedView& view) { return d < view.distance; });
    if (next == plan.begin()) return plan.front().covariance;
    if (next == plan.end()) return plan.back().covariance;
    const auto last = next - 1;
    const double t = (distance - last->distance) / (next->distance - last->distance);
    return (1. - t) * last->covariance + t * next->covariance;
}

void countEnds(const std::vector<FlightResult>& flights, FlightSummary& s) {
    const auto n = static_cast<double>(flights.size());
    std::vector<double> errors, before, after;
    s.duration = 0.;
    for (const FlightResult& flight : flights) {
        s.arrived += flight.end == FlightEnd::arrived;
        s.astray += flight.end == FlightEnd::astray;
        s.collisions += flight.end == FlightEnd::collided;
        s.lost += flight.end == FlightEnd::lost;
        s.outOfTime += flight.end == FlightEnd::outOfTime;
        s.lostTime += flight.lost;
        s.duration += flight.duration / n;
        errors.push_back(flight.goalError);
        if (!flight.photometric) continue;
        before.push_back(flight.goalErrorBefore);
        after.push_back(flight.goalError);
    }
    s.goalError = median(errors, FlightSummary::kNone);
    s.photometric = before.size();
    s.photometricBefore = median(before, FlightSummary::kNone);
    s.photometricAfter = median(after, FlightSummary::kNone);
}

void append(const std::optional<double>& value, std::vector<double>& values) {
    if (value) values.push_back(*value);
}

/// Errors against what was predicted and believed, over all exposures.
void judgeExposures(const FlightSet& set, FlightSummary& s) {
    double error = 0., predicted = 0., believed = 0., within = 0., n = 0.;
    std::vector<double> nees;
    for (const FlightResult& flight : set.flights) {
        for (const FlightSample& sample : flight.samples) {
            const PositionError e = positionError(sample, set.plan);
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

std::vector<PlannedView> plannedViews(const JudgedPath& path) {
    std::vector<PlannedView> plan;
    for (const BeliefPoint& point : path.points) {
        plan.push_back({point.T_w_b, point.covariance, point.length, point.isWaypoint});
    }
    const BeliefPoint& start = path.points.front();
    plan.front().covariance = updateCovariance(start.covariance, start.information);
    return plan;
}

double predictedSigma(const std::vector<PlannedView>& plan, double distance) {
    return positionSigma(predictedCovariance(plan, distance));
}

PositionError positionError(const FlightSample& sample, const std::vector<PlannedView>& plan) {
    const Eigen::Vector3d believed = sample.belief.mean.inverse().translation();
    return {.distance = sample.distance,
            .error = (believed - sample.T_c_w.inverse().translation()).norm(),
            .believed = positionSigma(sample.belief.covariance),
            .predicted = predictedSigma(plan, sample.distance)};
}

std::string lengthText(double metres) {
    return std::abs(metres) < 0.1 ? fmt::format("{:.3g} mm", 1e3 * metres)
                                  : fmt::format("{:.3f} m", metres);
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

double chiSquareQuantile(double degrees, double z) {
    const double a = 2. / (9. * degrees);
    return degrees * std::pow(1. - a + z * std::sqrt(a), 3);
}

FlightSummary summarise(const FlightSet& set) {
    FlightSummary s;
    s.flights = set.flights.size();
    if (set.flights.empty()) return s;
    countEnds(set.flights, s);
    judgeExposures(set, s);
    std::vector<double> nees, atGoal;
    for (const FlightResult& flight : set.flights) {
        nees.push_back(neesPerDof(flight));
        append(neesPerDof(flight.samples.back()), atGoal);
    }
    s.neesAtGoal = mean(atGoal, FlightSummary::kNone);
    s.neesMedian = median(nees, FlightSummary::kNone);
    const double degrees = 6. * static_cast<double>(s.flights);
    s.neesLow = chiSquareQuantile(degrees, -1.96) / degrees;
    s.neesHigh = chiSquareQuantile(degrees, 1.96) / degrees;
    return s;
}

std::vector<FlightResult> flyMany(const std::vector<PlannedView>& plan, const FlightWorld& world,
                                  const FlightOptions& options, unsigned count, unsigned jobs,
                                  const std::atomic<bool>& interrupted,
                                  const std::function<void(const FlightResult&)>& onFlight,
                                  const OnExposure& onExposure) {
    std::vector<FlightResult> flights(count);
    std::atomic<unsigned> next{0};
    std::mutex mutex;  // of onFlight and failure
    std::exception_ptr failure;
    const auto work = [&] {
        try {
            for (unsigned i = next++; i < count && !interrupted; i = next++) {
                FlightOptions own = options;
                own.seed = (options.seed << 32) + i;
                flights[i] = fly(
                    plan, world, own, [&] { return interrupted.load(); },
                    i == 0 ? onExposure : OnExposure{});
                flights[i].number = i;
                const std::lock_guard lock(mutex);
                if (flights[i].end != FlightEnd::stopped) onFlight(flights[i]);
            }
        } catch (...) {
            const std::lock_guard lock(mutex);
            if (!failure) failure = std::current_exception();
            next = count;
        }
    };
    {
        std::vector<std::jthread> workers;
        for (unsigned k = 1; k < std::min(jobs, count); ++k) workers.emplace_back(work);
        work();
    }
    if (failure) std::rethrow_exception(failure);
    std::erase_if(flights, [](const FlightResult& f) { return f.end == FlightEnd::stopped; });
    return flights;
}

}  // namespace photonav
