// SPDX-License-Identifier: BSD-3-Clause
// Just enough of a plot for the tutorials: axes, a picture behind them, dots, curves and a legend.
#pragma once

#include <Eigen/Dense>
#include <cmath>
#include <cstdio>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <string>
#include <vector>

class Plot {
  public:
    using Points = std::vector<Eigen::Vector2d>;

    /// Equal axes in metres.
    /// @param pixelsPerMetre of the saved picture; it is drawn three times finer and shrunk
    Plot(const Eigen::AlignedBox2d& area, double pixelsPerMetre)
        : Plot(area, Eigen::Vector2d::Constant(pixelsPerMetre), "x [m]", "y [m]") {}

    Plot(const Eigen::AlignedBox2d& area, const Eigen::Vector2d& pixelsPerUnit,
         const std::string& xName, const std::string& yName)
        : area_(area),
          scale_(kFine * pixelsPerUnit),
          image_(static_cast<int>(area.sizes().y() * scale_.y()) + 2 * kMargin,
                 static_cast<int>(area.sizes().x() * scale_.x()) + 2 * kMargin, CV_8UC3,
                 cv::Scalar::all(255)) {
        drawAxes(xName, yName);
    }

    /// A grey picture of the whole area, behind everything drawn later.
    /// @param grey values in [0, 1], row by row from the top
    void picture(const float* grey, int rows, int columns) {
        cv::Mat bytes;
        cv::Mat(rows, columns, CV_32F, const_cast<float*>(grey)).convertTo(bytes, CV_8U, 255.);
        const cv::Rect inside(pixel({area_.min().x(), area_.max().y()}),
                              pixel({area_.max().x(), area_.min().y()}));
        cv::resize(bytes, bytes, inside.size(), 0., 0., cv::INTER_AREA);
        cv::cvtColor(bytes, image_(inside), cv::COLOR_GRAY2BGR);
    }

    /// @param radius [pixels]
    void dots(const Points& points, const cv::Scalar& rgb, double opacity, int radius = 2) {
        cv::Mat layer = image_.clone();
        for (const auto& p : points) {
            cv::circle(layer, pixel(p), radius * kFine, bgr(rgb), -1, cv::LINE_AA);
        }
        cv::addWeighted(layer, opacity, image_, 1. - opacity, 0., image_);
    }

    void curve(const Points& points, const cv::Scalar& rgb, int width, bool dashed = false) {
        for (std::size_t i = 1; i < points.size(); ++i) {
            if (dashed && i % 8 >= 4) continue;
            cv::line(image_, pixel(points[i - 1]), pixel(points[i]), bgr(rgb), width * kFine,
                     cv::LINE_AA);
        }
    }

    /// A line of the legend, at the top.
    /// @param left of it, from the left end of the x axis [pixels]
    void label(const std::string& text, const cv::Scalar& rgb, int left = 30) {
        const cv::Point at(kMargin + left * kFine, kMargin + (24 + 24 * labels_++) * kFine);
        cv::line(image_, at, at + cv::Point(24 * kFine, 0), bgr(rgb), 4 * kFine, cv::LINE_AA);
        write(text, at + cv::Point(34 * kFine, 5 * kFine));
    }

    void save(const std::string& file) const {
        cv::Mat small;
        cv::resize(image_, small, {}, 1. / kFine, 1. / kFine, cv::INTER_AREA);
        if (!cv::imwrite(file, small)) throw std::runtime_error("cannot write " + file);
    }

  private:
    static constexpr int kFine = 3;
    static constexpr int kMargin = 45 * kFine;

    static cv::Scalar bgr(const cv::Scalar& rgb) { return {rgb[2], rgb[1], rgb[0]}; }

    cv::Point pixel(const Eigen::Vector2d& p) const {
        const Eigen::Vector2d fromCorner = (p - area_.min()).cwiseProduct(scale_);
        return {kMargin + static_cast<int>(fromCorner.x()),
                image_.rows - kMargin - static_cast<int>(fromCorner.y())};
    }

    void write(const std::string& text, const cv::Point& at) {
        cv::putText(image_, text, at, cv::FONT_HERSHEY_SIMPLEX, 0.5 * kFine, {60, 60, 60}, kFine,
                    cv::LINE_AA);
    }

    /// Distance of grid lines: 1, 2, 5 ... units, whichever is wide enough for its number.
    int tick(int axis) const {
        for (const int step : {1, 2, 5, 10, 20, 50}) {
            if (step * scale_[axis] >= 60 * kFine) return step;
        }
        return 100;
    }

    void drawAxes(const std::string& xName, const std::string& yName) {
        const Eigen::Vector2d low = area_.min();
        const Eigen::Vector2d high = area_.max();
        const auto first = [](double from, int step) {
            return static_cast<int>(std::ceil(from / step)) * step;
        };
        for (int x = first(low.x(), tick(0)); x <= high.x(); x += tick(0)) {
            const cv::Point foot = pixel({x, low.y()});
            cv::line(image_, foot, pixel({x, high.y()}), cv::Scalar::all(230), kFine);
            write(std::to_string(x), foot + cv::Point(-5 * kFine, 20 * kFine));
        }
        for (int y = first(low.y(), tick(1)); y <= high.y(); y += tick(1)) {
            const cv::Point foot = pixel({low.x(), y});
            cv::line(image_, foot, pixel({high.x(), y}), cv::Scalar::all(230), kFine);
            write(std::to_string(y), foot + cv::Point(-28 * kFine, 5 * kFine));
        }
        const int width =
            cv::getTextSize(xName, cv::FONT_HERSHEY_SIMPLEX, 0.5 * kFine, kFine, nullptr).width;
        write(xName, pixel({high.x(), low.y()}) + cv::Point(kFine * 15 - width, 38 * kFine));
        write(yName, pixel({low.x(), high.y()}) + cv::Point(-30 * kFine, -14 * kFine));
    }

    Eigen::AlignedBox2d area_;
    Eigen::Vector2d scale_;  // drawn pixels per unit
    cv::Mat image_;
    int labels_ = 0;
};
