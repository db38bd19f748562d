// SPDX-License-Identifier: BSD-3-Clause
// Axes: from quantities to pixels, with ticks at round numbers.
#pragma once

#include <string>
#include <vector>

#include "canvas.hpp"

namespace photonav {

inline constexpr Color kInk{34, 38, 43}, kAxisColor{120, 126, 133}, kGridColor{228, 231, 234};

struct Axis {
    double min = 0.0, max = 1.0;  ///< min < max; both positive on a logarithmic axis
    bool log = false;
    std::string label = {};  ///< quantity and unit

    /// 0 at min, 1 at max. Values that have no logarithm lie on min.
    double fraction(double value) const;
};

struct Tick {
    double value;
    std::string label;
};

/// About `wanted` ticks at multiples of 1, 2 or 5 times a power of ten; decades (and 2 and 5
/// between them when there are few) on a logarithmic axis, unless fewer than two of these lie on
/// it.
std::vector<Tick> ticksOf(const Axis& axis, int wanted);

/// A frame on a canvas with its two axes; labels stand left of it and below.
struct Plot {
    Canvas& canvas;
    Frame frame;
    Axis x, y;

    Canvas::Point at(double px, double py) const;
    void drawGrid() const;
    void drawAxes() const;
};

void drawOutline(Canvas& canvas, const Frame& frame);

/// A vertical bar of colours right of `bar`'s left edge, with its scale and label on the right.
void drawColorBar(Canvas& canvas, const Frame& bar, const Axis& scale,
                  const std::array<Color, 256>& colors);

}  // namespace photonav
