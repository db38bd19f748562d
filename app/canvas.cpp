// SPDX-License-Identifier: BSD-3-Clause
#include "canvas.hpp"

#include <algorithm>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

namespace photonav {
namespace {

constexpr int kFont = cv::FONT_HERSHEY_SIMPLEX;
constexpr int kShift = 4;         // fractional bits of OpenCV's fixed-point coordinates
constexpr double kScale = 3.0;    // enlargement while drawing
constexpr double kRaised = 0.72;  // size of a superscript

cv::Scalar bgr(const Color& color) {
    return {1.0 * color.blue, 1.0 * color.green, 1.0 * color.red};
}

int stroke(double width) { return std::max(1, cvRound(width * kScale)); }
double fontScale(double size) { return size * kScale / 30.0; }
int thickness(double size) { return cvRound(size * kScale / 13.0); }

double pieceWidth(const std::string& piece, double size) {
    int baseline = 0;
    return cv::getTextSize(piece, kFont, fontScale(size), thickness(size), &baseline).width /
           kScale;
}

/// visit(piece, raised) for the stretches of normal and superscript text.
template <typename Visitor>
void forPieces(const std::string& content, const Visitor& visit) {
    for (std::size_t begin = 0; begin < content.size();) {
        const bool raised = content[begin] == '^';
        if (raised) ++begin;
        const std::size_t end = std::min(
            raised ? content.find_first_not_of("-0123456789", begin) : content.find('^', begin),
            content.size());
        visit(content.substr(begin, end - begin), raised);
        begin = end;
    }
}

}  // namespace

struct Canvas::Image {
    cv::Mat3b sheet;   // everything
    cv::Mat3b window;  // the part that may be drawn on

