// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <stdexcept>

#include "drawing/figures/sample_run.hpp"
#include "drawing/plot/decoded.hpp"
#include "figures/heat_map.hpp"
#include "figures/images.hpp"
#include "figures/top_view.hpp"
#include "figures/trace.hpp"
#include "geometry/camera.hpp"
#include "geometry/se3.hpp"

namespace photonav {
namespace {

const Color kFirst = plannerColor("belief_rrt_star");
const Color kSecond = plannerColor("rrt_star");

TopView sampleTopView() {
    return {.title = "Two textures: belief_rrt_star, alpha 0.25",
            .area = {Eigen::Vector2d(-1, -0.5), Eigen::Vector2d(9, 9.5)},
            .background = sampleFloor(480),
            .trees = {sampleTree(2500)},
            .paths = samplePaths(),
            .start = {0, 0, 2},
            .goal = {2, 9, 2}};
}

/// Ten by ten metres without anything: 820 px wide.
TopView emptyView() {
    TopView view;
    view.area = {Eigen::Vector2d(0, 0), Eigen::Vector2d(10, 10)};
    view.start = view.goal = {-50, -50, 0};
    view.ellipseScale = 0.0;
    return view;
}

TEST(Figures, TopViewShowsPathsTreeAndEllipses) {
    TopView view = sampleTopView();
    const cv::Mat3b image = decoded(topViewFigure(view).png(), "top_view");
    EXPECT_GT(image.cols, 900);
    EXPECT_GT(image.rows, 900);
    EXPECT_GT(countOf(image, kFirst), 1000);
    EXPECT_GT(countOf(image, kSecond), 500);

    view.ellipseScale = 0.0;
    view.trees.clear();
    const cv::Mat3b bare = decoded(topViewFigure(view).png(), "top_view_bare");
    EXPECT_LT(countOf(bare, kFirst), countOf(image, kFirst));
}

TEST(Figures, PathIsDrawnWhereItIs) {
    TopView view = emptyView();
    view.paths = {samplePath("", kFirst, {{2, 0, 1}, {2, 5, 1}})};
    const cv::Rect first = boundsOf(decoded(topViewFigure(view).png(), "vertical"), kFirst);
    view.paths = {samplePath("", kFirst, {{4, 0, 1}, {4, 5, 1}})};
    const cv::Rect second = boundsOf(decoded(topViewFigure(view).png(), "vertical"), kFirst);
    EXPECT_NEAR(second.x - first.x, 2 * 82, 1);
    EXPECT_NEAR(first.height, 5 * 82, 2);
    EXPECT_EQ(first.y, second.y);
}

TEST(Figures, NoPathHidesAnother) {
    TopView view = emptyView();
    view.paths = {samplePath("above", kFirst, {{2, 0, 1}, {2, 5, 1}}),
                  samplePath("below", kSecond, {{2, 0, 1}, {2, 1, 1}, {2, 5, 1}}),
                  samplePath("aside", kTreeColor, {{4, 0, 1}, {4, 5, 1}})};
    const cv::Mat3b image = decoded(topViewFigure(view).png(), "paths");
    const auto widthOf = [&](const Color& color) {  // on a row that all cross, left of the legend
        return countOf(image(cv::Rect(60, 600, 800, 1)), color);
    };
    EXPECT_GE(widthOf(kFirst), 2);
    EXPECT_GE(widthOf(kSecond), 2);  // on both sides
    EXPECT_EQ(widthOf(kTreeColor), widthOf(kFirst));
}

/// A path along y whose camera looks along x, so many radians below the horizon.
DrawnPath pathLookingAside(double belowHorizon) {
    DrawnPath path = samplePath("", kFirst, {{4, 2, 1}, {4, 7, 1}});
    for (PathPoint& point : path.points)
        point.T_w_c = levelPose(point.position, 0.) * cameraMount(belowHorizon);
    return path;
}

/// The top view with wedges of cameras, and without.
std::array<cv::Mat3b, 2> withAndWithoutWedges(TopView view, const std::string& name) {
    const cv::Mat3b without = decoded(topViewFigure(view).png(), name + "_without_wedges");
    view.horizontalFov = 1.2;
    return {decoded(topViewFigure(view).png(), name), without};
}

TEST(Figures, WedgesShowWhereCamerasLook) {
    TopView view = emptyView();
    view.paths = {pathLookingAside(0.8)};
    const std::array images = withAndWithoutWedges(view, "headings");
    const cv::Mat3b &with = images[0], &without = images[1];
    const cv::Rect path = boundsOf(without, kFirst);
    const auto changesBeside = [&](int dx) {
        const cv::Rect strip(path.x + dx, path.y, 8, path.height);
        cv::Mat3b difference;
        cv::absdiff(with(strip), without(strip), difference);
        return cv::countNonZero(difference.reshape(1));
    };
    EXPECT_GT(changesBeside(14), 300);
    EXPECT_EQ(changesBeside(-20), 0);
}

TEST(Figures, CamerasThatLookDownHaveNoWedges) {
    TopView view = emptyView();
    view.paths = {pathLookingAside(0.5 * std::numbers::pi)};
    const auto [with, without] = withAndWithoutWedges(view, "down");
    EXPECT_EQ(cv::norm(with, without), 0.);
}

TEST(Figures, EmptyAreaIsRefused) {
    EXPECT_THROW(topViewFigure({}), std::invalid_argument);
    EXPECT_THROW(mapsFigure({}).png(), std::invalid_argument);
    EXPECT_THROW(mapsFigure({{TopView{}}}), std::invalid_argument);
    EXPECT_THROW(heatMapFigure({}), std::invalid_argument);
}

TEST(Figures, TraceHasBothCurves) {
    for (const bool logScale : {false, true}) {
        const cv::Mat3b image =
            decoded(traceFigure("Uncertainty along the path", samplePaths(), logScale).png(),
                    logScale ? "trace_log" : "trace");
        EXPECT_GT(countOf(image, kFirst), 100);
        EXPECT_GT(countOf(image, kSecond), 100);
    }
}

TEST(Figures, TraceOfZeroOnALogarithmicAxisIsDrawn) {
    DrawnPath path{"exact", kFirst, std::vector<PathPoint>(3)};
    path.points[1].distance = 1.0;
    path.points[2] = {.trace = std::numeric_limits<double>::quiet_NaN(), .distance = 2.0};
    EXPECT_FALSE(decoded(traceFigure("zero", {path}, true).png(), "zero").empty());
    EXPECT_FALSE(decoded(traceFigure("nothing", {}, false).png(), "nothing").empty());
}

TEST(Figures, HeatMapColorsAndHatching) {
    HeatMap map{.title = "Information at 2 m", .label = "tr(covariance) [m²]"};
    map.area = {Eigen::Vector2d(0, 0), Eigen::Vector2d(8, 6)};
    map.values.resize(80, 60);
    for (int i = 0; i < 80; ++i)
        for (int j = 0; j < 60; ++j) map.values(i, j) = std::pow(10.0, -4.0 + i * 0.05 + 0.01 * j);
    map.values.block(20, 20, 15, 10) = std::numeric_limits<double>::quiet_NaN();
    map.logScale = true;
    const cv::Mat3b image = decoded(heatMapFigure(map).png(), "heat_map");
    const int left = boundsOf(image, {240, 241, 243}).x;  // of the legend and of the frame
    const auto brightness = [&](int row, int column) {
        return cv::sum(cv::Mat(image(row, column)))[0];
    };
    EXPECT_GT(brightness(300, left + 750), brightness(300, left + 4) + 100);
    EXPECT_GT(countOf(image, Color{240, 241, 243}), 500);

    map.values.setConstant(0.0);
    EXPECT_GT(countOf(decoded(heatMapFigure(map).png(), "heat_map_zero"), {58, 58, 62}), 1000);
}

TEST(Figures, ContributionIsBrightWhereItIsLarge) {
    const ImageF grey(20, 30, 0.5F);
    ImageF contribution(20, 30, 0.F);
    for (unsigned u = 10; u < 20; ++u) contribution[5][u] = 1.F;
    const cv::Mat3b image = decoded(pngOf(contributionPicture(grey, contribution)), "contribution");
    EXPECT_EQ(image.size(), cv::Size(30, 20));
    EXPECT_GT(image(5, 15)[2], image(15, 15)[2] + 50);
    EXPECT_THROW(contributionPicture(grey, ImageF(5, 5, 0.F)), std::invalid_argument);
}

TEST(Figures, PixelsAreWholeSquaresBesideTheirScale) {
    ImageF one(20, 30, 0.5F);
    one[5][15] = 1.F;
    const cv::Mat3b grey = decoded(greyFigure("", one).png(), "grey");
    EXPECT_GT(grey.cols, 30 * 26);
    EXPECT_GT(countOf(grey, greyColor(0.5)), 500 * 26 * 26);
    ImageF weights(20, 30, 0.F);
    for (unsigned u = 10; u < 20; ++u) weights[5][u] = 1.F;
    const cv::Mat3b weighted = decoded(contributionFigure("", one, weights).png(), "weighted");
    const int bright = countOf(weighted, inferno(1.));
    EXPECT_GT(bright, 10 * 26 * 26);  // and the end of the colour bar
    EXPECT_GT(countOf(weighted, inferno(0.5)), 10);
    EXPECT_THROW(greyFigure("", ImageF()), std::invalid_argument);
    for (const char* text : {">u [px]</text>", ">v [px]</text>", ">15</text>"})
        EXPECT_NE(greyFigure("", one).svg().find(text), std::string::npos) << text;
}

TEST(Figures, PixelsWithoutASurfaceHaveTheirOwnColor) {
    View predicted;
    predicted.intensity = ImageF(2, 3, 0.4F);
    predicted.depth = ImageF(2, 3, 1.F);
    predicted.depth[1][2] = 0.F;
    const ImageF observed(2, 3, 0.7F);
    EXPECT_EQ(greyPicture(observed).pixels[5], greyColor(0.7F));
    EXPECT_EQ(predictedPicture(predicted).pixels[0], greyColor(0.4F));
    EXPECT_EQ(predictedPicture(predicted).pixels[5], kUnknownColor);
    EXPECT_EQ(differencePicture(observed, predicted).pixels[0], viridis(1.));
    EXPECT_EQ(differencePicture(observed, predicted).pixels[5], kUnknownColor);
    EXPECT_THROW(imagesFigure({}).png(), std::invalid_argument);
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

}  // namespace
}  // namespace photonav
