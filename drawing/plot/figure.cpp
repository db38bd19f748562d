// SPDX-License-Identifier: BSD-3-Clause
#include "plot/figure.hpp"

#include <cairo-pdf.h>
#include <cairo-svg.h>

#include <algorithm>
#include <cstring>
#include <set>
#include <stdexcept>

#include "io/atomic_file.hpp"
#include "io/error.hpp"
#include "plot/mapping.hpp"

namespace photonav {
namespace {

constexpr Color kAxisColor{120, 126, 133}, kGridColor{228, 231, 234};
constexpr double kBorder = 20., kGap = 14., kTick = 6., kTitle = 20., kPanelTitle = 16.;
constexpr double kSwatchWidth = 32., kSwatchHeight = 15., kLegendRow = 28.;
constexpr double kTickRoom = 24., kLabelRoom = 26.;  // below a frame
constexpr double kBarWidth = 20., kBarGap = 26.;

struct Margins {
    double left = 0., right = 0., top = 0., bottom = 0.;
};

double widest(Painter& painter, const std::vector<Tick>& ticks) {
    double width = 0.;
    for (const Tick& tick : ticks) width = std::max(width, painter.textWidth(tick.label));
    return width;
}

std::vector<Tick> ticksAlong(const Axis& axis, double length, double distance) {
    return ticksOf(axis, static_cast<int>(length / distance));
}
std::vector<Tick> xTicks(const Axis& axis, const Frame& f) {
    return ticksAlong(axis, f.width, 90.);
}
std::vector<Tick> yTicks(const Axis& axis, const Frame& f) {
    return ticksAlong(axis, f.height, 70.);
}

/// Ticks and label of a vertical axis, left of it (side -1) or right of it (1).
void drawVerticalAxis(Painter& painter, const Axis& axis, const Frame& f, double side) {
    const double x = side < 0. ? f.x : f.right();
    const auto ticks = yTicks(axis, f);
    for (const Tick& tick : ticks) {
        const double y = f.bottom() - f.height * axis.fraction(tick.value);
        painter.line({{x, y}, {x + side * kTick, y}}, kAxisColor, 1.3);
        painter.text(tick.label, {x + side * 10., y + 5.}, side < 0. ? Align::right : Align::left);
    }
    const double base = x + side * (widest(painter, ticks) + (side < 0. ? 18. : 30.));
    painter.text(axis.label, {base, f.y + 0.5 * f.height}, Align::center, {.upward = true});
}

void drawGrid(Painter& painter, const Mapping& to) {
    const Frame& f = to.frame;
    std::vector<Point> lines;
    const auto add = [&](const Point& a, const Point& b) {
        lines.insert(lines.end(), {a, b, Point::Constant(Axis::kAuto)});
    };
    for (const Tick& tick : xTicks(to.x, f)) {
        const double x = f.x + f.width * to.x.fraction(tick.value);
        add({x, f.y}, {x, f.bottom()});
    }
    for (const Tick& tick : yTicks(to.y, f)) {
        const double y = f.bottom() - f.height * to.y.fraction(tick.value);
        add({f.x, y}, {f.right(), y});
    }
    painter.line(lines, kGridColor, 1.);
}

void drawAxes(Painter& painter, const Mapping& to) {
    const Frame& f = to.frame;
    painter.outline(f, kAxisColor, 1.3);
    for (const Tick& tick : xTicks(to.x, f)) {
        const double x = f.x + f.width * to.x.fraction(tick.value);
        painter.line({{x, f.bottom()}, {x, f.bottom() + kTick}}, kAxisColor, 1.3);
        painter.text(tick.label, {x, f.bottom() + 21.}, Align::center);
    }
    painter.text(to.x.label, {f.x + 0.5 * f.width, f.bottom() + kTickRoom + 20.}, Align::center);
    drawVerticalAxis(painter, to.y, f, -1.);
}

void drawColorBar(Painter& painter, const Axis& scale, Color (*colorAt)(double),
                  const Frame& beside) {
    Picture colors{{}, 1};
    for (int i = 255; i >= 0; --i) colors.pixels.push_back(colorAt(i / 255.));
    const Frame bar{beside.right() + kBarGap, beside.y, kBarWidth, beside.height};
    painter.picture(colors, bar, false);
    painter.outline(bar, kAxisColor, 1.3);
    drawVerticalAxis(painter, scale, bar, 1.);
}

}  // namespace

/// Where the panels of a figure are.
class FigureLayout {
  public:
    FigureLayout(const Figure& figure, Painter& painter) : figure_(figure), painter_(painter) {
        if (figure.rows.empty() || figure.rows[0].empty())
            throw std::invalid_argument("figure: no panels");
        for (const auto& row : figure.rows)
            for (const Plot& plot : row)
                for (auto entry = plot.legend_.rbegin(); entry != plot.legend_.rend(); ++entry)
                    if (names_.insert(entry->name).second) legend_.push_back(&*entry);
    }

