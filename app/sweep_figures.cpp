// SPDX-License-Identifier: BSD-3-Clause
#include "sweep_figures.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "constants.hpp"
#include "plot.hpp"

namespace photonav {
namespace {

constexpr double kSweepLeft = 112.0, kSweepTop = 96.0, kSweepWidth = 860.0, kSweepHeight = 260.0,
                 kGap = 44.0;    // [px]
constexpr double kBelow = 76.0;  // a frame: ticks and label of the x axis [px]
constexpr std::array<Color, 6> kColors{
    {kPathColor, kBaselineColor, kTreeColor, {142, 68, 173}, {176, 128, 12}, {98, 104, 112}}};
constexpr Color kPaperColor = kInk;

struct Planner {
    std::string name;
    Color color;
    double extra = 0.;  ///< width, so that it shows below those drawn upon it [px]
};

std::vector<Planner> coloured(const std::vector<std::string>& names) {
    std::vector<Planner> planners;
    planners.reserve(names.size());
    for (const std::string& name : names) {
        planners.push_back({name, kColors[planners.size() % kColors.size()],
                            2.6 * static_cast<double>(planners.size())});
    }
    return planners;
}

std::vector<Planner> plannersOf(const std::vector<SweepCell>& cells) {
    std::vector<std::string> names;
    for (const SweepCell& cell : cells) {
        if (names.empty() || names.back() != cell.planner) names.push_back(cell.planner);
    }
    return coloured(names);
}

Axis axisOver(const std::vector<double>& values, bool log, const std::string& label) {
    double low = kInfinity;
    double high = -low;
    for (const double value : values) {
        if (!std::isfinite(value) || (log && value <= 0.)) continue;
        low = std::min(low, value);
        high = std::max(high, value);
    }
    if (low > high) return {log ? 0.1 : 0.0, 1.0, log, label};
    if (log) return {low / 1.25, high * 1.25, true, label};
    const double margin = std::max(0.06 * (high - low), 0.02 * std::abs(high) + 1e-9);
    return {low - margin, high + margin, false, label};
}

void drawHead(Canvas& canvas, const std::string& title, const std::vector<Planner>& planners,
              bool withPaper) {
    canvas.text(title, {kSweepLeft, 34.0}, Align::left, kInk, 21.0);
    double x = kSweepLeft;
    const auto entry = [&](const std::string& name, const Color& color) {
        canvas.disc({x + 8.0, 66.0}, 7.0, color);
        canvas.text(name, {x + 24.0, 72.0}, Align::left, kInk);
        x += 24.0 + Canvas::textWidth(name) + 34.0;
    };
    for (const Planner& planner : planners) entry(planner.name, planner.color);
    if (withPaper) entry("paper", kPaperColor);
}

bool hasPaper(const std::vector<SweepCell>& cells) {
    return std::any_of(cells.begin(), cells.end(), [](const auto& c) { return c.paper; });
}

/// What the three plots of drawSweepCurves() show.
struct Quantity {
    std::string column, label;
    bool log;
    double PaperRow::*paper;
};

struct CurvePoint {
    double alpha, mean, deviation;
};

void drawCurve(const Plot& plot, const std::vector<CurvePoint>& points, const Planner& planner) {
    const Color& color = planner.color;
    std::vector<Canvas::Point> line;
    for (const CurvePoint& p : points) {
        line.push_back(plot.at(p.alpha, p.mean));
        if (!(p.deviation > 0.)) continue;
        const Canvas::Point low = plot.at(p.alpha, p.mean - p.deviation);
        const Canvas::Point high = plot.at(p.alpha, p.mean + p.deviation);
        const Canvas::Point half(5.0, 0.0);
        plot.canvas.line(low, high, color, 1.6);
        plot.canvas.line(low - half, low + half, color, 1.6);
        plot.canvas.line(high - half, high + half, color, 1.6);
    }
    plot.canvas.polyline(line, color, 2.4 + planner.extra / 2.);
    for (const Canvas::Point& point : line)
        plot.canvas.disc(point, 4.5 + planner.extra / 2., color);
}

std::vector<CurvePoint> curveOf(const std::string& planner, const Quantity& quantity,
                                const std::vector<SweepCell>& cells) {
    std::vector<CurvePoint> points;
    for (const SweepCell& cell : cells) {
        const Statistic value = cell.columns.at(quantity.column);
        if (cell.planner != planner || !std::isfinite(value.mean)) continue;
        points.push_back({cell.alpha, value.mean, value.deviation});
    }
    std::sort(points.begin(), points.end(),
              [](const auto& a, const auto& b) { return a.alpha < b.alpha; });
    return points;
}

/// The paper's rows, in discs without a line.
std::vector<CurvePoint> paperPoints(const Quantity& quantity, const std::vector<SweepCell>& cells) {
    std::vector<CurvePoint> points;
    for (const SweepCell& cell : cells) {
        if (cell.paper) points.push_back({cell.alpha, (*cell.paper).*quantity.paper, 0.});
    }
    return points;
}

void drawQuantity(Canvas& canvas, const Frame& frame, const Quantity& quantity,
                  const std::vector<SweepCell>& cells) {
    std::vector<double> alphas;
    std::vector<double> values;
    for (const SweepCell& cell : cells) {
        const Statistic value = cell.columns.at(quantity.column);
        alphas.push_back(cell.alpha);
        const double deviation = std::isfinite(value.deviation) ? value.deviation : 0.;
        for (const double end : {value.mean, value.mean + deviation}) values.push_back(end);
        if (!quantity.log) values.push_back(value.mean - deviation);
    }
    const auto paper = paperPoints(quantity, cells);
    for (const CurvePoint& point : paper) values.push_back(point.mean);
    const Plot plot{canvas, frame, axisOver(alphas, false, "alpha"),
                    axisOver(values, quantity.log, quantity.label)};
    plot.drawGrid();
    {
        const auto clipped = canvas.clip(frame);
        for (const CurvePoint& p : paper) canvas.disc(plot.at(p.alpha, p.mean), 6.0, kPaperColor);
        const auto planners = plannersOf(cells);
        for (auto planner = planners.rbegin(); planner != planners.rend(); ++planner) {
            drawCurve(plot, curveOf(planner->name, quantity, cells), *planner);
        }
    }
    plot.drawAxes();
}

}  // namespace

Png drawSweepCurves(const std::string& title, const std::vector<SweepCell>& cells) {
    const std::array<Quantity, 3> quantities{
        {{"length", "length [m]", false, &PaperRow::length},
         {"mean_trace", "mean trace [m^2 + rad^2]", true, &PaperRow::meanTrace},
         {"goal_trace", "goal trace [m^2 + rad^2]", true, &PaperRow::goalTrace}}};
    const double step = kSweepHeight + kBelow + kGap - 20.0;
    Canvas canvas(kSweepLeft + kSweepWidth + 36.0, kSweepTop + quantities.size() * step);
    drawHead(canvas, title, plannersOf(cells), hasPaper(cells));
    double y = kSweepTop;
    for (const Quantity& quantity : quantities) {
        drawQuantity(canvas, {kSweepLeft, y, kSweepWidth, kSweepHeight}, quantity, cells);
        y += step;
    }
    return canvas.png();
}

Png drawSweepFront(const std::string& title, const std::vector<SweepCell>& cells,
                   const std::vector<SweepRun>& runs) {
    std::vector<double> lengths;
    std::vector<double> traces;
    for (const SweepRun& run : runs) {
        lengths.push_back(run.length);
        traces.push_back(run.meanTrace);
    }
    for (const SweepCell& cell : cells) {
        if (!cell.paper) continue;
        lengths.push_back(cell.paper->length);
        traces.push_back(cell.paper->meanTrace);
    }
    const Frame frame{kSweepLeft, kSweepTop, kSweepWidth, 560.0};
    Canvas canvas(frame.right() + 36.0, frame.bottom() + kBelow);
    drawHead(canvas, title, plannersOf(cells), hasPaper(cells));
    const Plot plot{canvas, frame, axisOver(lengths, false, "length [m]"),
                    axisOver(traces, true, "mean trace [m^2 + rad^2]")};
    plot.drawGrid();
    const auto at = [&](const SweepCell& cell) {
        return plot.at(cell.columns.at("length").mean, cell.columns.at("mean_trace").mean);
    };
    for (const SweepCell& cell : cells) {
        if (cell.paper)
            canvas.disc(plot.at(cell.paper->length, cell.paper->meanTrace), 5.0, kPaperColor);
    }
    const auto planners = plannersOf(cells);
    for (auto planner = planners.rbegin(); planner != planners.rend(); ++planner) {
        canvas.translucent(0.3, [&, name = planner->name, color = planner->color] {
            for (const SweepRun& run : runs) {
                if (run.item.planner == name && run.isSolved())
                    canvas.disc(plot.at(run.length, run.meanTrace), 3.5, color);
            }
        });
        std::vector<Canvas::Point> front;
        for (const std::size_t i : paretoFront(planner->name, cells)) front.push_back(at(cells[i]));
        canvas.polyline(front, planner->color, 2.0);
        for (const SweepCell& cell : cells) {
            if (cell.planner == planner->name && cell.solved > 0)
                canvas.disc(at(cell), 5.0 + planner->extra, planner->color);
        }
    }
    plot.drawAxes();
    return canvas.png();
}

Png drawCostOverTime(const std::string& title, const std::vector<std::string>& planners,
                     const std::vector<BenchmarkCurve>& curves) {
    std::vector<double> times;
    std::vector<double> costs;
    for (const BenchmarkCurve& curve : curves) {
        for (std::size_t i = 0; i < curve.cost.size(); ++i) {
            if (!std::isfinite(curve.cost[i])) continue;
            times.push_back(curve.seconds[i]);
            costs.push_back(curve.cost[i]);
        }
    }
    std::vector<Planner> drawn = coloured(planners);
    std::erase_if(drawn, [&](const Planner& planner) {
        return std::none_of(curves.begin(), curves.end(),
                            [&](const auto& curve) { return curve.planner == planner.name; });
    });
    const Frame frame{kSweepLeft, kSweepTop, kSweepWidth, 480.0};
    Canvas canvas(frame.right() + 36.0, frame.bottom() + kBelow);
    drawHead(canvas, title, drawn, false);
    const Plot plot{canvas, frame, axisOver(times, true, "time [s]"),
                    axisOver(costs, false, "cost of the best path")};
    plot.drawGrid();
    {
        const auto clipped = canvas.clip(frame);
        for (const Planner& planner : drawn) {
            for (const BenchmarkCurve& curve : curves) {
                if (curve.planner != planner.name) continue;
                std::vector<Canvas::Point> steps;
                for (std::size_t i = 0; i < curve.cost.size(); ++i) {
                    if (!std::isfinite(curve.cost[i])) continue;
                    const Canvas::Point next = plot.at(curve.seconds[i], curve.cost[i]);
                    if (!steps.empty()) steps.emplace_back(next.x(), steps.back().y());
                    steps.push_back(next);
                }
                canvas.polyline(steps, planner.color, 1.8);
                if (!steps.empty()) canvas.disc(steps.back(), 4.0, planner.color);
            }
        }
    }
    plot.drawAxes();
    return canvas.png();
}

std::vector<DrawnPath> pathsByAlpha(const std::string& planner, const std::vector<SweepRun>& runs) {
    std::map<double, const SweepRun*> best;
    for (const SweepRun& run : runs) {
        if (run.item.planner != planner || !run.isSolved()) continue;
        const SweepRun*& known = best[run.item.alpha];
        if (known == nullptr || run.cost < known->cost) known = &run;
    }
    const auto colors = viridis();
    std::vector<DrawnPath> paths;
    for (const auto& [alpha, run] : best) {
        DrawnPath path{fmt::format("alpha {}", alpha),
                       colors[static_cast<std::size_t>(std::lround(alpha * 240.))],
                       {}};
        for (const Eigen::Vector3d& p : run->path) {
            PathPoint point;
            point.position = p;
            point.T_w_c.translation() = p;
            if (!path.points.empty()) {
                const PathPoint& last = path.points.back();
                point.distance = last.distance + (p - last.position).norm();
            }
            path.points.push_back(point);
        }
        paths.push_back(path);
    }
    return paths;
}

std::vector<std::size_t> paretoFront(const std::string& planner,
                                     const std::vector<SweepCell>& cells) {
    std::vector<std::size_t> members;
    for (std::size_t i = 0; i < cells.size(); ++i) {
        if (cells[i].planner == planner && cells[i].solved > 0) members.push_back(i);
    }
    const auto length = [&](std::size_t i) { return cells[i].columns.at("length").mean; };
    const auto trace = [&](std::size_t i) { return cells[i].columns.at("mean_trace").mean; };
    std::sort(members.begin(), members.end(), [&](std::size_t a, std::size_t b) {
        return std::pair(length(a), trace(a)) < std::pair(length(b), trace(b));
    });
    std::vector<std::size_t> front;
    for (const std::size_t i : members) {
        if (front.empty() || trace(i) < trace(front.back())) front.push_back(i);
    }
    return front;
}

}  // namespace photonav