    /// Enlarged fixed-point coordinates in the window.
    cv::Point fixed(const Point& p) const {
        cv::Size whole;
        cv::Point corner;
        window.locateROI(whole, corner);
        constexpr double limit = 1e7;  // far outside, but not beyond int
        const auto coordinate = [&](double value, int origin) {
            return cvRound(std::clamp((value * kScale - origin) * (1 << kShift), -limit, limit));
        };
        return {coordinate(p.x(), corner.x), coordinate(p.y(), corner.y)};
    }
};

Canvas::Canvas(double width, double height) : image_(std::make_unique<Image>()) {
    image_->sheet.create(cvRound(height * kScale), cvRound(width * kScale));
    image_->sheet.setTo(cv::Scalar::all(255));
    image_->window = image_->sheet;
}

Canvas::~Canvas() = default;

void Canvas::line(const Point& a, const Point& b, const Color& color, double width) {
    cv::line(image_->window, image_->fixed(a), image_->fixed(b), bgr(color), stroke(width),
             cv::LINE_AA, kShift);
}

void Canvas::polyline(const std::vector<Point>& points, const Color& color, double width) {
    for (std::size_t i = 1; i < points.size(); ++i) line(points[i - 1], points[i], color, width);
}

void Canvas::fill(const std::vector<Point>& convexPolygon, const Color& color) {
    std::vector<cv::Point> corners;
    corners.reserve(convexPolygon.size());
    for (const Point& point : convexPolygon) corners.push_back(image_->fixed(point));
    cv::fillConvexPoly(image_->window, corners, bgr(color), cv::LINE_AA, kShift);
}

void Canvas::disc(const Point& center, double radius, const Color& color) {
    cv::circle(image_->window, image_->fixed(center), cvRound(radius * kScale * (1 << kShift)),
               bgr(color), cv::FILLED, cv::LINE_AA, kShift);
}

void Canvas::translucent(double opacity, const std::function<void()>& drawing) {
    const cv::Mat3b before = image_->sheet.clone();
    drawing();
    cv::addWeighted(image_->sheet, opacity, before, 1.0 - opacity, 0.0, image_->sheet);
}

void Canvas::picture(const std::vector<Color>& pixels, int columns, const Frame& frame,
                     bool smooth) {
    cv::Mat3b source(static_cast<int>(pixels.size()) / columns, columns);
    std::transform(pixels.begin(), pixels.end(), source.begin(), [](const Color& color) {
        return cv::Vec3b(color.blue, color.green, color.red);
    });
    const cv::Point corner(cvRound(frame.x * kScale), cvRound(frame.y * kScale));
    const cv::Point end(cvRound(frame.right() * kScale), cvRound(frame.bottom() * kScale));
    cv::Mat3b target = image_->sheet(cv::Rect(corner, end));
    const bool shrinks = source.cols > target.cols || source.rows > target.rows;
    cv::resize(source, target, target.size(), 0, 0,
               !smooth   ? cv::INTER_NEAREST
               : shrinks ? cv::INTER_AREA
                         : cv::INTER_LINEAR);
}

std::shared_ptr<void> Canvas::clip(const Frame& frame) {
    const cv::Rect room(cvRound(frame.x * kScale), cvRound(frame.y * kScale),
                        cvRound(frame.width * kScale), cvRound(frame.height * kScale));
    image_->window = image_->sheet(room);
    return {nullptr, [this](void*) { image_->window = image_->sheet; }};
}

void Canvas::text(const std::string& content, Point at, Align align, const Color& color,
                  double size) {
    if (align != Align::left)
        at.x() -= textWidth(content, size) * (align == Align::right ? 1.0 : 0.5);
    forPieces(content, [&](const std::string& piece, bool raised) {
        const double actual = raised ? kRaised * size : size;
        const cv::Point base(cvRound(at.x() * kScale),
                             cvRound((at.y() - (raised ? 0.42 * size : 0.0)) * kScale));
        cv::putText(image_->sheet, piece, base, kFont, fontScale(actual), bgr(color),
                    thickness(actual), cv::LINE_AA);
        at.x() += pieceWidth(piece, actual);
    });
}

void Canvas::verticalText(const std::string& content, const Point& at, const Color& color) {
    if (content.empty()) return;
    Canvas strip(textWidth(content) + 4.0, 2.0 * kTextSize);
    strip.text(content, {2.0, 1.45 * kTextSize}, Align::left, color);
    cv::Mat3b turned;
    cv::rotate(strip.image_->sheet, turned, cv::ROTATE_90_COUNTERCLOCKWISE);
    const cv::Point corner(cvRound(at.x() * kScale) - turned.cols / 2,
                           cvRound(at.y() * kScale) - turned.rows / 2);
    const cv::Rect room = cv::Rect(corner, turned.size()) & cv::Rect({0, 0}, image_->sheet.size());
    if (!room.empty()) turned(room - corner).copyTo(image_->sheet(room));
}

double Canvas::textWidth(const std::string& content, double size) {
    double width = 0.0;
    forPieces(content, [&](const std::string& piece, bool raised) {
        width += pieceWidth(piece, raised ? kRaised * size : size);
    });
    return width;
}

Png Canvas::png() const {
    cv::Mat3b reduced;
    cv::resize(image_->sheet, reduced, {}, 1.0 / kScale, 1.0 / kScale, cv::INTER_AREA);
    std::vector<unsigned char> bytes;
    cv::imencode(".png", reduced, bytes);
    return {bytes.begin(), bytes.end()};
}

std::array<Color, 256> viridis() {
    cv::Mat1b levels(1, 256);
    for (int i = 0; i < 256; ++i) levels(0, i) = static_cast<unsigned char>(i);
    cv::Mat3b colors;
    cv::applyColorMap(levels, colors, cv::COLORMAP_VIRIDIS);
    std::array<Color, 256> map{};
    for (int i = 0; i < 256; ++i)
        map[static_cast<std::size_t>(i)] = {colors(0, i)[2], colors(0, i)[1], colors(0, i)[0]};
    return map;
}

}  // namespace photonav
