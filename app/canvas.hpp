// SPDX-License-Identifier: BSD-3-Clause
// A sheet to draw figures on.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "pictures.hpp"

namespace photonav {

struct Color {
    std::uint8_t red = 0, green = 0, blue = 0;
    bool operator==(const Color&) const = default;
};

enum class Align { left, center, right };

/// A rectangle in pixels, y downward.
struct Frame {
    double x = 0.0, y = 0.0, width = 0.0, height = 0.0;
    double right() const { return x + width; }
    double bottom() const { return y + height; }
};

/// A white sheet with floating-point pixel coordinates (y downward). It is drawn enlarged and
/// reduced at the end, which makes OpenCV's stroke font and thin lines smooth.
class Canvas {
  public:
    using Point = Eigen::Vector2d;
    static constexpr double kTextSize = 17.0;  ///< nominal text size [px]

    Canvas(double width, double height);
    ~Canvas();

    void line(const Point& a, const Point& b, const Color& color, double width);
    void polyline(const std::vector<Point>& points, const Color& color, double width);
    void fill(const std::vector<Point>& convexPolygon, const Color& color);
    void disc(const Point& center, double radius, const Color& color);

    /// Runs `drawing` on this canvas and lets what was there before shine through.
    void translucent(double opacity, const std::function<void()>& drawing);

    /// Stretches a picture (row by row, `columns` wide) over a frame.
    void picture(const std::vector<Color>& pixels, int columns, const Frame& frame, bool smooth);

    /// Keeps what is drawn next inside a frame, until the returned object goes.
    std::shared_ptr<void> clip(const Frame& frame);

    /// One line of text, `at` on its base line; ^ makes the number after it a superscript.
    void text(const std::string& content, Point at, Align align, const Color& color,
              double size = kTextSize);

    /// Text that reads upward, centred at `at`.
    void verticalText(const std::string& content, const Point& at, const Color& color);

    static double textWidth(const std::string& content, double size = kTextSize);

    Png png() const;

  private:
    struct Image;
    std::unique_ptr<Image> image_;
};

/// The perceptually uniform colour map "viridis", dark to bright.
std::array<Color, 256> viridis();

}  // namespace photonav
