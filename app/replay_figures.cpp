// SPDX-License-Identifier: BSD-3-Clause
#include "replay_figures.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include "figures.hpp"
#include "plot.hpp"

namespace photonav {
namespace {

constexpr double kReplayLeft = 112., kReplayTop = 92., kReplayWidth = 900., kReplayHeight = 220.,
                 kStep = 262.;  // [px]
constexpr Color kBand = kBaselineColor;
constexpr Color kLost{178, 182, 188};
constexpr Color kNoColor{24, 44, 92};
// 95 % of the squared normalised errors of a six-dimensional Gaussian, per degree of freedom.
constexpr double kNeesLow = 1.2373 / 6., kNeesHigh = 14.4494 / 6.;

struct Sample {
    double time, value;
};

/// What one panel shows, over time since the first frame.
struct ErrorPanel {
    std::vector<Sample> sigma;  ///< predicted standard deviation
    std::vector<Sample> error;
    std::string label;
};

struct Panels {
    ErrorPanel position, rotation, nees;
    double duration = 1.;
    std::vector<TimeInterval> lost;
};

Panels panelsOf(const ReplayRun& run, const ReplayErrors& errors) {
    constexpr double kDegrees = 180. / std::numbers::pi;
    Panels p;
    p.position.label = "position [m]";
    p.rotation.label = "orientation [deg]";
    p.nees.label = "NEES / 6";
    if (run.frames.empty()) return p;
    const double start = run.frames.front().timestamp;
    p.duration = std::max(run.frames.back().timestamp - start, 1e-3);
    for (const ReplayedFrame& frame : run.frames) {
        if (frame.status == FrameStatus::unreadable) continue;
        const auto variance = frame.tracked.T_c_w.covariance.diagonal();
        const double t = frame.timestamp - start;
        p.position.sigma.push_back({t, std::sqrt(variance.head<3>().sum())});
        p.rotation.sigma.push_back({t, kDegrees * std::sqrt(variance.tail<3>().sum())});
    }
    for (const JudgedFrame& frame : errors.judged) {
        const double t = frame.pair.timestamp - start;
        p.position.error.push_back({t, frame.positionError});
        p.rotation.error.push_back({t, kDegrees * frame.rotationError});
        if (frame.nees) p.nees.error.push_back({t, *frame.nees});
    }
    for (const auto& [from, to] : lostIntervals(run)) {
        p.lost.emplace_back(from - start, to - start);
    }
    return p;
}

double largest(const std::vector<Sample>& samples, double factor = 1.) {
    double most = 0.;
    for (const Sample& s : samples) most = std::max(most, factor * s.value);
    return most;
}

/// Up to the largest error, and the bands as far as they are not out of all proportion to it.
/// An error that is nothing but rounding, of a first image, is none.
Axis axisOf(const ErrorPanel& panel) {
    const double error = 1.15 * largest(panel.error);
    const double band = 1.05 * largest(panel.sigma, 3.);
    const double most = error > 1e-9 ? std::max(error, std::min(band, 4. * error)) : band;
    return {0., most > 0. ? most : 1., false, panel.label};
}

Axis neesAxis(const ErrorPanel& panel) {
    double low = 0.1;
    double high = 5.;
    for (const Sample& s : panel.error) {
        if (s.value > 0.) low = std::min(low, s.value / 1.3);
        high = std::max(high, 1.3 * s.value);
    }
    return {std::max(low, 1e-3), high, true, panel.label};
}

void fillBand(const Plot& plot, const std::vector<Sample>& sigma, double factor, double opacity) {
    plot.canvas.translucent(opacity, [&] {
        for (std::size_t i = 1; i < sigma.size(); ++i) {
            plot.canvas.fill({plot.at(sigma[i - 1].time, plot.y.min),
                              plot.at(sigma[i - 1].time, factor * sigma[i - 1].value),
                              plot.at(sigma[i].time, factor * sigma[i].value),
                              plot.at(sigma[i].time, plot.y.min)},
                             kBand);
        }
    });
}

void fillBox(const Plot& plot, double t0, double t1, double y0, double y1, const Color& color) {
    plot.canvas.fill({plot.at(t0, y0), plot.at(t1, y0), plot.at(t1, y1), plot.at(t0, y1)}, color);
}

void drawLost(const Plot& plot, const std::vector<TimeInterval>& lost) {
    const double least = 0.004 * plot.x.max;  // that a single image can be seen
    plot.canvas.translucent(0.55, [&] {
        for (const auto& [from, to] : lost) {
            fillBox(plot, from - least, to + least, plot.y.min, plot.y.max, kLost);
        }
    });
}

void drawLine(const Plot& plot, const std::vector<Sample>& samples) {
    std::vector<Canvas::Point> line;
    line.reserve(samples.size());
    for (const Sample& s : samples) line.push_back(plot.at(s.time, s.value));
    plot.canvas.polyline(line, kPathColor, 2.2);
    if (line.size() < 60) {
        for (const auto& point : line) plot.canvas.disc(point, 3., kPathColor);
    }
}

void drawPanel(const Plot& plot, const ErrorPanel& panel, const std::vector<TimeInterval>& lost,
               bool isNees) {
    {
        const auto clipped = plot.canvas.clip(plot.frame);
        drawLost(plot, lost);
        if (isNees) {
            plot.canvas.translucent(0.18, [&] {
                fillBox(plot, plot.x.min, plot.x.max, std::max(kNeesLow, plot.y.min), kNeesHigh,
                        kBand);
            });
            plot.canvas.line(plot.at(plot.x.min, 1.), plot.at(plot.x.max, 1.), kBand, 1.4);
        } else {
            fillBand(plot, panel.sigma, 3., 0.16);
            fillBand(plot, panel.sigma, 1., 0.26);
        }
    }
    plot.drawGrid();
    {
        const auto clipped = plot.canvas.clip(plot.frame);
        drawLine(plot, panel.error);
    }
    plot.drawAxes();
}

void drawLegend(Canvas& canvas, bool hasErrors, bool hasLost) {
    double x = kReplayLeft;
    const auto entry = [&](const std::string& words, const Color& color, double opacity) {
        canvas.translucent(opacity, [&] {
            canvas.fill({{x, 57.}, {x + 30., 57.}, {x + 30., 73.}, {x, 73.}}, color);
        });
        canvas.text(words, {x + 40., 71.}, Align::left, kInk);
        x += 40. + Canvas::textWidth(words) + 34.;
    };
    if (hasErrors) entry("error", kPathColor, 1.);
    entry("1 sigma predicted", kBand, 0.42);
    entry("3 sigma (NEES: 95 % if honest)", kBand, 0.17);
    if (hasLost) entry("lost", kLost, 0.55);
}

}  // namespace

Png drawReplayErrors(const std::string& title, const ReplayRun& run, const ReplayErrors& errors) {
    const Panels panels = panelsOf(run, errors);
    std::vector<const ErrorPanel*> shown = {&panels.position, &panels.rotation};
    if (!panels.nees.error.empty()) shown.push_back(&panels.nees);
    Canvas canvas(kReplayLeft + kReplayWidth + 32.,
                  kReplayTop + double(shown.size()) * kStep + 44.);
    canvas.text(title, {kReplayLeft, 34.}, Align::left, kInk, 21.);
    drawLegend(canvas, !errors.judged.empty(), !panels.lost.empty());
    double y = kReplayTop;
    for (const ErrorPanel* panel : shown) {
        const bool isNees = panel == &panels.nees;
        const Axis time{0., panels.duration, false, panel == shown.back() ? "time [s]" : ""};
        drawPanel({canvas,
                   {kReplayLeft, y, kReplayWidth, kReplayHeight},
                   time,
                   isNees ? neesAxis(*panel) : axisOf(*panel)},
                  *panel, panels.lost, isNees);
        y += kStep;
    }
    return canvas.png();
}

Png drawStrips(const std::vector<ReplayStrip>& strips) {
    if (strips.empty()) throw std::invalid_argument("drawStrips: no strips");
    constexpr double kPicture = 320., kGap = 8., kHead = 30., kTitles = 26.;
    constexpr double kFullResidual = 0.25;  // grey values
    const ImageF& shape = strips[0].observed.intensity;
    const double height = kPicture * shape.getHeight() / shape.getWidth();
    Canvas canvas(3. * kPicture + 4. * kGap,
                  kTitles + double(strips.size()) * (height + kHead) + kGap);
    const auto grey = [](float value) {
        const auto g = static_cast<std::uint8_t>(std::lround(255. * std::clamp(value, 0.F, 1.F)));
        return Color{g, g, g};
    };
    const auto colors = viridis();
    double titleX = kGap;
    for (const char* title : {"observed", "predicted", "difference"}) {
        canvas.text(title, {titleX, kTitles - 6.}, Align::left, kInk, 18.);
        titleX += kPicture + kGap;
    }
    double y = kTitles;
    for (const auto& [caption, observed, predicted] : strips) {
        const unsigned size = observed.intensity.getSize();
        std::vector<Color> left(size), middle(size, kNoColor), right(size, kNoColor);
        for (unsigned i = 0; i < size; ++i) {
            left[i] = grey(observed.intensity.bitmap[i]);
            if (!(predicted.depth.bitmap[i] > 0.F)) continue;
            middle[i] = grey(predicted.intensity.bitmap[i]);
            const double r = std::abs(predicted.intensity.bitmap[i] - observed.intensity.bitmap[i]);
            right[i] = colors[static_cast<std::size_t>(255. * std::min(r / kFullResidual, 1.))];
        }
        canvas.text(caption, {kGap, y + 21.}, Align::left, kInk, 15.);
        double x = kGap;
        for (const auto* pixels : {&left, &middle, &right}) {
            canvas.picture(*pixels, static_cast<int>(observed.intensity.getWidth()),
                           {x, y + kHead, kPicture, height}, true);
            x += kPicture + kGap;
        }
        y += height + kHead;
    }
    return canvas.png();
}

}  // namespace photonav
