// SPDX-License-Identifier: BSD-3-Clause
#include "plot/plot.hpp"

#include <Eigen/Eigenvalues>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include "plot/mapping.hpp"

namespace photonav {
namespace {

constexpr Color kHatch{168, 174, 181}, kHatchGround{240, 241, 243};

Point middle(const Frame& f) { return {f.x + 0.5 * f.width, f.y + 0.5 * f.height}; }

void drawLine(Painter& painter, const Plot::Points& points, const Style& style) {
    if (style.halo > 0.) painter.line(points, kWhite, style.width + 2. * style.halo);
    painter.line(points, style.color, style.width, style.dashed);
}

void drawMarker(Painter& painter, const Point& at, const Color& color) {
    painter.disc(at, 18., kWhite);
    painter.disc(at, 14., color);
}

void drawHatched(Painter& painter, const Frame& frame) {
    painter.box(frame, kHatchGround);
    painter.hatching(frame, kHatch, 1.2);
}

/// A translucent colour on white.
Color onWhite(const Color& color, double opacity) {
    const auto mixed = [&](std::uint8_t part) {
        return static_cast<std::uint8_t>(std::lround(255. - opacity * (255. - part)));
    };
    return {mixed(color.red), mixed(color.green), mixed(color.blue)};
}

/// Samples of the legend. They are opaque: SVG does not show translucent horizontal lines.
auto lineSample(const Style& style) {
    return [style](Painter& painter, const Frame& f) {
        const double y = middle(f).y();
        Style thin = style;
        thin.width = std::min(style.width, 0.6 * f.height);
        thin.color = onWhite(style.color, std::max(style.opacity, 0.5));
        drawLine(painter, {{f.x, y}, {f.right(), y}}, thin);
    };
}

auto boxSample(const Style& style) {
    return [color = onWhite(style.color, style.opacity)](Painter& painter, const Frame& f) {
        painter.box(f, color);
    };
}

}  // namespace

Plot Plot::map(const Eigen::AlignedBox2d& area, double side) {
    if (area.isEmpty() || area.sizes().minCoeff() <= 0.)
        throw std::invalid_argument("figure: the area is empty");
    const Eigen::Vector2d size = area.sizes() * (side / area.sizes().maxCoeff());
    Plot plot;
    plot.x = {area.min().x(), area.max().x(), false, "x [m]"};
    plot.y = {area.min().y(), area.max().y(), false, "y [m]"};
    plot.width = std::max(size.x(), 160.);
    plot.height = std::max(size.y(), 160.);
    return plot;
}

Plot Plot::image(Picture picture, double width, bool smooth) {
    if (picture.pixels.empty()) throw std::invalid_argument("figure: the picture is empty");
    const Eigen::Vector2d size(picture.columns, picture.rows());
    Plot plot;
    plot.hasAxes = false;
    const Eigen::Vector2d corner = Eigen::Vector2d::Constant(-0.5), opposite = corner + size;
    plot.x = {.min = corner.x(), .max = opposite.x(), .label = "u [px]"};
    plot.y = {.min = opposite.y(), .max = corner.y(), .label = "v [px]"};
    plot.width = width;
    plot.height = width * size.y() / size.x();
    plot.picture(std::move(picture), {corner, opposite}, smooth);
    return plot;
}

void Plot::add(const Points& points, const Style& style,
               std::function<void(Painter&, const Mapping&)> draw,
               std::function<void(Painter&, const Frame&)> drawSample) {
    for (const Point& p : points) {
        xs_.push_back(p.x());
        ys_.push_back(p.y());
    }
    if (!style.name.empty()) legend_.push_back({style.name, std::move(drawSample)});
    marks_.emplace_back(
        [draw = std::move(draw), opacity = style.opacity](Painter& painter, const Mapping& to) {
            painter.translucent(opacity, [&] { draw(painter, to); });
        });
}

void Plot::curve(Points points, Style style) {
    add(
        points, style,
        [points, style](Painter& painter, const Mapping& to) {
            drawLine(painter, to.at(points), style);
        },
        lineSample(style));
}

void Plot::segments(const Points& ends, Style style) {
    Points points;
    for (std::size_t i = 0; i + 1 < ends.size(); i += 2) {
        points.insert(points.end(), {ends[i], ends[i + 1]});
        points.emplace_back(Point::Constant(Axis::kAuto));
    }
    curve(std::move(points), std::move(style));
}

void Plot::dots(Points points, Style style) {
    add(
        points, style,
        [points, style](Painter& painter, const Mapping& to) {
            for (const Point& p : points) painter.disc(to.at(p), style.width, style.color);
        },
        [style](Painter& painter, const Frame& f) {
            painter.disc(middle(f), std::max(style.width, 6.), style.color);
        });
}

void Plot::fill(std::vector<Points> outlines, Style style) {
    Points all;
    for (const Points& outline : outlines) all.insert(all.end(), outline.begin(), outline.end());
    add(
        all, style,
        [outlines = std::move(outlines), color = style.color](Painter& painter, const Mapping& to) {
            for (const Points& outline : outlines) painter.fill(to.at(outline), color);
        },
        boxSample(style));
}

void Plot::band(const Points& low, const Points& high, Style style) {
    Points outline = low;
    outline.insert(outline.end(), high.rbegin(), high.rend());
    fill({outline}, std::move(style));
}

void Plot::marker(const Point& at, const Color& color, const std::string& name) {
    add(
        {at}, {.name = name},
        [at, color](Painter& painter, const Mapping& to) { drawMarker(painter, to.at(at), color); },
        [color](Painter& painter, const Frame& f) { drawMarker(painter, middle(f), color); });
}

void Plot::text(const Point& at, const std::string& words) {
    add({at}, {},
        [at, words](Painter& painter, const Mapping& to) {
            const Font font;
            painter.text(words, to.at(at) + Point(0., 0.36 * font.size), Align::center, font);
        },
        {});
}

void Plot::picture(Picture picture, const Eigen::AlignedBox2d& box, bool smooth) {
    add({box.min(), box.max()}, {},
        [picture = std::move(picture), box, smooth](Painter& painter, const Mapping& to) {
            painter.picture(picture, to.at(box), smooth);
        },
        {});
}

void Plot::hatched(std::vector<Eigen::AlignedBox2d> boxes, const std::string& name) {
    if (boxes.empty()) return;
    add(
        {}, {.name = name},
        [boxes = std::move(boxes)](Painter& painter, const Mapping& to) {
            for (const Eigen::AlignedBox2d& box : boxes) drawHatched(painter, to.at(box));
        },
        drawHatched);
}

Plot::Points ellipse(const Plot::Point& mean, const Eigen::Matrix2d& covariance, double sigmas) {
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> solver(covariance);
    const Eigen::Matrix2d axes =
        solver.eigenvectors() *
        (sigmas * solver.eigenvalues().cwiseMax(0.).cwiseSqrt()).asDiagonal();
    Plot::Points outline;
    for (int i = 0; i <= 60; ++i) {
        const double angle = 2. * std::numbers::pi * i / 60;
        outline.emplace_back(mean + axes * Eigen::Vector2d(std::cos(angle), std::sin(angle)));
    }
    return outline;
}

}  // namespace photonav
