// SPDX-License-Identifier: BSD-3-Clause
#include "figures/servo_figures.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace photonav {
namespace {

constexpr double kPercent = 100.;

Color colorOf(std::size_t i, std::size_t count) {
    return viridis(0.9 * static_cast<double>(i) /
                   static_cast<double>(std::max<std::size_t>(count, 2) - 1));
}

}  // namespace

Figure servoBasinFigure(const ServoStudyOptions& options, const ServoStudy& study) {
    Plot plot;
    plot.x = {.min = 0., .label = "distance of the start from the goal [m]"};
    plot.y = {.min = 0., .max = kPercent, .label = "converged [%]"};
    const auto& angles = options.angles;
    for (std::size_t k = 0; k < angles.size(); ++k) {
        Plot::Points curve, low, high;
        for (const BasinCell& cell : study.basin) {
            if (cell.angle != angles[k]) continue;
            curve.emplace_back(cell.distance, kPercent * cell.converged / cell.trials);
            low.emplace_back(cell.distance, kPercent * cell.low);
            high.emplace_back(cell.distance, kPercent * cell.high);
        }
        if (curve.empty()) continue;
        const Color color = colorOf(k, angles.size());
        plot.band(low, high, {.color = color, .opacity = 0.15});
        plot.curve(curve, {.color = color,
                           .width = 2.6,
                           .name = fmt::format("rotated by {:g} degrees", angles[k])});
        plot.dots(curve, {.color = color, .width = 7.});
    }
    return {.title = "Basin of convergence of the servo (bands: 95 % intervals)", .rows = {{plot}}};
}

Figure servoModesFigure(const ServoStudy& study) {
    Plot plot;
    plot.x = {.min = 0.5,
              .max = 0.5 + static_cast<double>(study.modes.size()),
              .label = "direction, the slowest first",
              .whole = true};
    plot.y = {.min = 0., .label = "decay rate of the error [1/s]"};
    Plot::Points predicted, simulated;
    for (const ServoMode& mode : study.modes) {
        const double x = static_cast<double>(predicted.size() + 1);
        predicted.emplace_back(x, mode.predictedDecay);
        simulated.emplace_back(x, mode.simulatedDecay);
    }
    plot.dots(
        predicted,
        {.color = plannerColor("rrt_star"), .width = 16., .name = "predicted by the Hessian"});
    plot.dots(simulated,
              {.color = plannerColor("belief_rrt_star"), .width = 8., .name = "simulated"});
    return {.title = "Decay rate of the error, by direction", .rows = {{plot}}};
}

}  // namespace photonav
