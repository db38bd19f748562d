// SPDX-License-Identifier: BSD-3-Clause
#include "figures.hpp"

#include <gtest/gtest.h>

#include <cstdlib>
#include <limits>
#include <opencv2/imgcodecs.hpp>
#include <stdexcept>

#include "atomic_file.hpp"
#include "plot.hpp"
#include "sample_report.hpp"

namespace photonav {
namespace {

/// Decodes; PHOTONAV_KEEP names a folder in which the pictures are kept to be looked at.
cv::Mat3b decoded(const Png& png, const std::string& name) {
    if (const char* folder = std::getenv("PHOTONAV_KEEP"))
        writeFileAtomically(std::filesystem::path(folder) / (name + ".png"), png);
    return cv::imdecode(std::vector<char>(png.begin(), png.end()), cv::IMREAD_COLOR);
}

int countOf(const cv::Mat3b& image, const Color& color) {
    return static_cast<int>(
        std::count(image.begin(), image.end(), cv::Vec3b(color.blue, color.green, color.red)));
}

TopView sampleTopView() {
    const ReportData run = sampleReport();
    return {.title = "Two textures: belief_rrt_star, alpha 0.25",
            .area = {Eigen::Vector2d(-1, -0.5), Eigen::Vector2d(9, 9.5)},
            .background = sampleFloor(480),
            .trees = run.trees,
            .paths = run.paths,
            .start = run.start,
            .goal = run.goal};
}

TEST(Figures, TopViewShowsPathsTreeAndEllipses) {
    TopView view = sampleTopView();
    const cv::Mat3b image = decoded(drawTopView(view), "top_view");
    EXPECT_GT(image.cols, 900);
    EXPECT_GT(image.rows, 900);
    EXPECT_GT(countOf(image, kPathColor), 1000);
    EXPECT_GT(countOf(image, kBaselineColor), 500);

    view.ellipseScale = 0.0;
    view.trees.clear();
    const cv::Mat3b bare = decoded(drawTopView(view), "top_view_bare");
    EXPECT_LT(countOf(bare, kPathColor), countOf(image, kPathColor));
}

TEST(Figures, PathIsDrawnWhereItIs) {
    TopView view;
    view.area = {Eigen::Vector2d(0, 0), Eigen::Vector2d(10, 10)};
    view.start = view.goal = {-50, -50, 0};
    view.ellipseScale = 0.0;
    view.paths = {samplePath("path", kPathColor, {{2, 0, 1}, {2, 5, 1}})};
    const cv::Mat3b image = decoded(drawTopView(view), "vertical");
    // The frame is 820 px for 10 m from (96, 58): x = 2 m is column 260, y in [0, 5] is below 468.
    const auto isPath = [&](int row, int column) {
        return image(row, column) == cv::Vec3b(kPathColor.blue, kPathColor.green, kPathColor.red);
    };
    EXPECT_TRUE(isPath(600, 260));
    EXPECT_FALSE(isPath(400, 260));
    EXPECT_FALSE(isPath(600, 280));
}

TEST(Figures, NoPathHidesAnother) {
    TopView view;
    view.area = {Eigen::Vector2d(0, 0), Eigen::Vector2d(10, 10)};
    view.start = view.goal = {-50, -50, 0};
    view.ellipseScale = 0.0;
    view.paths = {samplePath("above", kPathColor, {{2, 0, 1}, {2, 5, 1}}),
                  samplePath("below", kBaselineColor, {{2, 0, 1}, {2, 1, 1}, {2, 5, 1}}),
                  samplePath("aside", kTreeColor, {{4, 0, 1}, {4, 5, 1}})};
    const cv::Mat3b image = decoded(drawTopView(view), "paths");
    const auto widthOf = [&](const Color& color) {  // on a row that all cross, left of the legend
        return countOf(image(cv::Rect(100, 600, 800, 1)), color);
    };
    EXPECT_GE(widthOf(kPathColor), 3);
    EXPECT_GE(widthOf(kBaselineColor), 2);  // on both sides
    EXPECT_EQ(widthOf(kTreeColor), widthOf(kPathColor));
}

TEST(Figures, EmptyAreaIsRefused) {
    EXPECT_THROW(drawTopView({}), std::invalid_argument);
    EXPECT_THROW(drawMaps({}), std::invalid_argument);
    EXPECT_THROW(drawMaps({{TopView{}}}), std::invalid_argument);
    EXPECT_THROW(drawHeatMap({}), std::invalid_argument);
}

TEST(Figures, TraceHasBothCurves) {
    const ReportData run = sampleReport();
    for (const bool logScale : {false, true}) {
        const cv::Mat3b image =
            decoded(drawTrace("Uncertainty along the path", run.paths, logScale),
                    logScale ? "trace_log" : "trace");
        EXPECT_GT(countOf(image, kPathColor), 500);
        EXPECT_GT(countOf(image, kBaselineColor), 500);
    }
}

TEST(Figures, TraceOfZeroOnALogarithmicAxisIsDrawn) {
    DrawnPath path{"exact", kPathColor, std::vector<PathPoint>(3)};
    path.points[1].distance = 1.0;
    path.points[2] = {.trace = std::numeric_limits<double>::quiet_NaN(), .distance = 2.0};
    EXPECT_FALSE(decoded(drawTrace("zero", {path}, true), "zero").empty());
    EXPECT_FALSE(decoded(drawTrace("nothing", {}, false), "nothing").empty());
}

TEST(Figures, HeatMapColorsAndHatching) {
    HeatMap map{.title = "Information at 2 m", .label = "tr(covariance) [m^2]"};
    map.area = {Eigen::Vector2d(0, 0), Eigen::Vector2d(8, 6)};
    map.values.resize(80, 60);
    for (int i = 0; i < 80; ++i)
        for (int j = 0; j < 60; ++j) map.values(i, j) = std::pow(10.0, -4.0 + i * 0.05 + 0.01 * j);
    map.values.block(20, 20, 15, 10) = std::numeric_limits<double>::quiet_NaN();
    map.logScale = true;
    const cv::Mat3b image = decoded(drawHeatMap(map), "heat_map");
    const auto brightness = [&](int row, int column) {
        return cv::sum(cv::Mat(image(row, column)))[0];
    };
    const int left = 100, right = 96 + 755, middle = 58 + 285;
    EXPECT_GT(brightness(middle, right), brightness(middle, left) + 100);
    EXPECT_GT(countOf(image, Color{240, 241, 243}), 500);

    map.values.setConstant(0.0);
    EXPECT_FALSE(decoded(drawHeatMap(map), "heat_map_zero").empty());
}

TEST(Figures, ContributionIsBrightWhereItIsLarge) {
    const ImageF grey(20, 30, 0.5F);
    ImageF contribution(20, 30, 0.F);
    for (unsigned u = 10; u < 20; ++u) contribution[5][u] = 1.F;
    const cv::Mat3b image = decoded(contributionPng(grey, contribution), "contribution");
    EXPECT_EQ(image.size(), cv::Size(30, 20));
    EXPECT_GT(image(5, 15)[2], image(15, 15)[2] + 50);
    EXPECT_THROW(contributionPng(grey, ImageF(5, 5, 0.F)), std::invalid_argument);
}

TEST(Figures, GreyPictureKeepsValuesAndIsReduced) {
    const cv::Mat3b image = decoded(greyPng(ImageF(40, 100, 0.4F), 50), "grey");
    EXPECT_EQ(image.size(), cv::Size(50, 20));
    EXPECT_EQ(image(10, 10)[0], 102);
    EXPECT_THROW(greyPng(ImageF()), std::invalid_argument);
}

TEST(Figures, PositionCovarianceIsInTheWorld) {
    UncertainPose belief;  // camera looks along the world's x
    Pose T_w_c = Pose::Identity();
    T_w_c.linear() << 0, 0, 1, -1, 0, 0, 0, -1, 0;
    T_w_c.translation() << 1, 2, 3;
    belief.mean = T_w_c.inverse();
    belief.covariance(2, 2) = 4.0;  // along the optical axis
    const PathPoint point = makePathPoint(belief, 4.0, 1.0, 2.0);
    EXPECT_TRUE(point.position.isApprox(Eigen::Vector3d(1, 2, 3)));
    EXPECT_TRUE(
        point.positionCovariance.isApprox(Eigen::Matrix3d(Eigen::Vector3d(4, 0, 0).asDiagonal())));
}

TEST(Plot, TicksAreRoundAndInside) {
    const auto labels = [](const Axis& axis, int wanted) {
        std::string text;
        for (const Tick& tick : ticksOf(axis, wanted)) text += tick.label + " ";
        return text;
    };
    EXPECT_EQ(labels({0.0, 10.0}, 5), "0 2 4 6 8 10 ");
    EXPECT_EQ(labels({-0.05, 0.17}, 4), "-0.05 0.00 0.05 0.10 0.15 ");
    EXPECT_EQ(labels({0.02, 3.0, true}, 5), "0.02 0.05 0.1 0.2 0.5 1 2 ");
    EXPECT_EQ(labels({1e-6, 1.0, true}, 5), "10^-6 10^-5 10^-4 10^-3 10^-2 10^-1 10^0 ");
    EXPECT_EQ(labels({3.1e-4, 4.2e-4, true}, 3), "3.5x10^-4 4x10^-4 ");
    EXPECT_EQ(labels({0.21, 0.42, true}, 4), "0.25 0.30 0.35 0.40 ");
}

}  // namespace
}  // namespace photonav
