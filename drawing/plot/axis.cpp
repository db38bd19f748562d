// SPDX-License-Identifier: BSD-3-Clause
#include "plot/axis.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace photonav {
namespace {

/// 10 to the power of n, as text.
std::string powerOfTen(int n) {
    static constexpr const char* kDigits[]{"⁰", "¹", "²", "³", "⁴", "⁵", "⁶", "⁷", "⁸", "⁹"};
    std::string text = "10";
    for (const char c : std::to_string(n)) text += c == '-' ? "⁻" : kDigits[c - '0'];
    return text;
}

std::string number(double value, int digits) {
    const std::string text = fmt::format("{:.{}f}", value, digits);
    return text.starts_with('-') ? "−" + text.substr(1) : text;
}

std::vector<Tick> linearTicks(const Axis& axis, int wanted) {
    const auto [low, high] = std::minmax(axis.min, axis.max);
    const double raw = (high - low) / std::max(1, wanted);
    const double decade = std::pow(10., std::floor(std::log10(raw)));
    double step = 10. * decade;
    for (const double nice : {5., 2., 1.})
        if (nice * decade >= 0.7 * raw) step = nice * decade;
    if (axis.whole) step = std::max(step, 1.);
    const int digits = std::max(0, -static_cast<int>(std::floor(std::log10(step) + 1e-9)));
    const double slack = 1e-6 * step;
    const auto first = static_cast<long>(std::ceil((low - slack) / step));
    const auto last = static_cast<long>(std::floor((high + slack) / step));
    std::vector<Tick> ticks;
    for (long k = first; k <= last; ++k) {
        const double value = static_cast<double>(k) * step;
        ticks.push_back({value, number(value, digits)});
    }
    return ticks;
}

/// For a logarithmic axis that is shorter than the distance of its round numbers.
std::vector<Tick> shortLogTicks(const Axis& axis, int wanted) {
    std::vector<Tick> ticks = linearTicks(axis, wanted);
    const int decade = static_cast<int>(std::floor(std::log10(axis.max) + 1e-9));
    if (decade >= -2 && decade <= 3) return ticks;
    for (Tick& tick : ticks)
        tick.label =
            fmt::format("{:.4g}·{}", tick.value / std::pow(10., decade), powerOfTen(decade));
    return ticks;
}

std::string logLabel(int digit, int decade, bool isPlain) {
    if (isPlain) return fmt::format("{:g}", digit * std::pow(10., decade));
    return digit == 1 ? powerOfTen(decade) : fmt::format("{}·{}", digit, powerOfTen(decade));
}

std::vector<Tick> logTicks(const Axis& axis, int wanted) {
    const int first = static_cast<int>(std::floor(std::log10(axis.min) + 1e-9));
    const int last = static_cast<int>(std::floor(std::log10(axis.max) + 1e-9));
    const int stride = 1 + (last - first) / 9;
    const bool isPlain = first >= -2 && last <= 2;
    std::vector<Tick> ticks;
    for (int decade = first; decade <= last; decade += stride)
        for (const int digit : {1, 2, 5}) {
            const double value = digit * std::pow(10., decade);
            const bool crowded = digit > 1 && last - first > 2;
            if (crowded || value < axis.min * 0.999 || value > axis.max * 1.001) continue;
            ticks.push_back({value, logLabel(digit, decade, isPlain)});
        }
    return ticks.size() < 2 ? shortLogTicks(axis, wanted) : ticks;
}

}  // namespace

double Axis::fraction(double value) const {
    if (std::isinf(value)) return value < 0. ? 0. : 1.;
    if (!log) return (value - min) / (max - min);
    return value > 0. ? std::log(value / min) / std::log(max / min) : value <= 0. ? 0. : kAuto;
}

Axis Axis::fittedTo(const std::vector<double>& values) const {
    double low = std::numeric_limits<double>::infinity();
    double high = -low;
    for (const double value : values) {
        if (!std::isfinite(value) || (log && value <= 0.)) continue;
        low = std::min(low, value);
        high = std::max(high, value);
    }
    if (low > high) {
        low = log ? 0.1 : 0.;
        high = 1.;
    } else if (log) {
        low /= 1.2;
        high *= 1.2;
    } else {
        const double margin = std::max(0.04 * (high - low), 0.02 * std::abs(high) + 1e-9);
        low -= margin;
        high += margin;
    }
    Axis fitted = *this;
    if (std::isnan(min))
        fitted.min = std::isnan(max) ? low : std::min(low, log ? max / 2. : max - 1.);
    if (std::isnan(max))
        fitted.max = high > fitted.min ? high : log ? 2. * fitted.min : fitted.min + 1.;
    return fitted;
}

std::vector<Tick> ticksOf(const Axis& axis, int wanted) {
    return axis.log ? logTicks(axis, wanted) : linearTicks(axis, wanted);
}

}  // namespace photonav
