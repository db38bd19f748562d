// SPDX-License-Identifier: BSD-3-Clause
// What a report page says: numbers, units and sentences.
#include "app/report/browser.hpp"
#include "app/report/sample_report.hpp"

namespace photonav {
namespace {

using ReportWordsTest = ReportBrowserTest;

TEST_F(ReportWordsTest, AMeanTraceIsThatOfTheRun) {
    const Outcome outcome = open(sampleReport());
    expectNoErrors(outcome);
    const std::size_t begin = outcome.dom.find("<h2>Paths compared</h2>");
    ASSERT_NE(begin, std::string::npos);
    const std::string table =
        outcome.dom.substr(begin, outcome.dom.find("</table>", begin) - begin);
    EXPECT_TRUE(contains(table, "<td>0.0410&nbsp;m²</td>")) << table;
    EXPECT_TRUE(contains(table, "<td>0.200&nbsp;m²</td>")) << table;
}

TEST_F(ReportWordsTest, PathsThatEndAlikeAreComparedByTheirMeanTraces) {
    ReportData data = sampleReport();
    data.paths[1].points.back().positionCovariance =
        1.004 * data.paths[0].points.back().positionCovariance;
    const Outcome outcome = open(data);
    expectNoErrors(outcome);
    EXPECT_FALSE(contains(outcome.dom, "1.0 times"));
    EXPECT_TRUE(contains(outcome.dom,
                         "the mean trace along the path is 0.0410 instead of "
                         "0.200&nbsp;m²: 4.9 times smaller"));
}

TEST_F(ReportWordsTest, AnInformationHasNoUnitOfACovariance) {
    ReportData data = sampleReport();
    data.result = {{"command", "info"}, {"view", {{"information_trace", 63207248.4}}}};
    const Outcome outcome = open(data);
    expectNoErrors(outcome);
    EXPECT_TRUE(contains(outcome.dom,
                         "<th>Trace of the information (1/m² and 1/rad², added)</th><td>6.32"));
    EXPECT_FALSE(contains(outcome.dom, "<th>Information trace</th>"));
}

TEST_F(ReportWordsTest, NumbersOfAReplayAreInWords) {
    ReportData data = sampleReport();
    data.result = {{"command", "replay"},
                   {"interrupted", false},
                   {"judged", 80},
                   {"rpe", {{"frame", {{"median_rotation_deg", 0.14}}}}},
                   {"dataset", {{"layout", "TUM RGB-D"}}}};
    const Outcome outcome = open(data);
    expectNoErrors(outcome);
    EXPECT_TRUE(contains(outcome.dom, "<h3>Relative error</h3>"));
    EXPECT_TRUE(
        contains(outcome.dom, "<th>Over a frame: rotation, median</th><td>0.14&nbsp;°</td>"));
    EXPECT_TRUE(contains(outcome.dom, "<th>Tracked frames with a true pose</th><td>80</td>"));
    EXPECT_TRUE(contains(outcome.dom, "<h3>Recording</h3>"));
    EXPECT_FALSE(contains(outcome.dom, "<th>Interrupted</th>"));
}

constexpr const char* kMeasureCells = R"js(
  setTimeout(() => {
    const wrap = (text) => getComputedStyle([...document.querySelectorAll('td')]
        .find((cell) => cell.textContent === text)).overflowWrap;
    Object.assign(document.documentElement.dataset, {
      number: wrap('3.01\u202f×\u202f10⁻⁴'), text: wrap('12.4\u00a0mm, 3\u00a0m/s of 20 frames'),
      file: wrap('/a/long/path/of/a/file/in/a/folder')});
  }, 1500);
)js";

TEST_F(ReportWordsTest, ANumberStaysWithItsUnit) {
    ReportData data = sampleReport();
    data.result = {{"command", "info"}, {"value", 3.01e-4}};
    data.tables = {{"Table",
                    {{"speed", "12.4 mm, 3 m/s of 20 frames"},
                     {"file", "/a/long/path/of/a/file/in/a/folder"}}}};
    const Outcome outcome = open(data, "", "", kMeasureCells);
    expectNoErrors(outcome);
    EXPECT_EQ(published(outcome.dom, "number"), "normal");
    EXPECT_EQ(published(outcome.dom, "text"), "normal");
    EXPECT_EQ(published(outcome.dom, "file"), "anywhere");
}

constexpr const char* kMoveAlpha = R"js(
  setTimeout(() => {
    const slider = document.getElementById('cost-alpha');
    const said = () => document.getElementById('cost-rows').textContent;
    const planned = said();
    slider.value = 1;
    slider.dispatchEvent(new Event('input'));
    Object.assign(document.documentElement.dataset, {planned, atOne: said()});
  }, 1500);
)js";

TEST_F(ReportWordsTest, TheCostOfBothPathsIsShownOverAlpha) {
    ReportData data = sampleReport();
    const auto path = [](double cost, double length, double trace) {
        return nlohmann::json{{"cost", cost}, {"metric_length", length}, {"mean_trace", trace}};
    };
    data.result = path(5., 12., 0.1);
    data.result.update(
        {{"command", "plan"}, {"alpha", 0.25}, {"kappa", 2.}, {"baseline", path(8., 10., 0.3)}});
    const Outcome outcome = open(data, "", "", kMoveAlpha);
    expectNoErrors(outcome);
    // 0.25 * 12 + 0.75 * 2 * 1.2, and 0.25 * 10 + 0.75 * 2 * 3
    EXPECT_EQ(published(outcome.dom, "planned"),
              "belief_rrt_star4.8062.5&nbsp;%37.5&nbsp;%rrt_star735.7&nbsp;%64.3&nbsp;%");
    EXPECT_EQ(published(outcome.dom, "at-one"),
              "belief_rrt_star12100&nbsp;%0&nbsp;%rrt_star10100&nbsp;%0&nbsp;%");
    // 2 a = (1 - a) * 2 * 1.8
    EXPECT_TRUE(contains(outcome.dom,
                         "cost the same at alpha 0.643: belief_rrt_star is cheaper "
                         "below it, rrt_star above it."));
}

TEST_F(ReportWordsTest, AStudyOfServoingBeginsWithWhatConverges) {
    ReportData data = sampleReport();
    data.paths.clear();
    data.trees.clear();
    data.views.clear();
    data.result = {
        {"command", "servo"},
        {"basin", {{{"converged", 10}, {"trials", 10}}, {{"converged", 3}, {"trials", 10}}}},
        {"modes", {{{"rate_per_s", 0.8}, {"in_words", "z and x"}}}},
        {"position_sigma_m", 0.0126},
        {"rotation_sigma_rad", nullptr},
        {"condition", 60.}};
    const Outcome outcome = open(data);
    expectNoErrors(outcome);
    EXPECT_TRUE(contains(outcome.dom,
                         "13 of 20 starts converge to the goal’s view, and small offsets in the "
                         "slowest direction (z and x) decay with a time constant of 1.25&nbsp;s."));
    EXPECT_TRUE(contains(outcome.dom, "<b>12.6<small>mm</small></b>"));
}

}  // namespace
}  // namespace photonav
