// SPDX-License-Identifier: BSD-3-Clause
// Just enough of a plot for the tutorials: equal axes in metres, dots, curves and a legend.
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

    /// @param pixelsPerMetre of the saved picture; it is drawn three times finer and shrunk
    Plot(const Eigen::AlignedBox2d& area, double pixelsPerMetre)
        : area_(area),
          scale_(kFine * pixelsPerMetre),
          image_(static_cast<int>(area.sizes().y() * scale_) + 2 * kMargin,
                 static_cast<int>(area.sizes().x() * scale_) + 2 * kMargin, CV_8UC3,
                 cv::Scalar::all(255)) {
        drawAxes();
    }

    void dots(const Points& points, const cv::Scalar& rgb, double opacity) {
        cv::Mat layer = image_.clone();
        for (const auto& p : points) cv::circle(layer, pixel(p), 2 * kFine, bgr(rgb), -1);
        cv::addWeighted(layer, opacity, image_, 1. - opacity, 0., image_);
    }

    void curve(const Points& points, const cv::Scalar& rgb, int width, bool dashed = false) {
        for (std::size_t i = 1; i < points.size(); ++i) {
            if (dashed && i % 8 >= 4) continue;
            cv::line(image_, pixel(points[i - 1]), pixel(points[i]), bgr(rgb), width * kFine,
                     cv::LINE_AA);
        }
    }

    void label(const std::string& text, const cv::Scalar& rgb) {
        const cv::Point at(kMargin + 30 * kFine, kMargin + (24 + 24 * labels_++) * kFine);
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
        const Eigen::Vector2d fromCorner = (p - area_.min()) * scale_;
        return {kMargin + static_cast<int>(fromCorner.x()),
                image_.rows - kMargin - static_cast<int>(fromCorner.y())};
    }

    void write(const std::string& text, const cv::Point& at) {
        cv::putText(image_, text, at, cv::FONT_HERSHEY_SIMPLEX, 0.5 * kFine, {60, 60, 60}, kFine,
                    cv::LINE_AA);
    }

    void drawAxes() {
        for (int x = static_cast<int>(std::ceil(area_.min().x() / 2) * 2); x <= area_.max().x();
             x += 2) {
            const cv::Point foot = pixel({x, area_.min().y()});
            cv::line(image_, foot, pixel({x, area_.max().y()}), cv::Scalar::all(230), kFine);
            write(std::to_string(x), foot + cv::Point(-5 * kFine, 20 * kFine));
        }
        for (int y = static_cast<int>(std::ceil(area_.min().y() / 2) * 2); y <= area_.max().y();
             y += 2) {
            const cv::Point foot = pixel({area_.min().x(), y});
            cv::line(image_, foot, pixel({area_.max().x(), y}), cv::Scalar::all(230), kFine);
            write(std::to_string(y), foot + cv::Point(-28 * kFine, 5 * kFine));
        }
        write("x [m]",
              pixel({area_.max().x(), area_.min().y()}) + cv::Point(-30 * kFine, 38 * kFine));
        write("y [m]",
              pixel({area_.min().x(), area_.max().y()}) + cv::Point(-30 * kFine, -14 * kFine));
    }

    Eigen::AlignedBox2d area_;
    double scale_;
    cv::Mat image_;
    int labels_ = 0;
};
