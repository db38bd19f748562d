// SPDX-License-Identifier: BSD-3-Clause
#include "figures/check_figures.hpp"

#include <cmath>
#include <numbers>

#include "geometry/constants.hpp"
#include "geometry/se3.hpp"

namespace photonav {
namespace {

constexpr double kWidth = 900., kHeight = 240.;  // of a panel [px]
constexpr int kColumns = 400, kRows = 120;       // of the picture of headings [px]
constexpr Color kLost{200, 30, 45}, kOpen = kSand, kRejected{120, 126, 133};

/// Boxes over the stretches that end at places of a kind.
template <typename Kind>
std::vector<Plot::Points> boxesOver(const std::vector<CheckedPlace>& places, const Kind& kind,
                                    double height) {
    std::vector<Plot::Points> boxes;
    for (std::size_t i = 1; i < places.size(); ++i) {
        if (!kind(places[i])) continue;
        const double a = places[i - 1].length, b = places[i].length;
        boxes.push_back({{a, 0.}, {b, 0.}, {b, height}, {a, height}});
    }
    return boxes;
}

template <typename Value>
Plot panel(const CheckedTrajectory& checked, const char* label, const Value& value) {
    Plot plot;
    plot.width = kWidth;
    plot.height = kHeight;
    Plot::Points curve;
    double top = 0.;
    for (const CheckedPlace& place : checked.places) {
        curve.emplace_back(place.length, value(place));
        top = std::max(top, value(place));
    }
    top = std::max(1.05 * top, 1e-9);
    const auto shade = [&](const char* name, const Color& color, const auto& kind) {
        const auto boxes = boxesOver(checked.places, kind, top);
        if (!boxes.empty()) plot.fill(boxes, {.color = color, .opacity = 0.25, .name = name});
    };
    shade("lost", kLost, [](const CheckedPlace& p) { return p.loss != LossCause::none; });
    shade("image rejected: too little of the map in view", kRejected,
          [](const CheckedPlace& p) { return p.loss == LossCause::none && isLost(p.verdict); });
    shade("directions open", kOpen, [](const CheckedPlace& p) {
        return p.loss == LossCause::none && p.verdict == Verdict::degenerate;
    });
    plot.curve(curve, {.color = plannerColor("belief_rrt_star"),
                       .width = 2.6,
                       .name = "standard deviation along the weakest direction"});
    plot.y = {.min = 0., .max = top, .label = label};
    return plot;
}

bool isGain(const CheckedPlace& place) {
    return place.best && place.best->trace < 0.9 * place.best->ownTrace;
}

/// Heading in (-180, 180] degrees.
double degrees(double yaw) { return std::remainder(yaw, 2. * std::numbers::pi) / kDegree; }

/// The trace at a heading of a place: that of the nearest heading compared.
double traceAt(const CheckedPlace& place, double yaw) {
    const std::vector<double>& traces = place.best->traces;
    const double turn = (yaw - yawOf(place.T_w_b)) / (2. * std::numbers::pi);
    const auto count = static_cast<double>(traces.size());
    const double index = std::round((turn - std::floor(turn)) * count);
    return traces[static_cast<std::size_t>(index) % traces.size()];
}

}  // namespace

Figure sigmaFigure(const CheckedTrajectory& checked) {
    Plot position =
        panel(checked, "position [m]", [](const CheckedPlace& p) { return p.positionSigma; });
    Plot rotation = panel(checked, "rotation [deg]",
                          [](const CheckedPlace& p) { return p.rotationSigma / kDegree; });
    rotation.x = {.min = 0., .label = "distance along the trajectory [m]"};
    position.x = {.min = 0.};
    return {"Uncertainty along the trajectory", {{position}, {rotation}}};
}

Figure headingsFigure(const CheckedTrajectory& checked) {
    const auto& places = checked.places;
    std::vector<double> values;
    for (const CheckedPlace& place : places) {
        values.insert(values.end(), place.best->traces.begin(), place.best->traces.end());
    }
    const Axis scale = Axis{.log = true, .label = "trace after one view [m²]"}.fittedTo(values);
    Picture picture{{}, kColumns};
    const double length = std::max(checked.length, 1e-9);
    for (int row = 0; row < kRows; ++row) {
        const double yaw = (180. - (row + 0.5) * 360. / kRows) * kDegree;
        std::size_t i = 0;
        for (int column = 0; column < kColumns; ++column) {
            const double at = (column + 0.5) * length / kColumns;
            while (i + 1 < places.size() && places[i].length < at) ++i;
            picture.pixels.push_back(viridis(scale.fraction(traceAt(places[i], yaw))));
        }
    }
    Plot plot;
    plot.width = kWidth;
    plot.height = 360.;
    plot.picture(picture, {Eigen::Vector2d(0., -180.), Eigen::Vector2d(length, 180.)}, false);
    Plot::Points own, best;
    for (const CheckedPlace& place : places) {
        own.emplace_back(place.length, degrees(yawOf(place.T_w_b)));
        best.emplace_back(place.length, degrees(place.best->yaw));
    }
    plot.dots(own, {.color = {255, 190, 60}, .width = 5., .name = "heading of the trajectory"});
    plot.dots(best, {.color = kLost, .width = 4., .name = "best heading"});
    plot.colorBar(scale);
    plot.x = {.min = 0., .max = length, .label = "distance along the trajectory [m]"};
    plot.y = {.min = -180., .max = 180., .label = "heading [deg]"};
    return {"Uncertainty after one view, by heading", {{plot}}};
}

DrawnTree lostStretches(const CheckedTrajectory& checked) {
    DrawnTree lines{"lost", kLost, {}, true};
    for (std::size_t i = 1; i < checked.places.size(); ++i) {
        if (checked.places[i].loss == LossCause::none) continue;
        lines.edges.push_back({checked.places[i - 1].T_w_b.translation().cast<float>(),
                               checked.places[i].T_w_b.translation().cast<float>()});
    }
    return lines;
}

DrawnTree betterHeadings(const CheckedTrajectory& checked, double length) {
    DrawnTree lines{"better headings", {22, 128, 57}, {}, true};
    for (const CheckedPlace& place : checked.places) {
        if (!isGain(place)) continue;
        const Eigen::Vector3d p = place.T_w_b.translation();
        const Eigen::Vector3d ahead(std::cos(place.best->yaw), std::sin(place.best->yaw), 0.);
        lines.edges.push_back({p.cast<float>(), (p + length * ahead).cast<float>()});
    }
    return lines;
}

}  // namespace photonav
