// SPDX-License-Identifier: BSD-3-Clause
// Maps points from the units of a plot's axes to pixels.
#pragma once

#include "plot/painter.hpp"
#include "plot/plot.hpp"

namespace photonav {

/// The frame of a plot and its axes. at() maps points and boxes in the units of the axes to pixels.
struct Mapping {
    Frame frame;
    Axis x, y;

    Point at(const Point& p) const {
        return {frame.x + frame.width * x.fraction(p.x()),
                frame.bottom() - frame.height * y.fraction(p.y())};
    }
    std::vector<Point> at(const std::vector<Point>& points) const {
        std::vector<Point> pixels;
        pixels.reserve(points.size());
        for (const Point& p : points) pixels.push_back(at(p));
        return pixels;
    }
    Frame at(const Eigen::AlignedBox2d& box) const {
        Eigen::AlignedBox2d pixels(at(Point(box.min())));
        pixels.extend(at(Point(box.max())));
        const Point size = pixels.sizes();
        return {pixels.min().x(), pixels.min().y(), size.x(), size.y()};
    }
};

}  // namespace photonav
