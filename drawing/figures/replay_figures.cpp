// SPDX-License-Identifier: BSD-3-Clause
#include "figures/replay_figures.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "figures/images.hpp"
#include "geometry/constants.hpp"
#include "shapes/paths.hpp"

namespace photonav {
namespace {

constexpr Color kErrorColor = kWine, kPredictedColor = kIndigo, kLostColor{178, 182, 188};
// 95 % of the squared normalised errors of a six-dimensional Gaussian, per degree of freedom.
constexpr double kNeesLow = 1.2373 / 6., kNeesHigh = 14.4494 / 6.;

/// What the panels show, over time since the first frame.
struct Curves {
    Plot::Points positionSigma, rotationSigma, positionError, rotationError, nees;
    double duration = 1.;
    std::vector<TimeInterval> lost;
};

Curves curvesOf(const ReplayRun& run, const ReplayErrors& errors) {
    Curves c;
    if (run.frames.empty()) return c;
    const double start = run.frames.front().timestamp;
    c.duration = std::max(run.frames.back().timestamp - start, 1e-3);
    for (const ReplayedFrame& frame : run.frames) {
        if (frame.status == FrameStatus::unreadable) continue;
        const auto variance = frame.tracked.T_c_w.covariance.diagonal();
        const double t = frame.timestamp - start;
        c.positionSigma.emplace_back(t, std::sqrt(variance.head<3>().sum()));
        c.rotationSigma.emplace_back(t, std::sqrt(variance.tail<3>().sum()) / kDegree);
    }
    for (const EvaluatedFrame& frame : errors.frames) {
        const double t = frame.pair.timestamp - start;
        c.positionError.emplace_back(t, frame.positionError);
        c.rotationError.emplace_back(t, frame.rotationError / kDegree);
        if (frame.normalised) c.nees.emplace_back(t, frame.normalised->pose);
    }
    for (const auto& [from, to] : lostIntervals(run)) c.lost.emplace_back(from - start, to - start);
    return c;
}

double largest(const Plot::Points& points) {
    double most = 0.;
    for (const Plot::Point& p : points) most = std::max(most, p.y());
    return most;
}

/// Limited by the largest error, and by the bands as far as these are in proportion to it. An error
/// of the size of rounding, as that of a first image, counts as none.
double errorLimit(const Plot::Points& errors, const Plot::Points& sigmas) {
    const double error = 1.15 * largest(errors);
    const double band = 3.15 * largest(sigmas);
    const double limit = error > 1e-9 ? std::max(error, std::min(band, 4. * error)) : band;
    return limit > 0. ? limit : 1.;
}

Plot panel(const Curves& curves, const Axis& y) {
    Plot plot;
    plot.width = 900.;
    plot.height = 220.;
    plot.x = {0., curves.duration};
    plot.y = y;
    const double least = 0.004 * curves.duration;  // that a single image is visible
    for (const auto& [from, to] : curves.lost) {
        plot.band({{from - least, -kInfinity}, {to + least, -kInfinity}},
                  {{from - least, kInfinity}, {to + least, kInfinity}},
                  {.color = kLostColor, .opacity = 0.55, .name = "lost"});
    }
    return plot;
}

void addErrors(Plot& plot, const Plot::Points& errors) {
    if (errors.empty()) return;
    plot.curve(errors, {.color = kErrorColor, .width = 2.2, .name = "error"});
    if (errors.size() < 60) plot.dots(errors, {.color = kErrorColor, .width = 6.});
}

Plot errorPanel(const Curves& curves, const Plot::Points& errors, const Plot::Points& sigmas,
                const std::string& label) {
    Plot plot = panel(curves, {0., errorLimit(errors, sigmas), false, label});
    Plot::Points zero = sigmas, sigma3 = sigmas;
    for (Plot::Point& p : zero) p.y() = 0.;
    for (Plot::Point& p : sigma3) p.y() *= 3.;
    plot.band(zero, sigma3,
              {.color = kPredictedColor,
               .opacity = 0.16,
               .name = "predicted 3σ (NEES: 95 % if the covariances are consistent)"});
    plot.band(zero, sigmas, {.color = kPredictedColor, .opacity = 0.3, .name = "predicted 1σ"});
    addErrors(plot, errors);
    return plot;
}

Plot neesPanel(const Curves& curves) {
    double low = 0.1;
    double high = 5.;
    for (const Plot::Point& p : curves.nees) {
        if (p.y() > 0.) low = std::min(low, p.y() / 1.3);
        high = std::max(high, 1.3 * p.y());
    }
    Plot plot = panel(curves, {std::max(low, 1e-3), high, true, "NEES / 6"});
    plot.band({{-kInfinity, kNeesLow}, {kInfinity, kNeesLow}},
              {{-kInfinity, kNeesHigh}, {kInfinity, kNeesHigh}},
              {.color = kPredictedColor, .opacity = 0.18});
    plot.curve({{-kInfinity, 1.}, {kInfinity, 1.}}, {.color = kPredictedColor, .width = 1.4});
    addErrors(plot, curves.nees);
    return plot;
}

std::vector<CaptionedImage> imagesOf(const ReplayStrip& strip) {
    const ImageF& observed = strip.observed.intensity;
    return {{strip.caption, greyPicture(observed)},
            {"predicted", predictedPicture(strip.predicted)},
            {fmt::format("difference (yellow: ≥ {})", kFullDifference),
             differencePicture(observed, strip.predicted)}};
}

}  // namespace

Figure replayErrorsFigure(const std::string& title, const ReplayRun& run,
                          const ReplayErrors& errors) {
    const Curves c = curvesOf(run, errors);
    Figure figure{title,
                  {{errorPanel(c, c.positionError, c.positionSigma, "position [m]")},
                   {errorPanel(c, c.rotationError, c.rotationSigma, "orientation [deg]")}}};
    if (!c.nees.empty()) figure.rows.push_back({neesPanel(c)});
    figure.rows.back().back().x.label = "time [s]";
    return figure;
}

Figure stripsFigure(const std::vector<ReplayStrip>& strips) {
    std::vector<std::vector<CaptionedImage>> rows;
    for (const ReplayStrip& strip : strips) {
        if (strip.isSample) rows.push_back(imagesOf(strip));
    }
    return imagesFigure(rows, 320.);
}

Figure stripFigure(const ReplayStrip& strip) { return imagesFigure({imagesOf(strip)}, 220.); }

}  // namespace photonav
