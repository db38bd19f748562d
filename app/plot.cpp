// SPDX-License-Identifier: BSD-3-Clause
#include "plot.hpp"

#include <fmt/format.h>

#include <cmath>

namespace photonav {
namespace {

constexpr double kTickLength = 6.0;

std::vector<Tick> linearTicks(const Axis& axis, int wanted) {
    const double raw = (axis.max - axis.min) / std::max(1, wanted);
    const double decade = std::pow(10.0, std::floor(std::log10(raw)));
    double step = 10.0 * decade;
    for (const double nice : {5.0, 2.0, 1.0})
        if (nice * decade >= 0.7 * raw) step = nice * decade;
    const int digits = std::max(0, -static_cast<int>(std::floor(std::log10(step) + 1e-9)));
    const double slack = 1e-6 * step;
    const auto first = static_cast<long>(std::ceil((axis.min - slack) / step));
    const auto last = static_cast<long>(std::floor((axis.max + slack) / step));
    std::vector<Tick> ticks;
    for (long k = first; k <= last; ++k) {
        const double value = static_cast<double>(k) * step;
        ticks.push_back({value, fmt::format("{:.{}f}", value, digits)});
    }
    return ticks;
}

/// For a logarithmic axis that is shorter than the distance of its round numbers.
std::vector<Tick> shortLogTicks(const Axis& axis, int wanted) {
    std::vector<Tick> ticks = linearTicks(axis, wanted);
    const int decade = static_cast<int>(std::floor(std::log10(axis.max) + 1e-9));
    const double unit = std::pow(10.0, decade);
    if (decade >= -2 && decade <= 3) return ticks;
    for (Tick& tick : ticks) tick.label = fmt::format("{:.4g}x10^{}", tick.value / unit, decade);
    return ticks;
}

std::string logLabel(int digit, int decade, bool isPlain) {
    if (isPlain) return fmt::format("{:g}", digit * std::pow(10.0, decade));
    return digit == 1 ? fmt::format("10^{}", decade) : fmt::format("{}x10^{}", digit, decade);
}

std::vector<Tick> logTicks(const Axis& axis, int wanted) {
    const int first = static_cast<int>(std::floor(std::log10(axis.min) + 1e-9));
    const int last = static_cast<int>(std::floor(std::log10(axis.max) + 1e-9));
    const int stride = 1 + (last - first) / 9;
    const bool isPlain = first >= -2 && last <= 2;
    std::vector<Tick> ticks;
    for (int decade = first; decade <= last; decade += stride)
        for (const int digit : {1, 2, 5}) {
            const double value = digit * std::pow(10.0, decade);
            const bool crowded = digit > 1 && last - first > 2;
            if (crowded || value < axis.min * 0.999 || value > axis.max * 1.001) continue;
            ticks.push_back({value, logLabel(digit, decade, isPlain)});
        }
    return ticks.size() < 2 ? shortLogTicks(axis, wanted) : ticks;
}

double widestLabel(const std::vector<Tick>& ticks) {
    double widest = 0.0;
    for (const Tick& tick : ticks) widest = std::max(widest, Canvas::textWidth(tick.label));
    return widest;
}

std::vector<Tick> xTicks(const Plot& plot) {
    return ticksOf(plot.x, static_cast<int>(plot.frame.width / 90));
}
std::vector<Tick> yTicks(const Plot& plot) {
    return ticksOf(plot.y, static_cast<int>(plot.frame.height / 70));
}

}  // namespace

double Axis::fraction(double value) const {
    if (!log) return (value - min) / (max - min);
    return value > 0.0 ? std::log(value / min) / std::log(max / min) : 0.0;
}

std::vector<Tick> ticksOf(const Axis& axis, int wanted) {
    return axis.log ? logTicks(axis, wanted) : linearTicks(axis, wanted);
}

Canvas::Point Plot::at(double px, double py) const {
    return {frame.x + frame.width * x.fraction(px), frame.bottom() - frame.height * y.fraction(py)};
}

void Plot::drawGrid() const {
    for (const Tick& tick : xTicks(*this)) {
        const double px = at(tick.value, y.min).x();
        canvas.line({px, frame.y}, {px, frame.bottom()}, kGridColor, 1.0);
    }
    for (const Tick& tick : yTicks(*this)) {
        const double py = at(x.min, tick.value).y();
        canvas.line({frame.x, py}, {frame.right(), py}, kGridColor, 1.0);
    }
}

void Plot::drawAxes() const {
    drawOutline(canvas, frame);
    for (const Tick& tick : xTicks(*this)) {
        const Canvas::Point foot(at(tick.value, y.min).x(), frame.bottom());
        canvas.line(foot, foot + Canvas::Point(0, kTickLength), kAxisColor, 1.3);
        canvas.text(tick.label, foot + Canvas::Point(0, 25), Align::center, kInk);
    }
    const std::vector<Tick> ticks = yTicks(*this);
    for (const Tick& tick : ticks) {
        const Canvas::Point foot(frame.x, at(x.min, tick.value).y());
        canvas.line(foot, foot - Canvas::Point(kTickLength, 0), kAxisColor, 1.3);
        canvas.text(tick.label, foot + Canvas::Point(-11, 6), Align::right, kInk);
    }
    canvas.text(x.label, {frame.x + frame.width / 2, frame.bottom() + 54}, Align::center, kInk);
    canvas.verticalText(y.label, {frame.x - widestLabel(ticks) - 34, frame.y + frame.height / 2},
                        kInk);
}

void drawOutline(Canvas& canvas, const Frame& frame) {
    const Canvas::Point a(frame.x, frame.y), c(frame.right(), frame.bottom());
    const Canvas::Point b(c.x(), a.y()), d(a.x(), c.y());
    canvas.polyline({a, b, c, d, a}, kAxisColor, 1.3);
}

void drawColorBar(Canvas& canvas, const Frame& bar, const Axis& scale,
                  const std::array<Color, 256>& colors) {
    canvas.picture({colors.rbegin(), colors.rend()}, 1, bar, false);
    drawOutline(canvas, bar);
    const std::vector<Tick> ticks = ticksOf(scale, static_cast<int>(bar.height / 70));
    for (const Tick& tick : ticks) {
        const Canvas::Point foot(bar.right(),
                                 bar.bottom() - bar.height * scale.fraction(tick.value));
        canvas.line(foot, foot + Canvas::Point(kTickLength, 0), kAxisColor, 1.3);
        canvas.text(tick.label, foot + Canvas::Point(11, 6), Align::left, kInk);
    }
    canvas.verticalText(scale.label,
                        {bar.right() + widestLabel(ticks) + 36, bar.y + bar.height / 2}, kInk);
}

}  // namespace photonav
