// SPDX-License-Identifier: BSD-3-Clause
// A panel of a figure: a frame with two axes and the marks drawn in it.
#pragma once

#include <Eigen/Geometry>
#include <functional>
#include <string>
#include <vector>

#include "plot/axis.hpp"
#include "plot/color.hpp"
#include "plot/picture.hpp"

namespace photonav {

class Painter;
struct Frame;
struct Mapping;

struct Style {
    Color color = kInk;
    double width = 2.;      ///< width of a line, or diameter of a dot [px]
    double opacity = 1.;    ///< of a mark as a whole, also where the mark overlaps itself
    std::string name = {};  ///< name in the legend; marks of the same name share an entry
    bool dashed = false;
    double halo = 0.;  ///< width of the white border on both sides of a line [px]
};

/// Marks are drawn in the order of the calls. Coordinates are in the units of the axes. Infinite
/// coordinates are at the border of the frame; NaN leaves a gap.
class Plot {
  public:
    using Point = Eigen::Vector2d;
    using Points = std::vector<Point>;

    std::string title = {};
    Axis x = {}, y = {};
    double width = 860., height = 260.;  ///< size of the frame [px]
    bool hasAxes = true;

    /// An empty plot of an area [m], with the same scale in x and y.
    /// @param side longer side of the frame [px]
    /// @throws std::invalid_argument if the area is empty
    static Plot map(const Eigen::AlignedBox2d& area, double side);

    /// A plot of a picture in pixel coordinates (u, v): pixel centres lie at integers, v points
    /// downward. Without axes.
    /// @param width width of the frame [px]; the height follows from the picture
    /// @param smooth true: pixels are interpolated
    static Plot image(Picture picture, double width, bool smooth = false);

    void curve(Points points, Style style);
    void dots(Points points, Style style);
    /// Lines between the points 0 and 1, 2 and 3, ...
    void segments(const Points& ends, Style style);
    void fill(std::vector<Points> outlines, Style style);
    /// The area between two curves of as many points.
    void band(const Points& low, const Points& high, Style style);
    /// A dot with a white border, for places.
    void marker(const Point& at, const Color& color, const std::string& name);
    /// Text centred at a point.
    void text(const Point& at, const std::string& words);
    void picture(Picture picture, const Eigen::AlignedBox2d& box, bool smooth);
    void hatched(std::vector<Eigen::AlignedBox2d> boxes, const std::string& name);
    /// Adds a colour bar on the right of the frame.
    /// @param colorAt colour of a share in [0, 1] of the scale
    void colorBar(const Axis& scale, Color (*colorAt)(double) = viridis) {
        bar_ = {{scale, colorAt}};
    }

  private:
    friend class FigureLayout;

    struct LegendEntry {
        std::string name;
        std::function<void(Painter&, const Frame&)> draw;
    };

    struct ColorBar {
        Axis scale;
        Color (*colorAt)(double);
    };

    void add(const Points& points, const Style& style,
             std::function<void(Painter&, const Mapping&)> draw,
             std::function<void(Painter&, const Frame&)> drawSample);

    std::vector<std::function<void(Painter&, const Mapping&)>> marks_;
    std::vector<LegendEntry> legend_;
    std::vector<double> xs_, ys_;  ///< all coordinates, for the limits of the axes
    std::vector<ColorBar> bar_;    ///< none or one
};

/// Outline of the ellipse of `sigmas` standard deviations around a point.
Plot::Points ellipse(const Plot::Point& mean, const Eigen::Matrix2d& covariance, double sigmas);

}  // namespace photonav
