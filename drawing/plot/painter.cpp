// SPDX-License-Identifier: BSD-3-Clause
#include "plot/painter.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>
#include <stdexcept>

namespace photonav {
namespace {

/// The pixels on a surface of their own.
Surface surfaceOf(const Picture& picture) {
    Surface image(cairo_image_surface_create(CAIRO_FORMAT_RGB24, picture.columns, picture.rows()),
                  &cairo_surface_destroy);
    unsigned char* bytes = cairo_image_surface_get_data(image.get());
    const int stride = cairo_image_surface_get_stride(image.get());
    for (int row = 0; row < picture.rows(); ++row) {
        const Color* colors = picture.pixels.data() + std::ptrdiff_t{row} * picture.columns;
        std::transform(colors, colors + picture.columns,
                       reinterpret_cast<std::uint32_t*>(bytes + std::ptrdiff_t{row} * stride),
                       [](const Color& c) {
                           return std::uint32_t{c.red} << 16 | std::uint32_t{c.green} << 8 | c.blue;
                       });
    }
    cairo_surface_mark_dirty(image.get());
    return image;
}

/// The picture with every pixel as `factor` x `factor` pixels.
Surface magnified(const Surface& image, int factor, cairo_filter_t filter) {
    const int columns = factor * cairo_image_surface_get_width(image.get());
    const int rows = factor * cairo_image_surface_get_height(image.get());
    Surface large(cairo_image_surface_create(CAIRO_FORMAT_RGB24, columns, rows),
                  &cairo_surface_destroy);
    const std::unique_ptr<cairo_t, decltype(&cairo_destroy)> cairo(cairo_create(large.get()),
                                                                   &cairo_destroy);
    cairo_scale(cairo.get(), factor, factor);
    cairo_set_source_surface(cairo.get(), image.get(), 0., 0.);
    cairo_pattern_set_filter(cairo_get_source(cairo.get()), filter);
    cairo_pattern_set_extend(cairo_get_source(cairo.get()), CAIRO_EXTEND_PAD);
    cairo_paint(cairo.get());
    return large;
}

/// The text, with bytes that are not UTF-8 replaced: after those cairo draws nothing more. Names of
/// files may have them.
std::string utf8(const std::string& text) {
    using nlohmann::json;
    return json::parse(json(text).dump(-1, ' ', false, json::error_handler_t::replace));
}

/// Text of SVG. Control characters are not allowed there.
std::string escapedForSvg(const std::string& text) {
    std::string escaped;
    for (const char c : text) {
        if (c == '&')
            escaped += "&amp;";
        else if (c == '<')
            escaped += "&lt;";
        else
            escaped += static_cast<unsigned char>(c) < ' ' ? ' ' : c;
    }
    return escaped;
}

double bounded(double coordinate) { return std::clamp(coordinate, -1e5, 1e5); }  // cairo's are 24.8

}  // namespace

cairo_status_t appendTo(void* text, const unsigned char* bytes, unsigned count) {
    static_cast<std::string*>(text)->append(reinterpret_cast<const char*>(bytes), count);
    return CAIRO_STATUS_SUCCESS;
}

Png pngOf(const Picture& picture) {
    Png bytes;
    cairo_surface_write_to_png_stream(surfaceOf(picture).get(), &appendTo, &bytes);
    return bytes;
}

Painter::Painter(cairo_surface_t* surface, std::string* svgTexts)
    : cairo_(cairo_create(surface), &cairo_destroy), svgTexts_(svgTexts) {
    // Texts have the same width on all surfaces.
    const std::unique_ptr<cairo_font_options_t, decltype(&cairo_font_options_destroy)> options(
        cairo_font_options_create(), &cairo_font_options_destroy);
    cairo_font_options_set_hint_metrics(options.get(), CAIRO_HINT_METRICS_OFF);
    cairo_set_font_options(cairo_.get(), options.get());
}

void Painter::check() const {
    const cairo_status_t status = cairo_status(cairo_.get());
    if (status == CAIRO_STATUS_NO_MEMORY) throw std::bad_alloc();
    if (status != CAIRO_STATUS_SUCCESS)
        throw std::runtime_error(std::string("figure: ") + cairo_status_to_string(status));
}

void Painter::setColor(const Color& color) {
    cairo_set_source_rgb(cairo_.get(), color.red / 255., color.green / 255., color.blue / 255.);
}

void Painter::line(const std::vector<Point>& points, const Color& color, double width,
                   bool dashed) {
    cairo_t* cairo = cairo_.get();
    bool isOpen = false;
    for (const Point& p : points) {
        if (!p.allFinite()) {
            isOpen = false;
            continue;
        }
        (isOpen ? cairo_line_to : cairo_move_to)(cairo, bounded(p.x()), bounded(p.y()));
        isOpen = true;
    }
    setColor(color);
    cairo_set_line_width(cairo, width);
    cairo_set_line_join(cairo, CAIRO_LINE_JOIN_ROUND);
    constexpr double kDashes[]{8., 6.};
    cairo_set_dash(cairo, kDashes, dashed ? 2 : 0, 0.);
    cairo_stroke(cairo);
}

void Painter::fill(const std::vector<Point>& outline, const Color& color) {
    for (const Point& p : outline)
        if (p.allFinite()) cairo_line_to(cairo_.get(), bounded(p.x()), bounded(p.y()));
    setColor(color);
    cairo_fill(cairo_.get());
}

void Painter::disc(const Point& center, double diameter, const Color& color) {
    if (!center.allFinite()) return;
    cairo_arc(cairo_.get(), bounded(center.x()), bounded(center.y()), 0.5 * diameter, 0.,
              2. * std::numbers::pi);
    setColor(color);
    cairo_fill(cairo_.get());
}

void Painter::box(const Frame& frame, const Color& color) {
    cairo_rectangle(cairo_.get(), frame.x, frame.y, frame.width, frame.height);
    setColor(color);
    cairo_fill(cairo_.get());
}

void Painter::outline(const Frame& frame, const Color& color, double width) {
    cairo_rectangle(cairo_.get(), frame.x, frame.y, frame.width, frame.height);
    setColor(color);
    cairo_set_line_width(cairo_.get(), width);
    cairo_set_dash(cairo_.get(), nullptr, 0, 0.);
    cairo_stroke(cairo_.get());
}

void Painter::hatching(const Frame& frame, const Color& color, double width) {
    clipped(frame, [&] {
        constexpr double kStep = 9.;
        std::vector<Point> lines;
        for (double k = std::floor((frame.x + frame.y) / kStep);
             k * kStep < frame.right() + frame.bottom(); ++k) {
            lines.emplace_back(k * kStep - frame.y, frame.y);
            lines.emplace_back(k * kStep - frame.bottom(), frame.bottom());
            lines.emplace_back(Point::Constant(std::nan("")));
        }
        line(lines, color, width);
    });
}

void Painter::picture(const Picture& picture, const Frame& frame, bool smooth) {
    if (picture.pixels.empty() || !(frame.width > 0. && frame.height > 0.)) return;
    cairo_t* cairo = cairo_.get();
    const cairo_filter_t filter = smooth ? CAIRO_FILTER_GOOD : CAIRO_FILTER_NEAREST;
    // Magnified here, because some viewers of SVG and PDF interpolate pixels and others do not.
    const double scale = std::min(frame.width / picture.columns, frame.height / picture.rows());
    const int factor = static_cast<int>(std::lround(scale));
    Surface image = surfaceOf(picture);
    if (factor > 1) image = magnified(image, factor, filter);
    cairo_save(cairo);
    cairo_rectangle(cairo, frame.x, frame.y, frame.width, frame.height);
    cairo_translate(cairo, frame.x, frame.y);
    cairo_scale(cairo, frame.width / cairo_image_surface_get_width(image.get()),
                frame.height / cairo_image_surface_get_height(image.get()));
    cairo_set_source_surface(cairo, image.get(), 0., 0.);
    cairo_pattern_set_filter(cairo_get_source(cairo), filter);
    cairo_pattern_set_extend(cairo_get_source(cairo), CAIRO_EXTEND_PAD);
    cairo_fill(cairo);
    cairo_restore(cairo);
}

void Painter::setFont(double size) {
    cairo_select_font_face(cairo_.get(), "DejaVu Sans", CAIRO_FONT_SLANT_NORMAL,
                           CAIRO_FONT_WEIGHT_NORMAL);
    cairo_set_font_size(cairo_.get(), size);
}

double Painter::textWidth(const std::string& content, double size) {
    setFont(size);
    cairo_text_extents_t extents;
    cairo_text_extents(cairo_.get(), utf8(content).c_str(), &extents);
    return extents.x_advance;
}

void Painter::text(const std::string& content, const Point& at, Align align, const Font& font) {
    if (content.empty() || !at.allFinite()) return;
    if (svgTexts_ != nullptr) {
        constexpr const char* kAnchors[]{"start", "middle", "end"};
        *svgTexts_ += fmt::format(
            R"(<text font-family="DejaVu Sans, Verdana, sans-serif" font-size="{}" fill="{}" )"
            R"(text-anchor="{}" transform="translate({:.6g} {:.6g}){}">{}</text>)"
            "\n",
            font.size, hexColor(font.color), kAnchors[static_cast<int>(align)], at.x(), at.y(),
            font.upward ? " rotate(-90)" : "", escapedForSvg(utf8(content)));
        return;
    }
    const double share = align == Align::left ? 0. : align == Align::center ? 0.5 : 1.;
    cairo_t* cairo = cairo_.get();
    cairo_save(cairo);
    cairo_translate(cairo, at.x(), at.y());
    if (font.upward) cairo_rotate(cairo, -0.5 * std::numbers::pi);
    cairo_move_to(cairo, -share * textWidth(content, font.size), 0.);
    setColor(font.color);
    cairo_show_text(cairo, utf8(content).c_str());
    cairo_new_path(cairo);
    cairo_restore(cairo);
}

void Painter::translucent(double opacity, const std::function<void()>& draw) {
    if (opacity >= 1.) return draw();
    cairo_push_group(cairo_.get());
    draw();
    cairo_pop_group_to_source(cairo_.get());
    cairo_paint_with_alpha(cairo_.get(), opacity);
}

void Painter::clipped(const Frame& frame, const std::function<void()>& draw) {
    cairo_save(cairo_.get());
    cairo_rectangle(cairo_.get(), frame.x, frame.y, frame.width, frame.height);
    cairo_clip(cairo_.get());
    draw();
    cairo_restore(cairo_.get());
}

}  // namespace photonav
