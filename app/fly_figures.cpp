// SPDX-License-Identifier: BSD-3-Clause
#include "fly_figures.hpp"

#include <algorithm>
#include <cmath>

#include "averages.hpp"
#include "plot.hpp"

namespace photonav {
namespace {

constexpr double kFlightLeft = 116., kFlightTop = 62., kFlightWidth = 900., kFlightHeight = 300.,
                 kFlightBetween = 120.;
constexpr double kBin = 0.5;  // of the way, for means over flights [m]

/// Mean of a value of all samples that have one, by way along the plan; empty bins are left out.
template <typename Value>
std::vector<Canvas::Point> meansAlong(const FlightSet& set, Value value) {
    const auto bins = static_cast<std::size_t>(set.path.length / kBin) + 1;
    std::vector<std::vector<double>> values(bins);
    for (const FlightResult& flight : set.flights) {
        for (const FlightSample& sample : flight.samples) {
            const std::size_t bin =
                std::min(bins - 1, static_cast<std::size_t>(sample.distance / kBin));
            if (const std::optional<double> v = value(sample)) values[bin].push_back(*v);
        }
    }
    std::vector<Canvas::Point> means;
    for (std::size_t i = 0; i < bins; ++i) {
        if (!values[i].empty())
            means.emplace_back(std::min((static_cast<double>(i) + 0.5) * kBin, set.path.length),
                               mean(values[i], 0.));
    }
    return means;
}

std::vector<Canvas::Point> placed(const Plot& plot, const std::vector<Canvas::Point>& curve) {
    std::vector<Canvas::Point> points;
    points.reserve(curve.size());
    for (const Canvas::Point& p : curve) points.push_back(plot.at(p.x(), p.y()));
    return points;
}

double longest(const std::vector<FlightSet>& sets) {
    double length = 0.1;
    for (const FlightSet& set : sets) length = std::max(length, set.path.length);
    return length;
}

/// The largest predicted 3 sigma, and almost all of the errors.
double mostOf(const std::vector<FlightSet>& sets) {
    double most = 0.;
    for (const FlightSet& set : sets) {
        std::vector<double> errors{0.};
        for (const PlannedView& view : set.plan)
            most = std::max(most, 3. * predictedSigma(set.plan, view.distance));
        for (const FlightResult& flight : set.flights)
            for (const FlightSample& sample : flight.samples)
                errors.push_back(positionError(sample, set.plan).error);
        std::sort(errors.begin(), errors.end());
        most = std::max(most, errors[(errors.size() - 1) * 99 / 100]);
    }
    return std::max(1.05 * most, 1e-3);
}

void drawBand(const Plot& plot, const FlightSet& set, double sigmas, double opacity,
              const Color& color) {
    plot.canvas.translucent(opacity, [&] {
        for (std::size_t i = 1; i < set.plan.size(); ++i) {
            const double a = set.plan[i - 1].distance;
            const double b = set.plan[i].distance;
            plot.canvas.fill(
                {plot.at(a, 0.), plot.at(b, 0.), plot.at(b, sigmas * predictedSigma(set.plan, b)),
                 plot.at(a, sigmas * predictedSigma(set.plan, a))},
                color);
        }
    });
}

void drawErrors(const Plot& plot, const FlightSet& set, const Color& color) {
    const auto clipped = plot.canvas.clip(plot.frame);
    drawBand(plot, set, 3., 0.14, color);
    drawBand(plot, set, 1., 0.28, color);
    plot.canvas.translucent(0.45, [&] {
        for (const FlightResult& flight : set.flights) {
            std::vector<Canvas::Point> curve;
            for (const FlightSample& sample : flight.samples) {
                const PositionError e = positionError(sample, set.plan);
                curve.push_back(plot.at(e.distance, e.error));
            }
            plot.canvas.polyline(curve, kInk, 1.);
        }
    });
    auto rms = meansAlong(set, [&](const FlightSample& sample) {
        const double error = positionError(sample, set.plan).error;
        return error * error;
    });
    for (Canvas::Point& p : rms) p.y() = std::sqrt(p.y());
    plot.canvas.polyline(placed(plot, rms), kInk, 3.2);
}

void drawSwatch(Canvas& canvas, const Canvas::Point& at, double opacity, const Color& color) {
    canvas.translucent(opacity, [&] {
        canvas.fill({at + Canvas::Point(0., -14.), at + Canvas::Point(34., -14.),
                     at + Canvas::Point(34., 4.), at + Canvas::Point(0., 4.)},
                    color);
    });
}

void drawErrorLegend(Canvas& canvas, const Frame& frame, const std::string& name,
                     const Color& color) {
    canvas.text(name, {frame.x, frame.y - 14.}, Align::left, kInk, 21.);
    Canvas::Point at(frame.x + 260., frame.y - 14.);
    const auto words = [&](const std::string& text) {
        canvas.text(text, at + Canvas::Point(42., 0.), Align::left, kInk);
        at.x() += 70. + Canvas::textWidth(text);
    };
    drawSwatch(canvas, at, 0.42, color);
    words("predicted 1 sigma");
    drawSwatch(canvas, at, 0.14, color);
    words("3 sigma");
    const auto line = [&](double width) {
        canvas.line(at + Canvas::Point(0., -5.), at + Canvas::Point(34., -5.), kInk, width);
    };
    line(1.);
    words("flights");
    line(3.2);
    words("their rms");
}

/// Where 95 % of honest means lie, one sample of every flight to a bin.
void drawHonestBand(const Plot& plot, const std::vector<FlightSet>& sets) {
    const double degrees = 6. * static_cast<double>(sets.front().flights.size());
    if (degrees < 1.) return;
    const auto clipped = plot.canvas.clip(plot.frame);
    const double low = chiSquareQuantile(degrees, -1.96) / degrees;
    const double high = chiSquareQuantile(degrees, 1.96) / degrees;
    plot.canvas.translucent(0.2, [&] {
        plot.canvas.fill({plot.at(0., low), plot.at(plot.x.max, low), plot.at(plot.x.max, high),
                          plot.at(0., high)},
                         kAxisColor);
    });
}

}  // namespace

Png drawErrorBands(const std::vector<FlightSet>& sets) {
    const double n = static_cast<double>(sets.size());
    Canvas canvas(kFlightLeft + kFlightWidth + 32.,
                  kFlightTop + n * (kFlightHeight + kFlightBetween));
    const Axis x{0., longest(sets), false, "way along the plan [m]"};
    const Axis y{0., mostOf(sets), false, "position error [m]"};
    Frame frame{kFlightLeft, kFlightTop, kFlightWidth, kFlightHeight};
    for (std::size_t k = 0; k < sets.size(); ++k, frame.y += kFlightHeight + kFlightBetween) {
        const Plot plot{canvas, frame, x, y};
        plot.drawGrid();
        drawErrors(plot, sets[k], colorOf(k));
        plot.drawAxes();
        drawErrorLegend(canvas, frame, sets[k].path.planner, colorOf(k));
    }
    return canvas.png();
}

Png drawNees(const std::vector<FlightSet>& sets) {
    const Frame frame{kFlightLeft, kFlightTop, kFlightWidth, kFlightHeight};
    Canvas canvas(frame.right() + 32., frame.bottom() + 76.);
    std::vector<std::vector<Canvas::Point>> curves;
    double most = 2.;
    double least = 0.5;
    for (const FlightSet& set : sets) {
        curves.push_back(
            meansAlong(set, [](const FlightSample& sample) { return neesPerDof(sample); }));
        for (const Canvas::Point& p : curves.back()) {
            most = std::max(most, p.y());
            if (p.y() > 0.) least = std::min(least, p.y());
        }
    }
    const Plot plot{canvas,
                    frame,
                    {0., longest(sets), false, "way along the plan [m]"},
                    {least / 1.2, most * 1.2, true, "NEES per degree of freedom"}};
    plot.drawGrid();
    drawHonestBand(plot, sets);
    canvas.line(plot.at(0., 1.), plot.at(plot.x.max, 1.), kAxisColor, 2.);
    {
        const auto clipped = canvas.clip(frame);
        for (std::size_t k = sets.size(); k-- > 0;)
            canvas.polyline(placed(plot, curves[k]), colorOf(k), 2.8);
    }
    plot.drawAxes();
    Canvas::Point at(frame.x, frame.y - 14.);
    for (std::size_t k = 0; k < sets.size(); ++k) {
        canvas.line(at + Canvas::Point(0., -5.), at + Canvas::Point(34., -5.), colorOf(k), 3.);
        const std::string& name = sets[k].path.planner;
        canvas.text(name, at + Canvas::Point(42., 0.), Align::left, kInk);
        at.x() += 80. + Canvas::textWidth(name);
    }
    drawSwatch(canvas, at, 0.2, kAxisColor);
    canvas.text("95 % of honest means", at + Canvas::Point(42., 0.), Align::left, kInk);
    return canvas.png();
}

DrawnTree drawnFlights(const FlightSet& set, const Color& color) {
    const auto darker = [](std::uint8_t level) { return static_cast<std::uint8_t>(level * 3 / 5); };
    const Color dark{darker(color.red), darker(color.green), darker(color.blue)};
    DrawnTree lines{"flights, " + set.path.planner, dark, {}, true};
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