    /// Draws everything. @returns width and height [px]
    Eigen::Vector2d draw() {
        const std::vector<Margins> columns = columnMargins();
        double width = 0.;
        for (std::size_t j = 0; j < columns.size(); ++j)
            width += columns[j].left + frameWidths_[j] + columns[j].right + (j > 0 ? kGap : 0.);
        double y = drawHead(width);
        const double top = y;
        for (const auto& row : figure_.rows) y = drawRow(row, columns, y) + kGap;
        double right = kBorder + width;
        double bottom = y - kGap;
        if (figure_.legend == Figure::Legend::right) {
            bottom = std::max(bottom, top + kLegendRow * double(legend_.size()));
            right = drawLegendColumn({right + kGap, top + 10.});
        }
        right = std::max(right, frameX_ + painter_.textWidth(figure_.title, kTitle));
        return {right + kBorder, bottom + kBorder};
    }

  private:
    Mapping mappingOf(const Plot& plot, const Point& corner) const {
        return {{corner.x(), corner.y(), plot.width, plot.height},
                plot.x.fittedTo(plot.xs_),
                plot.y.fittedTo(plot.ys_)};
    }

    Margins marginsOf(const Plot& plot) {
        Margins margins{0., 0., plot.title.empty() ? 0. : 27., 0.};
        if (plot.hasAxes) {
            const Mapping to = mappingOf(plot, {0., 0.});
            margins.left =
                widest(painter_, yTicks(to.y, to.frame)) + 12. + (plot.y.label.empty() ? 0. : 22.);
            margins.right = 8.;
            margins.bottom = kTickRoom + (plot.x.label.empty() ? 0. : kLabelRoom);
        }
        for (const Plot::ColorBar& bar : plot.bar_)
            margins.right = kBarGap + kBarWidth + 38. +
                            widest(painter_, ticksAlong(bar.scale, plot.height, 70.));
        return margins;
    }

    std::vector<Margins> columnMargins() {
        std::vector<Margins> columns;
        for (const auto& row : figure_.rows) {
            columns.resize(std::max(columns.size(), row.size()));
            frameWidths_.resize(columns.size());
            for (std::size_t j = 0; j < row.size(); ++j) {
                const Margins margins = marginsOf(row[j]);
                columns[j].left = std::max(columns[j].left, margins.left);
                columns[j].right = std::max(columns[j].right, margins.right);
                frameWidths_[j] = std::max(frameWidths_[j], row[j].width);
            }
        }
        frameX_ = kBorder + columns[0].left;
        return columns;
    }

    /// @returns where the panels begin
    double drawHead(double width) {
        double y = kBorder;
        if (!figure_.title.empty()) {
            painter_.text(figure_.title, {frameX_, y + 17.}, Align::left, {.size = kTitle});
            y += 34.;
        }
        if (figure_.legend != Figure::Legend::above || legend_.empty()) return y;
        double x = frameX_;
        for (const Plot::LegendEntry* entry : legend_) {
            const double room = kSwatchWidth + 10. + painter_.textWidth(entry->name);
            if (x > frameX_ && x + room > kBorder + width) {
                x = frameX_;
                y += kLegendRow;
            }
            drawEntry(*entry, {x, y});
            x += room + 28.;
        }
        return y + kLegendRow + 4.;
    }

    void drawEntry(const Plot::LegendEntry& entry, const Point& corner) {
        entry.draw(painter_, {corner.x(), corner.y(), kSwatchWidth, kSwatchHeight});
        painter_.text(entry.name, corner + Point(kSwatchWidth + 10., 0.5 * kSwatchHeight + 5.),
                      Align::left);
    }

    /// @returns its right end
    double drawLegendColumn(Point corner) {
        double width = 0.;
        for (const Plot::LegendEntry* entry : legend_) {
            drawEntry(*entry, corner);
            corner.y() += kLegendRow;
            width = std::max(width, kSwatchWidth + 10. + painter_.textWidth(entry->name));
        }
        return corner.x() + width;
    }

