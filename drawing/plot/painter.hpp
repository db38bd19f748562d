// SPDX-License-Identifier: BSD-3-Clause
// The drawing operations of figures on a cairo surface, in pixels (y downward).
#pragma once

#include <cairo.h>

#include <Eigen/Core>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "plot/color.hpp"
#include "plot/picture.hpp"

namespace photonav {

using Point = Eigen::Vector2d;

/// A rectangle in pixels.
struct Frame {
    double x = 0., y = 0., width = 0., height = 0.;
    double right() const { return x + width; }
    double bottom() const { return y + height; }
};

enum class Align { left, center, right };

struct Font {
    double size = 15.;  ///< [px]
    Color color = kInk;
    bool upward = false;  ///< rotated by 90 degrees: reads from bottom to top
};

using Surface = std::unique_ptr<cairo_surface_t, decltype(&cairo_surface_destroy)>;

/// Appends bytes to a std::string: a cairo_write_func_t, for files in memory.
/// @param text pointer to the std::string
cairo_status_t appendTo(void* text, const unsigned char* bytes, unsigned count);

class Painter {
  public:
    /// @param svgTexts if not null, texts are appended to it as SVG elements, not drawn. They are
    /// above everything that is drawn, without clipping and opacity
    explicit Painter(cairo_surface_t* surface, std::string* svgTexts = nullptr);

    /// A line through the points, `width` pixels wide; a point that is not finite leaves a gap.
    void line(const std::vector<Point>& points, const Color& color, double width,
              bool dashed = false);
    void fill(const std::vector<Point>& outline, const Color& color);
    void disc(const Point& center, double diameter, const Color& color);
    void box(const Frame& frame, const Color& color);
    void outline(const Frame& frame, const Color& color, double width);
    /// Diagonal lines. The lines of neighbouring frames join.
    void hatching(const Frame& frame, const Color& color, double width);
    /// A picture stretched over a frame.
    /// @param smooth true: pixels are interpolated
    void picture(const Picture& picture, const Frame& frame, bool smooth);

    /// One line of text; `at` is on the base line.
    void text(const std::string& content, const Point& at, Align align, const Font& font = {});
    double textWidth(const std::string& content, double size = Font{}.size);

    /// Draws the marks of `draw` as one layer with an opacity: where they overlap each other, the
    /// opacity is the same as elsewhere.
    void translucent(double opacity, const std::function<void()>& draw);
    /// Draws the marks of `draw`, cut at the frame.
    void clipped(const Frame& frame, const std::function<void()>& draw);

    /// @throws std::bad_alloc, or std::runtime_error, if something could not be drawn
    void check() const;

  private:
    void setColor(const Color& color);
    void setFont(double size);

    std::unique_ptr<cairo_t, decltype(&cairo_destroy)> cairo_;
    std::string* svgTexts_;
};

}  // namespace photonav
