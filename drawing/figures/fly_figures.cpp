// SPDX-License-Identifier: BSD-3-Clause
#include "figures/fly_figures.hpp"

#include <algorithm>
#include <cmath>

#include "evaluation/averages.hpp"
#include "geometry/constants.hpp"

namespace photonav {
namespace {

constexpr double kBin = 0.5;  // of the length of the plan, for means over flights [m]
constexpr double kFlightWidth = 900., kFlightHeight = 300.;  // of a panel [px]
constexpr const char* kDistance = "distance along the plan [m]";
constexpr Color kConsistentColor{120, 126, 133};

/// Mean of a value of all samples that have one, along the plan; empty bins are left out.
template <typename Value>
Plot::Points meansAlong(const FlightSet& set, Value value) {
    const auto bins = static_cast<std::size_t>(set.path.length / kBin) + 1;
    std::vector<std::vector<double>> values(bins);
    for (const FlightResult& flight : set.flights) {
        for (const FlightSample& sample : flight.samples) {
            const std::size_t bin =
                std::min(bins - 1, static_cast<std::size_t>(sample.distance / kBin));
            if (const std::optional<double> v = value(sample)) values[bin].push_back(*v);
        }
    }
    Plot::Points means;
    for (std::size_t i = 0; i < bins; ++i) {
        if (!values[i].empty())
            means.emplace_back(std::min((static_cast<double>(i) + 0.5) * kBin, set.path.length),
                               mean(values[i], 0.));
    }
    return means;
}

/// The largest predicted 3 sigma, and 99 % of the errors.
double errorLimit(const std::vector<FlightSet>& sets) {
    double limit = 0.;
    for (const FlightSet& set : sets) {
        std::vector<double> errors{0.};
        for (const PlannedView& view : set.plan)
            limit = std::max(limit, 3. * predictedSigma(set.plan, view.distance));
        for (const FlightResult& flight : set.flights)
            for (const FlightSample& sample : flight.samples)
                errors.push_back(positionError(sample, set.plan).error);
        std::sort(errors.begin(), errors.end());
        limit = std::max(limit, errors[(errors.size() - 1) * 99 / 100]);
    }
    return std::max(1.05 * limit, 1e-3);
}

Plot errorPanel(const FlightSet& set) {
    Plot plot;
    plot.title = set.path.planner;
    plot.width = kFlightWidth;
    plot.height = kFlightHeight;
    Plot::Points zero, sigma, sigma3, errors;
    for (const PlannedView& view : set.plan) {
        const double value = predictedSigma(set.plan, view.distance);
        zero.emplace_back(view.distance, 0.);
        sigma.emplace_back(view.distance, value);
        sigma3.emplace_back(view.distance, 3. * value);
    }
    for (const FlightResult& flight : set.flights) {
        for (const FlightSample& sample : flight.samples) {
            const PositionError e = positionError(sample, set.plan);
            errors.emplace_back(e.distance, e.error);
        }
        errors.emplace_back(Plot::Point::Constant(Axis::kAuto));
    }
    Plot::Points rms = meansAlong(set, [&](const FlightSample& sample) {
        const double error = positionError(sample, set.plan).error;
        return error * error;
    });
    for (Plot::Point& p : rms) p.y() = std::sqrt(p.y());
    const Color color = plannerColor(set.path.planner);
    plot.band(zero, sigma3, {.color = color, .opacity = 0.14, .name = "predicted 3σ"});
    plot.band(zero, sigma, {.color = color, .opacity = 0.28, .name = "predicted 1σ"});
    plot.curve(errors, {.width = 1., .opacity = 0.45, .name = "errors of the flights"});
    plot.curve(rms, {.width = 3.2, .name = "root mean square of the errors"});
    return plot;
}

/// Where 95 % of the means of consistent flights are, one sample of every flight to a bin.
void addConsistentBand(Plot& plot, std::size_t flights) {
    if (flights == 0) return;
    const auto [low, high] = neesBounds(flights);
    plot.band(
        {{-kInfinity, low}, {kInfinity, low}}, {{-kInfinity, high}, {kInfinity, high}},
        {.color = kConsistentColor, .opacity = 0.2, .name = "95 % if covariances are consistent"});
    plot.curve({{-kInfinity, 1.}, {kInfinity, 1.}}, {.color = kConsistentColor});
}

}  // namespace

Figure errorBandsFigure(const std::vector<FlightSet>& sets) {
    Figure figure{"Position error and prediction"};
    double length = 0.1;
    for (const FlightSet& set : sets) length = std::max(length, set.path.length);
    for (const FlightSet& set : sets) {
        Plot& plot = figure.rows.emplace_back().emplace_back(errorPanel(set));
        plot.x = {0., length, false, kDistance};
        plot.y = {0., errorLimit(sets), false, "position error [m]"};
    }
    return figure;
}

Figure neesFigure(const std::vector<FlightSet>& sets) {
    Plot plot;
    plot.width = kFlightWidth;
    plot.height = kFlightHeight;
    plot.x = {.min = 0., .label = kDistance};
    plot.y = {.log = true, .label = "NEES per degree of freedom"};
    if (!sets.empty()) addConsistentBand(plot, sets.front().flights.size());
    plot.curve({{0., 0.5}, {0., 2.}}, {.width = 0.});  // at least this range
    for (auto set = sets.rbegin(); set != sets.rend(); ++set) {
        const auto nees = [](const FlightSample& sample) { return neesPerDof(sample); };
        plot.curve(
            meansAlong(*set, nees),
            {.color = plannerColor(set->path.planner), .width = 2.8, .name = set->path.planner});
    }
    return {"Consistency of the covariances", {{plot}}};
}

DrawnTree drawnFlights(const FlightSet& set) {
    const auto darker = [](std::uint8_t level) { return static_cast<std::uint8_t>(level * 3 / 5); };
    const Color color = plannerColor(set.path.planner);
    DrawnTree lines{"flights, " + set.path.planner,
                    {darker(color.red), darker(color.green), darker(color.blue)},
                    {},
                    true};
    for (const FlightResult& flight : set.flights) {
        for (std::size_t i = 1; i < flight.samples.size(); ++i) {
            lines.edges.push_back(
                {flight.samples[i - 1].T_c_w.inverse().translation().cast<float>(),
                 flight.samples[i].T_c_w.inverse().translation().cast<float>()});
        }
    }
    return lines;
}

}  // namespace photonav