    /// @returns its lower end
    double drawRow(const std::vector<Plot>& row, const std::vector<Margins>& columns, double y) {
        Margins margins;
        double height = 0.;
        for (const Plot& plot : row) {
            margins.top = std::max(margins.top, marginsOf(plot).top);
            margins.bottom = std::max(margins.bottom, marginsOf(plot).bottom);
            height = std::max(height, plot.height);
        }
        double x = kBorder;
        for (std::size_t j = 0; j < row.size(); ++j) {
            drawPanel(row[j], mappingOf(row[j], {x + columns[j].left, y + margins.top}));
            x += columns[j].left + frameWidths_[j] + columns[j].right + kGap;
        }
        return y + margins.top + height + margins.bottom;
    }

    void drawPanel(const Plot& plot, const Mapping& to) {
        if (plot.hasAxes) drawGrid(painter_, to);
        painter_.clipped(to.frame, [&] {
            for (const auto& mark : plot.marks_) mark(painter_, to);
        });
        if (plot.hasAxes) drawAxes(painter_, to);
        for (const auto& [scale, colorAt] : plot.bar_)
            drawColorBar(painter_, scale, colorAt, to.frame);
        painter_.text(plot.title, {to.frame.x, to.frame.y - 9.}, Align::left,
                      {.size = kPanelTitle});
    }

    const Figure& figure_;
    Painter& painter_;
    std::set<std::string> names_;
    std::vector<const Plot::LegendEntry*> legend_;
    std::vector<double> frameWidths_;  // of the columns
    double frameX_ = 0.;               // left end of the first column's frames
};

namespace {

/// Draws into memory, where the size becomes known, and again on a surface of that size: cairo
/// writes wrong SVG from drawings of unknown size.
/// @param create gives the surface of a width and a height
/// @param svgTexts as of the Painter
template <typename Create>
Surface drawn(const Figure& figure, const Create& create, std::string* svgTexts = nullptr) {
    const Surface record(cairo_recording_surface_create(CAIRO_CONTENT_COLOR_ALPHA, nullptr),
                         &cairo_surface_destroy);
    Painter recorder(record.get());
    const Eigen::Vector2d size = FigureLayout(figure, recorder).draw().array().ceil();
    Surface surface(create(size.x(), size.y()), &cairo_surface_destroy);
    Painter painter(surface.get(), svgTexts);
    painter.box({0., 0., size.x(), size.y()}, kWhite);
    FigureLayout(figure, painter).draw();
    painter.check();
    return surface;
}

cairo_surface_t* imageSurface(double width, double height) {
    return cairo_image_surface_create(CAIRO_FORMAT_RGB24, static_cast<int>(width),
                                      static_cast<int>(height));
}

}  // namespace

std::string Figure::png() const {
    std::string bytes;
    const Surface surface = drawn(*this, imageSurface);
    cairo_surface_write_to_png_stream(surface.get(), &appendTo, &bytes);
    return bytes;
}

std::string Figure::svg() const {
    std::string bytes, texts;  // cairo would write texts as outlines
    drawn(
        *this,
        [&](double width, double height) {
            return cairo_svg_surface_create_for_stream(&appendTo, &bytes, width, height);
        },
        &texts);
    return bytes.insert(bytes.rfind("</svg>"), texts);
}

std::string Figure::pdf() const {
    std::string bytes;
    drawn(*this, [&](double width, double height) {
        return cairo_pdf_surface_create_for_stream(&appendTo, &bytes, width, height);
    });
    return bytes;
}

Picture Figure::picture() const {
    const Surface surface = drawn(*this, imageSurface);
    cairo_surface_flush(surface.get());
    const unsigned char* bytes = cairo_image_surface_get_data(surface.get());
    const int stride = cairo_image_surface_get_stride(surface.get());
    const int height = cairo_image_surface_get_height(surface.get());
    Picture picture{{}, cairo_image_surface_get_width(surface.get())};
    picture.pixels.reserve(static_cast<std::size_t>(height) * picture.columns);
    for (int v = 0; v < height; ++v) {
        for (int u = 0; u < picture.columns; ++u) {
            std::uint32_t pixel = 0;  // 0x00RRGGBB
            std::memcpy(&pixel, bytes + static_cast<std::ptrdiff_t>(v) * stride + 4 * u, 4);
            picture.pixels.push_back({static_cast<std::uint8_t>(pixel >> 16U),
                                      static_cast<std::uint8_t>(pixel >> 8U),
                                      static_cast<std::uint8_t>(pixel)});
        }
    }
    return picture;
}

void Figure::save(const std::filesystem::path& file) const {
    const std::string type = file.extension().string();
    if (type != ".png" && type != ".svg" && type != ".pdf")
        throw InputError(file.string(), "", "figures are .png, .svg or .pdf");
    writeFileAtomically(file, type == ".png" ? png() : type == ".svg" ? svg() : pdf());
}

}  // namespace photonav
