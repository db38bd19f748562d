// SPDX-License-Identifier: BSD-3-Clause
#include "figures/trace.hpp"

namespace photonav {

Figure traceFigure(const std::string& title, const std::vector<DrawnPath>& paths, bool logScale) {
    Plot plot;
    plot.x = {.min = 0., .label = "distance along the path [m]"};
    plot.y = {.min = logScale ? Axis::kAuto : 0.,
              .log = logScale,
              .label = "trace of the pose covariance [m²]"};
    plot.width = 900.;
    plot.height = 420.;
    for (auto path = paths.rbegin(); path != paths.rend(); ++path) {
        Plot::Points curve;
        for (const PathPoint& point : path->points) {
            if (point.traceBefore) curve.emplace_back(point.distance, *point.traceBefore);
            curve.emplace_back(point.distance, point.trace);
        }
        plot.curve(curve, {.color = path->color, .width = 1.6, .name = path->name});
    }
    return {title, {{plot}}};
}

}  // namespace photonav
