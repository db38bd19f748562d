// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <regex>
#include <stdexcept>

#include "drawing/plot/decoded.hpp"
#include "io/error.hpp"
#include "plot/figure.hpp"
#include "scene/texture.hpp"
#include "temporary_folder.hpp"

namespace photonav {
namespace {

constexpr Color kRed{255, 0, 0}, kBlue{0, 0, 255};
constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// The frame alone: 400 x 300 px, 4 x 3 units, no axes.
Plot bare() {
    Plot plot;
    plot.x = {0., 4.};
    plot.y = {0., 3.};
    plot.width = 400.;
    plot.height = 300.;
    plot.hasAxes = false;
    return plot;
}

cv::Mat3b drawn(const Plot& plot, const std::string& name) {
    return decoded(Figure{{}, {{plot}}, Figure::Legend::none}.png(), name);
}

TEST(Axis, TicksAreRoundAndInside) {
    const auto labels = [](const Axis& axis, int wanted) {
        std::string text;
        for (const Tick& tick : ticksOf(axis, wanted)) text += tick.label + " ";
        return text;
    };
    EXPECT_EQ(labels({0., 10.}, 5), "0 2 4 6 8 10 ");
    EXPECT_EQ(labels({-0.05, 0.17}, 4), "−0.05 0.00 0.05 0.10 0.15 ");
    EXPECT_EQ(labels({0.02, 3., true}, 5), "0.02 0.05 0.1 0.2 0.5 1 2 ");
    EXPECT_EQ(labels({1e-6, 1., true}, 5), "10⁻⁶ 10⁻⁵ 10⁻⁴ 10⁻³ 10⁻² 10⁻¹ 10⁰ ");
    EXPECT_EQ(labels({3.1e-4, 4.2e-4, true}, 3), "3.5·10⁻⁴ 4·10⁻⁴ ");
    EXPECT_EQ(labels({0.21, 0.42, true}, 4), "0.25 0.30 0.35 0.40 ");
    EXPECT_EQ(labels({.min = 0.5, .max = 4.5, .whole = true}, 10), "1 2 3 4 ");
    EXPECT_EQ(labels({10., 0.}, 5), "0 2 4 6 8 10 ");
}

TEST(Axis, LimitsAreGivenOrFromTheData) {
    const Axis given = Axis{0., 2.}.fittedTo({-5., 9.});
    EXPECT_EQ(given.min, 0.);
    EXPECT_EQ(given.max, 2.);
    const Axis around = Axis{.min = 0.}.fittedTo({1., std::nan(""), 10., kInfinity});
    EXPECT_EQ(around.min, 0.);
    EXPECT_GT(around.max, 10.);
    EXPECT_LT(around.max, 11.);
    const Axis log = Axis{.log = true}.fittedTo({-1., 0., 0.01, 1.});
    EXPECT_GT(log.min, 0.);
    EXPECT_LT(log.min, 0.01);
    for (const std::vector<double>& values : {std::vector<double>{}, {0.}, {3., 3.}, {-2.}})
        for (const Axis& axis : {Axis{}, Axis{.min = 5.}, Axis{.max = -5.}, Axis{.log = true}}) {
            const Axis fitted = axis.fittedTo(values);
            EXPECT_LT(fitted.min, fitted.max);
        }
}

TEST(Axis, ValuesWithoutALogarithmAreAtTheEnd) {
    const Axis axis{0.1, 10., true};
    EXPECT_NEAR(axis.fraction(1.), 0.5, 1e-12);
    EXPECT_EQ(axis.fraction(0.), 0.);
    EXPECT_EQ(axis.fraction(-3.), 0.);
    EXPECT_EQ(axis.fraction(kInfinity), 1.);
    EXPECT_TRUE(std::isnan(axis.fraction(std::nan(""))));
}

TEST(Plot, MarksAreWhereTheirCoordinatesAre) {
    Plot plot = bare();
    plot.dots({{1., 1.}}, {.color = kRed, .width = 20.});
    const cv::Mat3b image = drawn(plot, "dot");
    ASSERT_EQ(image.size(), cv::Size(440, 340));  // a border of 20 px
    const cv::Rect bounds = boundsOf(image, kRed);
    EXPECT_NEAR(bounds.x + bounds.width / 2., 20. + 100., 1.);
    EXPECT_NEAR(bounds.y + bounds.height / 2., 20. + 200., 1.);
    EXPECT_NEAR(bounds.width, 20., 2.);
}

TEST(Plot, NothingIsDrawnOutsideTheFrame) {
    Plot plot = bare();
    plot.curve({{-1e300, 1.}, {1e300, 1.}}, {.color = kRed, .width = 4.});
    plot.dots({{4., 3.}, {1e9, 2.}}, {.color = kRed, .width = 20.});
    const cv::Rect bounds = boundsOf(drawn(plot, "outside"), kRed);
    EXPECT_EQ(bounds.x, 20);
    EXPECT_EQ(bounds.br().x, 420);
    EXPECT_EQ(bounds.y, 20);
}

TEST(Plot, NaNLeavesAGap) {
    Plot plot = bare();
    plot.curve({{0., 1.}, {1., 1.}, {std::nan(""), 1.}, {3., 1.}, {4., 1.}},
               {.color = kRed, .width = 4.});
    const cv::Mat3b row = drawn(plot, "gap").row(220);
    EXPECT_NEAR(countOf(row, kRed), 200, 4);
    EXPECT_EQ(countOf(row(cv::Rect(130, 0, 180, 1)), kRed), 0);
}

TEST(Plot, InfinityIsTheBorderOfTheFrame) {
    Plot plot = bare();
    plot.band({{1., -kInfinity}, {2., -kInfinity}}, {{1., kInfinity}, {2., kInfinity}},
              {.color = kRed});
    const cv::Rect bounds = boundsOf(drawn(plot, "infinity"), kRed);
    EXPECT_EQ(bounds, cv::Rect(120, 20, 100, 300));
}

TEST(Plot, OverlapOfATranslucentMarkIsNotDarker) {
    Plot plot = bare();
    plot.dots({{1., 1.}, {1.1, 1.}}, {.color = kBlue, .width = 40., .opacity = 0.5});
    const cv::Mat3b image = drawn(plot, "translucent");
    EXPECT_EQ(image(220, 125), image(220, 110));
    EXPECT_EQ(image(220, 125)[0], 255);
    EXPECT_NEAR(image(220, 125)[2], 128, 2);
}

TEST(Plot, PictureIsStretchedOverItsBox) {
    Plot plot = bare();
    plot.picture({{kRed, kBlue, kBlue, kBlue}, 2},
                 {Eigen::Vector2d(1., 1.), Eigen::Vector2d(3., 2.)}, false);
    const cv::Mat3b image = drawn(plot, "picture");
    EXPECT_EQ(boundsOf(image, kRed), cv::Rect(120, 120, 100, 50));
    EXPECT_EQ(boundsOf(image, kBlue), cv::Rect(120, 120, 200, 100));
}

TEST(Plot, ImagesHavePixelCoordinates) {
    Plot plot = Plot::image({{kRed, kBlue, kBlue, kBlue, kBlue, kBlue}, 2}, 200.);
    const cv::Mat3b image = drawn(plot, "image");
    EXPECT_EQ(boundsOf(image, kRed), cv::Rect(20, 20, 100, 100));
    EXPECT_EQ(boundsOf(image, kBlue), cv::Rect(20, 20, 200, 300));
    const Color green{0, 255, 0};
    plot.fill({{{-0.5, -0.5}, {0.5, -0.5}, {0.5, 0.5}, {-0.5, 0.5}}}, {.color = green});
    EXPECT_EQ(boundsOf(drawn(plot, "first_pixel"), green), cv::Rect(20, 20, 100, 100));
}

TEST(Plot, EllipseHasTheCovarianceOfItsOutline) {
    Eigen::Matrix2d covariance;
    covariance << 2., 0.5, 0.5, 1.;
    for (const Eigen::Vector2d& p : ellipse({1., 2.}, covariance, 3.)) {
        const Eigen::Vector2d d = p - Eigen::Vector2d(1., 2.);
        EXPECT_NEAR(d.dot(covariance.inverse() * d), 9., 1e-9);
    }
}

TEST(Figure, FramesOfAColumnAreAligned) {
    Figure figure;
    for (const double high : {1., 12345.}) {  // labels of different width
        Plot plot;
        plot.y = {0., high, false, "y"};
        plot.x = {0., 1.};
        plot.band({{-kInfinity, -kInfinity}, {kInfinity, -kInfinity}},
                  {{-kInfinity, kInfinity}, {kInfinity, kInfinity}},
                  {.color = high > 1. ? kRed : kBlue});
        figure.rows.push_back({plot});
    }
    const cv::Mat3b image = decoded(figure.png(), "aligned");
    EXPECT_EQ(boundsOf(image, kRed).x, boundsOf(image, kBlue).x);
    EXPECT_GT(boundsOf(image, kRed).y, boundsOf(image, kBlue).br().y);
}

TEST(Figure, LegendHasEveryNameOnce) {
    const auto sizeOf = [](Figure::Legend legend, const std::string& second) {
        Plot plot = bare();
        plot.dots({{1., 1.}}, {.color = kRed, .name = "one"});
        plot.dots({{1., 1.}}, {.color = kBlue, .name = second});
        return decoded(Figure{"title", {{plot, plot}}, legend}.png(), "legend").size();
    };
    const cv::Size none = sizeOf(Figure::Legend::none, "two");
    EXPECT_EQ(sizeOf(Figure::Legend::above, "two").width, none.width);
    EXPECT_GT(sizeOf(Figure::Legend::above, "two").height, none.height);
    EXPECT_GT(sizeOf(Figure::Legend::right, "two").width, none.width);
    EXPECT_GT(sizeOf(Figure::Legend::right, "a long name").width,
              sizeOf(Figure::Legend::right, "one").width);
}

TEST(Figure, WritesThreeFormatsByTheNameOfTheFile) {
    const test::TemporaryFolder folder;
    Plot plot = bare();
    plot.curve({{0., 0.}, {4., 3.}}, {.color = kRed, .opacity = 0.5, .name = "curve"});
    const Figure figure{"title", {{plot}}};
    for (const auto& [name, begin] :
         {std::pair{"a.png", "\x89PNG"}, {"a.svg", "<?xml"}, {"a.pdf", "%PDF"}}) {
        figure.save(folder.path() / name);
        EXPECT_EQ(test::contentOf(folder.path() / name).find(begin), 0U) << name;
    }
    EXPECT_THROW(figure.save(folder.path() / "a.gif"), InputError);
    EXPECT_THROW(Figure{}.png(), std::invalid_argument);
}

TEST(Figure, VectorGraphicsHoldTextsAsText) {
    Plot plot = bare();
    plot.title = "1 < 2 & \x01";
    const Figure figure{"title", {{plot}}};
    const std::string svg = figure.svg();
    EXPECT_NE(svg.find(">title</text>"), std::string::npos);
    EXPECT_NE(svg.find(">1 &lt; 2 &amp;  </text>"), std::string::npos);
    EXPECT_NE(figure.pdf().find("/ToUnicode"), std::string::npos);
}

TEST(Figure, TranslucentMarksOfSvgAreInsideThePage) {
    Plot plot = bare();
    plot.curve({{1., 1.}, {2., 2.}}, {.color = kRed, .opacity = 0.5, .name = "curve"});
    const std::string svg = Figure{"title", {{plot}}}.svg();
    const std::regex link("url\\(#([a-z0-9]+)\\)");
    for (std::sregex_iterator it(svg.begin(), svg.end(), link), end; it != end; ++it)
        EXPECT_NE(svg.find("id=\"" + (*it)[1].str() + "\""), std::string::npos) << (*it)[1];
    EXPECT_EQ(svg.find("width=\"16777215\""), std::string::npos);  // of an unlimited surface
}

TEST(Figure, SmallPicturesAreMagnifiedForAllViewers) {
    Plot plot = bare();
    plot.picture({{kRed, kBlue, kBlue, kBlue}, 2},
                 {Eigen::Vector2d(1., 1.), Eigen::Vector2d(3., 3.)}, false);
    const Figure figure{"", {{plot}}};
    EXPECT_NE(figure.svg().find("width=\"200\" height=\"200\" xlink:href=\"data:image/png"),
              std::string::npos);
}

TEST(Figure, ATitleThatIsNotUtf8LeavesTheRestOfTheFigure) {
    Plot plot = bare();
    plot.dots({{1., 1.}}, {.color = kRed, .width = 40.});
    const Figure figure{"cut \xE2", {{plot}}, Figure::Legend::none};
    EXPECT_GT(countOf(decoded(figure.png(), "cut"), kRed), 1000);
    EXPECT_NE(figure.svg().find(">cut \xEF\xBF\xBD</text>"), std::string::npos);
}

/// CIELAB distance of two colours for a reader whose sight is given by a matrix on linear RGB.
double perceivedDistance(const Color& a, const Color& b, const Eigen::Matrix3d& sight) {
    cv::Mat3f seen(1, 2);
    for (const int i : {0, 1}) {
        const Color& color = i == 0 ? a : b;
        const Eigen::Vector3d linear(decodeSrgb(color.red / 255.), decodeSrgb(color.green / 255.),
                                     decodeSrgb(color.blue / 255.));
        const Eigen::Vector3f rgb = (sight * linear).cwiseMax(0.).cwiseMin(1.).cast<float>();
        seen(0, i) = {rgb.x(), rgb.y(), rgb.z()};
    }
    cv::cvtColor(seen, seen, cv::COLOR_LRGB2Lab);
    return cv::norm(seen(0, 0), seen(0, 1));
}

/// The least distance for readers with all receptors, without green and without red ones (Machado
/// et al. 2009).
double leastDistance(const Color& a, const Color& b) {
    Eigen::Matrix3d noGreen, noRed;
    noGreen << 0.367322, 0.860646, -0.227968, 0.280085, 0.672501, 0.047413, -0.011820, 0.042940,
        0.968881;
    noRed << 0.152286, 1.052583, -0.204868, 0.114503, 0.786281, 0.099216, -0.003882, -0.048116,
        1.051998;
    return std::min({perceivedDistance(a, b, Eigen::Matrix3d::Identity()),
                     perceivedDistance(a, b, noGreen), perceivedDistance(a, b, noRed)});
}

TEST(SeriesColors, DifferFromEachOtherAndFromThePlanners) {
    for (std::size_t i = 0; i < kSeriesColors.size(); ++i) {
        for (std::size_t j = 0; j < i; ++j)
            EXPECT_GT(leastDistance(kSeriesColors[i], kSeriesColors[j]), 15.) << i << ", " << j;
        for (const char* planner : {"belief_rrt_star", "pa_rrt_star", "rrbt", "rrt_star",
                                    "rrt_star/fixed", "rrt_star/forward"})
            EXPECT_GT(leastDistance(kSeriesColors[i], plannerColor(planner)), 15.)
                << i << ", " << planner;
    }
}

TEST(PlannerColor, DiffersForEveryPlanner) {
    const char* const names[]{"belief_rrt_star", "pa_rrt_star", "rrbt", "rrt_star", "unknown"};
    for (const char* a : names)
        for (const char* b : names) EXPECT_EQ(plannerColor(a) == plannerColor(b), a == b);
    EXPECT_EQ(hexColor({222, 79, 12}), "#de4f0c");
}

}  // namespace
}  // namespace photonav
