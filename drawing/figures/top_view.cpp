// SPDX-License-Identifier: BSD-3-Clause
#include "figures/top_view.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace photonav {
namespace {

constexpr double kSigmas = 3.;             // size of the ellipses
constexpr double kWedgeRadius = 0.035;     // over the longer side of the picture
constexpr double kMostWedges = 25.;        // along a path
constexpr double kLeastHorizontal = 0.26;  // part of the view direction: others look down or up

/// The background is lightened, so that lines are distinct on it.
Picture lightened(const ImageF& background) {
    Picture picture{{}, static_cast<int>(background.getWidth())};
    for (unsigned i = 0; i < background.getSize(); ++i)
        picture.pixels.push_back(
            greyColor((110. + 140. * std::clamp(background.bitmap[i], 0.F, 1.F)) / 255.));
    return picture;
}

void addTree(Plot& plot, const DrawnTree& tree) {
    Plot::Points ends;
    for (const Edge& edge : tree.edges)
        for (const Eigen::Vector3f& end : edge) ends.emplace_back(end.head<2>().cast<double>());
    const double sparse = std::clamp(60. / static_cast<double>(tree.edges.size()), 0.25, 0.8);
    plot.segments(ends, {.color = tree.color,
                         .width = tree.isOnTop ? 1.8 : 1.,
                         .opacity = tree.isOnTop ? 0.7 : sparse,
                         .name = tree.name});
}

/// Points of a path at least `step` [m] apart, with its ends.
std::vector<PathPoint> spreadPoints(const DrawnPath& path, double step) {
    std::vector<PathPoint> spread;
    double next = 0.;
    for (const PathPoint& point : path.points) {
        if (point.distance < next) continue;
        spread.push_back(point);
        next = std::min(point.distance + step,
                        std::max(path.points.back().distance, point.distance + 1e-9));
    }
    return spread;
}

/// About twenty ellipses along the path, with its ends; more would hide each other. That of the end
/// stands out.
void addEllipses(Plot& plot, const DrawnPath& path, double scale, const std::string& name) {
    if (path.points.empty()) return;
    std::vector<Plot::Points> outlines;
    for (const PathPoint& point : spreadPoints(path, path.points.back().distance / 20.))
        outlines.push_back(ellipse(point.position.head<2>(),
                                   point.positionCovariance.topLeftCorner<2, 2>(),
                                   kSigmas * scale));
    plot.fill(outlines, {.color = path.color, .opacity = 0.22, .name = name});
    for (const Plot::Points& outline : outlines)
        plot.curve(outline, {.color = path.color, .width = 1.2});
    plot.fill({outlines.back()}, {.color = path.color, .opacity = 0.6});
}

/// A sector around the view direction.
Plot::Points wedge(const Plot::Point& apex, double heading, double angle, double radius) {
    constexpr int kArc = 12;
    Plot::Points outline{apex};
    for (int i = 0; i <= kArc; ++i) {
        const double at = heading + angle * (static_cast<double>(i) / kArc - 0.5);
        outline.emplace_back(apex + radius * Plot::Point(std::cos(at), std::sin(at)));
    }
    return outline;
}

/// Where the camera looks along the path, unless it looks down.
void addWedges(Plot& plot, const TopView& view, const DrawnPath& path) {
    if (path.points.empty()) return;
    const double radius = kWedgeRadius * view.area.sizes().maxCoeff();
    const double step = std::max(1.2 * radius, path.points.back().distance / (kMostWedges - 1.));
    std::vector<Plot::Points> outlines;
    for (const PathPoint& point : spreadPoints(path, step)) {
        const Eigen::Vector2d direction = point.T_w_c.linear().col(2).head<2>();
        if (direction.norm() < kLeastHorizontal) continue;
        outlines.push_back(wedge(point.position.head<2>(), std::atan2(direction.y(), direction.x()),
                                 view.horizontalFov, radius));
    }
    if (outlines.empty()) return;
    plot.fill(std::move(outlines), {.color = path.color, .opacity = 0.45, .name = "camera's view"});
}

/// Wider than each path on top of it that runs along it, so that none hides another. White on both
/// sides sets a path off, except from one that runs below.
void addRoute(Plot& plot, const TopView& view, std::size_t index) {
    const DrawnPath& path = view.paths[index];
    const double tolerance = 0.004 * view.area.sizes().maxCoeff();
    double width = 3.6;
    for (std::size_t i = 0; i < index; ++i)
        if (runsAlong(path, view.paths[i], tolerance)) width += 4.;
    const bool isLowest =
        std::none_of(view.paths.begin() + static_cast<long>(index) + 1, view.paths.end(),
                     [&](const DrawnPath& below) { return runsAlong(below, path, tolerance); });
    Plot::Points route;
    for (const PathPoint& point : path.points) route.emplace_back(point.position.head<2>());
    plot.curve(
        route,
        {.color = path.color, .width = width, .name = path.name, .halo = isLowest ? 1.2 : 0.});
}

}  // namespace

double readableEllipseScale(const std::vector<DrawnPath>& paths, double side) {
    double variance = 0.;
    for (const DrawnPath& path : paths) {
        for (const PathPoint& point : path.points)
            variance = std::max(variance, point.positionCovariance.diagonal().maxCoeff());
    }
    if (!(variance > 0.)) return 1.;
    const double largest = 0.05 * side / (3. * std::sqrt(variance));
    if (!(largest >= 1.)) return 1.;
    const double decade = std::pow(10., std::floor(std::log10(largest)));
    return (largest >= 5. * decade ? 5. : largest >= 2. * decade ? 2. : 1.) * decade;
}

Plot topViewPlot(const TopView& view, double side) {
    Plot plot = Plot::map(view.area, side);
    if (view.background.getSize() > 0) plot.picture(lightened(view.background), view.area, true);
    for (const DrawnTree& tree : view.trees)
        if (!tree.isOnTop) addTree(plot, tree);
    if (view.horizontalFov > 0.)
        for (const DrawnPath& path : view.paths) addWedges(plot, view, path);
    if (view.ellipseScale > 0.) {
        const std::string name = view.ellipseScale == 1.
                                     ? "3σ of the position"
                                     : fmt::format("3σ of the position, {:g}×", view.ellipseScale);
        for (const DrawnPath& path : view.paths) addEllipses(plot, path, view.ellipseScale, name);
    }
    for (std::size_t i = view.paths.size(); i-- > 0;) addRoute(plot, view, i);
    for (const DrawnTree& tree : view.trees)
        if (tree.isOnTop) addTree(plot, tree);
    plot.marker(view.start.head<2>(), kStartColor, "start");
    plot.marker(view.goal.head<2>(), kGoalColor, view.goalName);
    return plot;
}

Figure topViewFigure(const TopView& view) {
    return {view.title, {{topViewPlot(view, 820.)}}, Figure::Legend::right};
}

Figure mapsFigure(const std::vector<std::vector<TopView>>& rows) {
    Figure figure{.legend = Figure::Legend::none};
    for (const auto& row : rows) {
        auto& plots = figure.rows.emplace_back();
        for (TopView view : row) {
            view.ellipseScale = view.horizontalFov = 0.;
            Plot& plot = plots.emplace_back(topViewPlot(view, 420.));
            plot.title = view.title;
            if (&row != &rows.back()) plot.x.label.clear();
            if (plots.size() > 1) plot.y.label.clear();
        }
    }
    return figure;
}

}  // namespace photonav
