// SPDX-License-Identifier: BSD-3-Clause
#include "figures.hpp"

#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <functional>
#include <numbers>
#include <stdexcept>

#include "constants.hpp"
#include "path_overlap.hpp"
#include "plot.hpp"

namespace photonav {
namespace {

constexpr double kSigmas = 3.0;                      // size of the ellipses
constexpr double kLeft = 96.0, kBottom = 76.0;       // margins with tick and axis labels [px]
constexpr double kTop = 58.0;                        // margin with the title [px]
constexpr double kBetween = 52.0, kTicks = 36.0;     // maps in rows: room for ticks alone [px]
constexpr double kLegendGap = 28.0, kSwatch = 34.0;  // [px]
constexpr Color kWhite{255, 255, 255};

void requireArea(const Eigen::AlignedBox2d& area) {
    if (area.isEmpty() || area.sizes().minCoeff() <= 0.0)
        throw std::invalid_argument("figure: the area is empty");
}

void drawTitle(Canvas& canvas, const std::string& title, double x) {
    canvas.text(title, {x, 34.0}, Align::left, kInk, 21.0);
}

/// Frame of an area at equal scale of both axes, as large as `side` allows.
Frame mapFrame(const Eigen::AlignedBox2d& area, double side) {
    const Eigen::Vector2d size = area.sizes() * (side / area.sizes().maxCoeff());
    return {kLeft, kTop, std::max(size.x(), 160.0), std::max(size.y(), 160.0)};
}

Plot mapPlot(Canvas& canvas, const Frame& frame, const Eigen::AlignedBox2d& area) {
    return {canvas,
            frame,
            {area.min().x(), area.max().x(), false, "x [m]"},
            {area.min().y(), area.max().y(), false, "y [m]"}};
}

/// What a figure explains beside itself: a small drawing around a point, and words.
struct LegendEntry {
    std::string words;
    std::function<void(Canvas&, const Canvas::Point&)> drawSample;
};

LegendEntry lineEntry(const std::string& words, const Color& color, double width) {
    return {words, [=](Canvas& canvas, const Canvas::Point& center) {
                const Canvas::Point reach(kSwatch / 2, 0.0);
                canvas.line(center - reach, center + reach, color, width);
            }};
}

double legendWidth(const std::vector<LegendEntry>& entries) {
    double width = 0.0;
    for (const LegendEntry& entry : entries)
        width = std::max(width, Canvas::textWidth(entry.words));
    return kSwatch + 12.0 + width;
}

void drawLegendEntry(Canvas& canvas, const LegendEntry& entry, const Canvas::Point& corner) {
    entry.drawSample(canvas, corner + Canvas::Point(kSwatch / 2, 0.0));
    canvas.text(entry.words, corner + Canvas::Point(kSwatch + 12.0, 6.0), Align::left, kInk);
}

void drawMarker(Canvas& canvas, const Canvas::Point& at, const Color& color) {
    canvas.disc(at, 9.0, kWhite);
    canvas.disc(at, 7.0, color);
}

constexpr Color kStart{22, 128, 57}, kGoal{160, 28, 92};

/// Outline of the `sigmas` ellipse of a position's x and y.
std::vector<Canvas::Point> ellipse(const Plot& plot, const PathPoint& point, double sigmas) {
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> solver(
        point.positionCovariance.topLeftCorner<2, 2>());
    const Eigen::Matrix2d axes =
        solver.eigenvectors() *
        (sigmas * solver.eigenvalues().cwiseMax(0.0).cwiseSqrt()).asDiagonal();
    std::vector<Canvas::Point> outline;
    for (int i = 0; i <= 48; ++i) {
        const double angle = 2.0 * std::numbers::pi * i / 48;
        const Eigen::Vector2d p =
            point.position.head<2>() + axes * Eigen::Vector2d(std::cos(angle), std::sin(angle));
        outline.push_back(plot.at(p.x(), p.y()));
    }
    return outline;
}

/// Points about a twentieth of the path apart, with its ends: more ellipses hide each other.
std::vector<PathPoint> spaced(const std::vector<PathPoint>& points) {
    std::vector<PathPoint> chosen;
    if (points.empty()) return chosen;
    const double step = points.back().distance / 20.0;
    for (const PathPoint& point : points)
        if (chosen.empty() || point.distance >= chosen.back().distance + step)
            chosen.push_back(point);
    if (chosen.back().distance < points.back().distance) chosen.push_back(points.back());
    return chosen;
}

void drawEllipses(const Plot& plot, const DrawnPath& path, double scale) {
    std::vector<std::vector<Canvas::Point>> outlines;
    for (const PathPoint& point : spaced(path.points))
        outlines.push_back(ellipse(plot, point, kSigmas * scale));
    plot.canvas.translucent(0.22, [&] {
        for (const auto& outline : outlines) plot.canvas.fill(outline, path.color);
    });
    for (const auto& outline : outlines) plot.canvas.polyline(outline, path.color, 1.2);
}

/// Whether most of one path of a view is drawn along another one.
bool areTogether(const TopView& view, const DrawnPath& path, const DrawnPath& other) {
    return runsAlong(path, other, 0.004 * view.area.sizes().maxCoeff());
}

/// Wider for each path on top, so that none hides another.
double routeWidth(const TopView& view, std::size_t path) {
    double width = 3.6;
    for (std::size_t i = 0; i < path; ++i)
        if (areTogether(view, view.paths[path], view.paths[i])) width += 4.0;
    return width;
}

/// White on both sides sets it off, but from a path that runs below.
void drawRoute(const Plot& plot, const TopView& view, std::size_t path) {
    std::vector<Canvas::Point> route;
    for (const PathPoint& point : view.paths[path].points)
        route.push_back(plot.at(point.position.x(), point.position.y()));
    const double width = routeWidth(view, path);
    const bool isLowest =
        std::none_of(view.paths.begin() + static_cast<long>(path) + 1, view.paths.end(),
                     [&](const auto& below) { return areTogether(view, below, view.paths[path]); });
    if (isLowest) plot.canvas.polyline(route, kWhite, width + 2.4);
    plot.canvas.polyline(route, view.paths[path].color, width);
}

void drawTree(const Plot& plot, const DrawnTree& tree) {
    const double sparse = std::clamp(60.0 / static_cast<double>(tree.edges.size()), 0.25, 0.8);
    plot.canvas.translucent(tree.isOnTop ? 0.6 : sparse, [&] {
        for (const Edge& edge : tree.edges)
            plot.canvas.line(plot.at(edge[0].x(), edge[0].y()), plot.at(edge[1].x(), edge[1].y()),
                             tree.color, tree.isOnTop ? 1.3 : 0.7);
    });
}

/// The background is lightened, so that lines stand out on it.
void drawBackground(Canvas& canvas, const ImageF& background, const Frame& frame) {
    if (background.getSize() == 0) return;
    std::vector<Color> pixels(background.getSize());
    std::transform(background.bitmap, background.bitmap + background.getSize(), pixels.begin(),
                   [](float grey) {
                       const auto level = static_cast<std::uint8_t>(
                           std::lround(110.0F + 140.0F * std::clamp(grey, 0.0F, 1.0F)));
                       return Color{level, level, level};
                   });
    canvas.picture(pixels, static_cast<int>(background.getWidth()), frame, true);
}

void drawMap(const Plot& plot, const TopView& view) {
    plot.drawGrid();
    drawBackground(plot.canvas, view.background, plot.frame);
    {
        const auto clipped = plot.canvas.clip(plot.frame);
        const auto drawTrees = [&](bool onTop) {
            for (const DrawnTree& tree : view.trees)
                if (tree.isOnTop == onTop) drawTree(plot, tree);
        };
        drawTrees(false);
        if (view.ellipseScale > 0.0)
            for (const DrawnPath& path : view.paths) drawEllipses(plot, path, view.ellipseScale);
        for (std::size_t i = view.paths.size(); i-- > 0;) drawRoute(plot, view, i);
        drawTrees(true);
        drawMarker(plot.canvas, plot.at(view.start.x(), view.start.y()), kStart);
        drawMarker(plot.canvas, plot.at(view.goal.x(), view.goal.y()), kGoal);
    }
    plot.drawAxes();
}

std::vector<LegendEntry> legendOf(const TopView& view) {
    std::vector<LegendEntry> entries;
    for (std::size_t i = 0; i < view.paths.size(); ++i)
        entries.push_back(lineEntry(view.paths[i].name, view.paths[i].color,
                                    std::min(routeWidth(view, i), 10.0)));
    for (const DrawnTree& tree : view.trees)
        entries.push_back(lineEntry(tree.name, tree.color, 1.0));
    if (view.ellipseScale > 0.0 && !view.paths.empty()) {
        const Color color = view.paths[0].color;
        const std::string size =
            view.ellipseScale == 1.0 ? "" : fmt::format(", {:g}x", view.ellipseScale);
        entries.push_back({"3 sigma position" + size, [color](Canvas& canvas, const auto& center) {
                               canvas.translucent(0.22, [&] { canvas.disc(center, 9.0, color); });
                           }});
    }
    for (const auto& [words, color] :
         {std::pair{std::string("start"), kStart}, std::pair{view.goalName, kGoal}})
        entries.push_back({words, [color = color](Canvas& canvas, const auto& center) {
                               drawMarker(canvas, center, color);
                           }});
    return entries;
}

/// Smallest and largest positive finite value, widened so that an axis has a length.
template <typename Values>
Axis axisAround(const Values& values, bool log, const std::string& label) {
    double low = kInfinity, high = -low;
    for (const double value : values)
        if (std::isfinite(value) && (!log || value > 0.0)) {
            low = std::min(low, value);
            high = std::max(high, value);
        }
    if (low > high) return {log ? 0.1 : 0.0, 1.0, log, label};
    if (log) return {low / 1.15, high * 1.15, true, label};
    if (low == high) return {std::min(0.0, 2.0 * low), low > 0.0 ? 2.0 * low : 1.0, false, label};
    return {low, high, false, label};
}

constexpr Color kOffScale{58, 58, 62};  // zero has no place on a logarithmic scale
/// Cells as pixels, the largest y first; NaN where nothing is known shows as white.
std::vector<Color> cellColors(const HeatMap& map, const Axis& scale) {
    const std::array<Color, 256> colors = viridis();
    std::vector<Color> pixels;
    for (Eigen::Index j = map.values.cols() - 1; j >= 0; --j)
        for (Eigen::Index i = 0; i < map.values.rows(); ++i) {
            const double value = map.values(i, j);
            const double level = std::clamp(255.0 * scale.fraction(value), 0.0, 255.0);
            const bool isNothing = map.logScale && value <= 0.0;
            pixels.push_back(!std::isfinite(value) ? kWhite
                             : isNothing           ? kOffScale
                                                   : colors[static_cast<std::size_t>(level)]);
        }
    return pixels;
}

constexpr Color kHatch{168, 174, 181}, kHatchGround{240, 241, 243};

void fillSwatch(Canvas& canvas, const Canvas::Point& center, const Color& color) {
    const double x = center.x() - 16.0;
    const double y = center.y() - 9.0;
    canvas.fill({{x, y}, {x + 32.0, y}, {x + 32.0, y + 18.0}, {x, y + 18.0}}, color);
}

void drawHatched(Canvas& canvas, const Frame& cell) {
    canvas.fill({{cell.x, cell.y},
                 {cell.right(), cell.y},
                 {cell.right(), cell.bottom()},
                 {cell.x, cell.bottom()}},
                kHatchGround);
    const auto clipped = canvas.clip(cell);
    const double step = 9.0;  // the same lines x + y = k step everywhere, across cells
    for (double k = std::floor((cell.x + cell.y) / step); k * step < cell.right() + cell.bottom();
         ++k)
        canvas.line({k * step - cell.y, cell.y}, {k * step - cell.bottom(), cell.bottom()}, kHatch,
                    1.2);
}

void drawUnflyable(const HeatMap& map, const Plot& plot) {
    const Eigen::Vector2d cell =
        map.area.sizes().array() / Eigen::Array2d(static_cast<double>(map.values.rows()),
                                                  static_cast<double>(map.values.cols()));
    for (Eigen::Index i = 0; i < map.values.rows(); ++i)
        for (Eigen::Index j = 0; j < map.values.cols(); ++j) {
            if (std::isfinite(map.values(i, j))) continue;
            const Eigen::Vector2d low = map.area.min() + cell.cwiseProduct(Eigen::Vector2d(i, j));
            const Canvas::Point corner = plot.at(low.x(), low.y() + cell.y());
            const Canvas::Point end = plot.at(low.x() + cell.x(), low.y());
            drawHatched(plot.canvas,
                        {corner.x(), corner.y(), end.x() - corner.x(), end.y() - corner.y()});
        }
}

}  // namespace

PathPoint makePathPoint(const UncertainPose& T_c_w, double trace, double distance, double cost) {
    const Pose T_w_c = T_c_w.mean.inverse();
    const Eigen::Matrix3d R_w_c = T_w_c.linear();
    return {
        .position = T_w_c.translation(),
        .T_w_c = T_w_c,
        .trace = trace,
        .positionCovariance = R_w_c * T_c_w.covariance.topLeftCorner<3, 3>() * R_w_c.transpose(),
        .distance = distance,
        .cost = cost};
}

Png drawTopView(const TopView& view) {
    requireArea(view.area);
    const Frame frame = mapFrame(view.area, 820.0);
    const std::vector<LegendEntry> legend = legendOf(view);
    Canvas canvas(frame.right() + kLegendGap + legendWidth(legend) + 24.0,
                  std::max(frame.bottom() + kBottom,
                           kTop + 60.0 + 32.0 * static_cast<double>(legend.size())));
    drawMap(mapPlot(canvas, frame, view.area), view);
    drawTitle(canvas, view.title, frame.x);
    for (std::size_t i = 0; i < legend.size(); ++i)
        drawLegendEntry(
            canvas, legend[i],
            {frame.right() + kLegendGap, frame.y + 12.0 + 32.0 * static_cast<double>(i)});
    return canvas.png();
}

Png drawMaps(const std::vector<std::vector<TopView>>& rows) {
    if (rows.empty() || rows[0].empty()) throw std::invalid_argument("figure: no maps");
    requireArea(rows[0][0].area);
    const Frame first = mapFrame(rows[0][0].area, 420.0);
    const double width = first.width + kBetween;
    const double height = first.bottom() + kTicks;
    std::size_t columns = 0;
    for (const auto& row : rows) columns = std::max(columns, row.size());
    Canvas canvas(first.x + width * static_cast<double>(columns),
                  height * static_cast<double>(rows.size()) + kBottom - kTicks);
    for (std::size_t i = 0; i < rows.size(); ++i)
        for (std::size_t j = 0; j < rows[i].size(); ++j) {
            TopView view = rows[i][j];
            requireArea(view.area);
            view.ellipseScale = 0.0;
            const Canvas::Point corner(width * static_cast<double>(j),
                                       height * static_cast<double>(i));
            const Frame frame{corner.x() + first.x, corner.y() + first.y, first.width,
                              first.height};
            Plot plot = mapPlot(canvas, frame, view.area);
            if (i + 1 < rows.size()) plot.x.label.clear();
            if (j > 0) plot.y.label.clear();
            drawMap(plot, view);
            canvas.text(view.title, {frame.x, corner.y() + 34.0}, Align::left, kInk);
        }
    return canvas.png();
}

Png drawTrace(const std::string& title, const std::vector<DrawnPath>& paths, bool logScale) {
    const Frame frame{kLeft + 20.0, kTop + 34.0, 900.0, 420.0};
    Canvas canvas(frame.right() + 32.0, frame.bottom() + kBottom);
    std::vector<double> distances{0.0}, traces;
    for (const DrawnPath& path : paths)
        for (const PathPoint& point : path.points) {
            distances.push_back(point.distance);
            traces.push_back(point.trace);
        }
    if (!logScale) traces.push_back(0.0);
    const Plot plot{canvas, frame, axisAround(distances, false, "distance along the path [m]"),
                    axisAround(traces, logScale, "trace of the pose covariance [m^2 + L^2 rad^2]")};
    plot.drawGrid();
    {
        const auto clipped = canvas.clip(frame);
        for (auto path = paths.rbegin(); path != paths.rend(); ++path) {
            std::vector<Canvas::Point> curve;
            for (const PathPoint& point : path->points)
                curve.push_back(plot.at(point.distance, point.trace));
            canvas.polyline(curve, path->color, 2.6);
        }
    }
    plot.drawAxes();
    drawTitle(canvas, title, frame.x);
    Canvas::Point corner(frame.x, kTop + 8.0);
    for (const DrawnPath& path : paths) {
        drawLegendEntry(canvas, lineEntry(path.name, path.color, 3.0), corner);
        corner.x() += kSwatch + Canvas::textWidth(path.name) + 48.0;
    }
    return canvas.png();
}

Png drawHeatMap(const HeatMap& map) {
    requireArea(map.area);
    if (map.values.size() == 0) throw std::invalid_argument("drawHeatMap: no values");
    const Frame frame = mapFrame(map.area, 760.0);
    const double title = 12.5 * static_cast<double>(map.title.size());
    Canvas canvas(std::max(frame.right() + 190., frame.x + title), frame.bottom() + kBottom + 34.);
    const Axis scale = axisAround(map.values.reshaped(), map.logScale, map.label);
    const Plot plot = mapPlot(canvas, frame, map.area);
    canvas.picture(cellColors(map, scale), static_cast<int>(map.values.rows()), frame, false);
    drawUnflyable(map, plot);
    plot.drawAxes();
    drawColorBar(canvas, {frame.right() + 30.0, frame.y, 22.0, frame.height}, scale, viridis());
    drawTitle(canvas, map.title, frame.x);
    double left = frame.x;
    if (map.logScale && (map.values <= 0.0).any()) {
        const LegendEntry entry{"nothing", [](Canvas& sheet, const Canvas::Point& center) {
                                    fillSwatch(sheet, center, kOffScale);
                                }};
        drawLegendEntry(canvas, entry, {left, frame.bottom() + kBottom + 8.0});
        left += 150.0;
    }
    if (!map.values.isFinite().all()) {
        const LegendEntry entry{
            "not flyable", [](Canvas& sheet, const Canvas::Point& center) {
                drawHatched(sheet, {center.x() - 16.0, center.y() - 9.0, 32.0, 18.0});
            }};
        drawLegendEntry(canvas, entry, {left, frame.bottom() + kBottom + 8.0});
    }
    return canvas.png();
}

}  // namespace photonav
