// SPDX-License-Identifier: BSD-3-Clause
// What a report page shows, and what clicks and keys do.
#include "app/report/browser.hpp"
#include "app/report/sample_report.hpp"
#include "comparisons/sweep_report.hpp"
#include "io/base64.hpp"
#include "sweep_run.hpp"

namespace photonav {
namespace {

TEST_F(ReportBrowserTest, PageIsDrawnAndShowsTheWaypointOfItsAddress) {
    const ReportData data = sampleReport();
    const Outcome outcome = open(data, "#waypoint=3");
    expectNoErrors(outcome);
    EXPECT_TRUE(contains(outcome.dom, "<title>Two textures"));
    EXPECT_TRUE(contains(outcome.dom, "times smaller"));
    EXPECT_EQ(published(outcome.dom, "canvas"), "drawn");
    EXPECT_GT(std::atoi(published(outcome.dom, "colors").c_str()), 50);

    EXPECT_EQ(published(outcome.dom, "waypoint"), "3");
    EXPECT_TRUE(contains(outcome.dom, "Waypoint 3 of"));
    const std::string prefix = "\" src=\"data:image/png;base64,";
    EXPECT_TRUE(contains(outcome.dom, prefix + base64Encode(data.views[3].image) + "\""));
    EXPECT_TRUE(contains(outcome.dom, prefix + base64Encode(data.views[3].contribution) + "\""));
}

// The mouse searches the canvas until the cursor says that a waypoint is under it, and clicks. Then
// the left arrow key goes one back. At the end nothing may be drawn any more.
constexpr const char* kVisitor = R"js(
  setTimeout(() => {
    const canvas = document.getElementById('scene'), box = canvas.getBoundingClientRect();
    const result = document.documentElement.dataset;
    const mouse = (type, x, y) => canvas.dispatchEvent(
        new PointerEvent(type, {clientX: box.left + x, clientY: box.top + y, bubbles: true}));
    for (let y = 0; y < box.height && !result.clicked; y += 10)
      for (let x = 0; x < box.width && !result.clicked; x += 10) {
        mouse('pointermove', x, y);
        if (!canvas.classList.contains('hit')) continue;
        mouse('pointerdown', x, y);
        mouse('pointerup', x, y);
        result.clicked = result.waypoint;
      }
    dispatchEvent(new KeyboardEvent('keydown', {key: 'ArrowLeft'}));
    result.walked = result.waypoint;
    setTimeout(() => {
      let frames = 0;
      const request = window.requestAnimationFrame;
      window.requestAnimationFrame = (draw) => { ++frames; return request(draw); };
      setTimeout(() => { result.frames = frames; }, 1000);
    }, 1000);
  }, 1500);
)js";

TEST_F(ReportBrowserTest, ClickAndKeySelectWaypointsAndIdlePageRests) {
    const Outcome outcome = open(sampleReport(), "#waypoint=0", "", kVisitor);
    expectNoErrors(outcome);
    const int clicked = std::atoi(published(outcome.dom, "clicked").c_str());
    EXPECT_GT(clicked, 0);
    EXPECT_EQ(published(outcome.dom, "walked"), std::to_string(clicked - 1));
    EXPECT_EQ(published(outcome.dom, "frames"), "0");
}

TEST_F(ReportBrowserTest, MapOfVoxelsWithoutPathIsDrawn) {
    ReportData data;
    data.title = "A map";
    data.voxels.size = 0.05;
    for (int i = 0; i < 40; ++i)
        for (int j = 0; j < 40; ++j) {
            for (const int k : {i, j, (i / 8 + j / 8) % 2})
                data.voxels.centers.push_back(0.05F * k);
            data.voxels.grey.push_back(static_cast<std::uint8_t>(6 * i));
        }
    const Outcome outcome = open(data);
    expectNoErrors(outcome);
    EXPECT_EQ(published(outcome.dom, "canvas"), "drawn");
}

constexpr const char* kTurnBelow = R"js(
  setTimeout(() => {
    const canvas = document.getElementById('scene'), drag = (type, target, y) =>
        target.dispatchEvent(new MouseEvent(type, {button: 0, clientX: 300, clientY: y, bubbles: true}));
    drag('mousedown', canvas, 600);
    drag('mousemove', document, 100);
    drag('mouseup', document, 100);
    const {controls} = view3d;
    Object.assign(document.documentElement.dataset, {
      turned: controls.getPolarAngle() > 1.5, above: controls.object.position.z >= controls.target.z,
      cut: document.getElementById('cut-value').textContent});
  }, 1500);
)js";

TEST_F(ReportBrowserTest, WithoutAPathTheCeilingIsCutAndTheFloorIsBelow) {
    ReportData data = sampleReport();
    data.paths.clear();
    data.trees.clear();
    data.views.clear();
    data.start.z() = data.goal.z() = 0.1;
    const Outcome outcome = open(data, "", "", kTurnBelow);
    expectNoErrors(outcome);
    EXPECT_EQ(published(outcome.dom, "cut"), "z = 0.40 m");
    EXPECT_EQ(published(outcome.dom, "turned"), "true");
    EXPECT_EQ(published(outcome.dom, "above"), "true");
}

TEST_F(ReportBrowserTest, FiguresAreSofterInDarkMode) {
    ReportData data = sampleReport();
    data.figures = {{"A figure.", data.views.front().image}};
    constexpr const char* kFilter = R"js(
      setTimeout(() => { document.documentElement.dataset.filter =
          getComputedStyle(document.querySelector('#figures img')).filter; }, 1500);
    )js";
    const std::string dark = "--blink-settings=preferredColorScheme=0";
    EXPECT_EQ(published(open(data, "", dark, kFilter).dom, "filter"), "brightness(0.82)");
    EXPECT_EQ(published(open(data, "", "", kFilter).dom, "filter"), "none");
}

/// Also where a figure or a tile is alone in the last row; and nothing is cut off on a phone.
TEST_F(ReportBrowserTest, RowsAreFilledAndFitThePage) {
    ReportData data = sampleReport();
    data.figures.assign(3, {"A figure.", data.views.front().image});
    constexpr const char* kLayout = R"js(
      setTimeout(() => {
        const end = (box) => Math.round(box.getBoundingClientRect().right);
        const ragged = [...document.querySelectorAll('.tiles, .charts, .figures, .tables')].filter((section) => {
          const shown = [...section.children].filter((box) => box.offsetWidth > 0);
          return shown.length && Math.abs(end(shown.at(-1)) - end(section)) > 1;
        });
        const cut = [...document.querySelectorAll('body, #cost > div')].filter(
            (box) => box.scrollWidth > box.clientWidth);
        document.documentElement.dataset.ragged = ragged.map((section) => section.id || 'nameless').join(' ') || 'none';
        document.documentElement.dataset.cut = cut.map((box) => box.tagName).join(' ') || 'none';
      }, 1500);
    )js";
    for (const char* size : {"--window-size=1280,2200", "--window-size=1000,2200",
                             "--window-size=500,2200 --force-device-scale-factor=1.25"}) {
        const std::string dom = open(data, "", size, kLayout).dom;
        EXPECT_EQ(published(dom, "ragged"), "none") << size;
        EXPECT_EQ(published(dom, "cut"), "none") << size;
    }
}

TEST_F(ReportBrowserTest, FlightsBeginWithWhatWasFlown) {
    ReportData data = sampleReport();
    data.result = {{"command", "fly"},
                   {"planners",
                    {{{"planner", "ours"},
                      {"flights", 20},
                      {"arrived", 19},
                      {"position_rmse_m", 0.0213},
                      {"predicted_sigma_m", 0.0241},
                      {"nees_per_dof", 0.93}},
                     {{"planner", "theirs"},
                      {"flights", 0},
                      {"arrived", 0},
                      {"position_rmse_m", nullptr},
                      {"predicted_sigma_m", nullptr},
                      {"nees_per_dof", nullptr}}}}};
    const Outcome outcome = open(data);
    expectNoErrors(outcome);
    EXPECT_TRUE(contains(outcome.dom,
                         "ours: 19 of 20 flights arrived, with a position error of "
                         "2.13&nbsp;cm rms (predicted 2.41&nbsp;cm; NEES "
                         "0.930); theirs was not flown."));
    EXPECT_TRUE(contains(outcome.dom, "<b>19<small>of 20</small></b><span>ours: arrived</span>"));
    EXPECT_FALSE(contains(outcome.dom, "<span>goal trace</span>"));
}

TEST_F(ReportBrowserTest, AllNumbersOfAPlanAreGroupedAndHaveUnits) {
    ReportData data = sampleReport();
    data.result = {{"command", "plan"},
                   {"length", 12.4},
                   {"kappa", 2.5},
                   {"kappa_is_automatic", false},
                   {"covariance_frame", "an explanation"},
                   {"baseline", {{"metric_length", 9.3}}},
                   {"time", {{"total_s", 1.5}}}};
    const Outcome outcome = open(data);
    expectNoErrors(outcome);
    EXPECT_TRUE(contains(outcome.dom, "<h3>Path</h3>"));
    EXPECT_TRUE(contains(outcome.dom, "<th>Length</th><td>12.4&nbsp;m</td>"));
    EXPECT_TRUE(contains(outcome.dom, "<h3>RRT*’s path (baseline)</h3>"));
    EXPECT_TRUE(contains(outcome.dom, "<th>Length with rotations counted</th><td>9.3&nbsp;m</td>"));
    EXPECT_TRUE(contains(outcome.dom, "<th>Kappa chosen automatically</th><td>no</td>"));
    EXPECT_FALSE(contains(outcome.dom, "<th>Covariance frame</th>"));
}

TEST_F(ReportBrowserTest, AllNumbersOfOtherResultsAreGroupedByTheirObjects) {
    ReportData data = sampleReport();
    data.result = {{"command", "check"},
                   {"verdict", "the camera stays localised"},
                   {"flights", {{"mean_speed_mps", 0.5}, {"collisions", nlohmann::json::array()}}}};
    const Outcome outcome = open(data);
    expectNoErrors(outcome);
    EXPECT_TRUE(contains(outcome.dom, "<h3>Simulated flights</h3>"));
    EXPECT_TRUE(contains(outcome.dom, "<th>Mean speed</th><td>0.5&nbsp;m/s</td>"));
    EXPECT_TRUE(contains(outcome.dom, "<th>Collisions</th><td>none</td>"));
}

TEST_F(ReportBrowserTest, RecordedFlightsHaveFramesAndNeitherGoalNorCost) {
    ReportData data = sampleReport();
    data.views.clear();
    for (DrawnPath& path : data.paths)
        for (PathPoint& point : path.points) point.cost = 0.;
    data.result = {{"command", "replay"},
                   {"verdict", "tracked 3 of 4 frames, lost 1"},
                   {"frames", 4},
                   {"tracked", 3},
                   {"lost", 1},
                   {"ate_rmse_m", 0.0123},
                   {"nees_per_dof", 1.1},
                   {"fps_with_reading", 30.},
                   {"rpe", {{"second", nullptr}, {"frame", nullptr}}}};
    const Outcome outcome = open(data, "#waypoint=2");
    expectNoErrors(outcome);
    EXPECT_TRUE(contains(outcome.dom, "Tracked 3 of 4 frames, lost 1."));
    EXPECT_TRUE(contains(outcome.dom, "<b>12.3<small>mm</small></b>"));
    EXPECT_TRUE(contains(outcome.dom, "Frame 2 of"));
    EXPECT_FALSE(contains(outcome.dom, "Waypoint 2"));
    EXPECT_FALSE(contains(outcome.dom, "<th>Cost so far</th>"));
    EXPECT_FALSE(contains(outcome.dom, "<span>cost</span>"));
}

TEST_F(ReportBrowserTest, WithoutWebGLThePageSaysSoAndTheRestWorks) {
    const Outcome outcome = open(sampleReport(), "#waypoint=2", "--disable-3d-apis");
    EXPECT_EQ(published(outcome.dom, "errors"), "");
    EXPECT_EQ(published(outcome.dom, "canvas"), "");
    EXPECT_TRUE(contains(outcome.dom, "<p class=\"notice\" id=\"no-webgl\">"));
    EXPECT_TRUE(contains(outcome.dom, "Waypoint 2 of"));
}

/// A sweep of one planner with a path for each of three values of alpha.
ReportData sampleSweepReport() {
    Config config;
    SweepOutcome outcome;
    config.sweep.planners = {"belief_rrt_star"};
    config.sweep.alphas = {0.1, 0.4, 0.7};
    ReportData data = sampleReport();
    const DrawnPath path = data.paths.front();
    data.paths.clear();
    data.views.clear();
    for (const double alpha : config.sweep.alphas) {
        outcome.runs.push_back(test::makeRun({"belief_rrt_star", alpha, 1}, 1., 12. - alpha, 0.2));
        data.paths.push_back(path);
        data.paths.back().name = fmt::format("alpha {}", alpha);
        data.paths.back().color = viridis(alpha);
    }
    outcome.asked = outcome.runs.size();
    data.result = sweepResult(config, outcome, {});
    return data;
}

constexpr const char* kDragAlpha = R"js(
  setTimeout(() => {
    const slider = document.getElementById('alpha');
    slider.value = 1;
    slider.dispatchEvent(new Event('input'));
    const shown = (name) => view3d.layers[name].object.children.map((child) => child.visible).join();
    Object.assign(document.documentElement.dataset, {
      chosen: shown('chosen'), others: shown('others'), ellipsoids: shown('ellipsoids'),
      said: document.getElementById('alpha-value').textContent});
  }, 1500);
)js";

TEST_F(ReportBrowserTest, TheSliderOfASweepShowsThePathOfOneAlphaWithItsEllipsoids) {
    const Outcome before = open(sampleSweepReport());
    expectNoErrors(before);
    EXPECT_EQ(published(before.dom, "alpha"), "0.1");
    const Outcome outcome = open(sampleSweepReport(), "", "", kDragAlpha);
    expectNoErrors(outcome);
    EXPECT_EQ(published(outcome.dom, "alpha"), "0.4");
    EXPECT_EQ(published(outcome.dom, "chosen"), "false,true,false");
    EXPECT_EQ(published(outcome.dom, "others"), "true,false,true");
    EXPECT_EQ(published(outcome.dom, "ellipsoids"), "false,true,false");
    EXPECT_TRUE(contains(published(outcome.dom, "said"), "0.4: 11.6"))
        << published(outcome.dom, "said");
}

TEST_F(ReportBrowserTest, OnlySweepsHaveASliderOverAlpha) {
    const Outcome outcome = open(sampleReport());
    EXPECT_EQ(published(outcome.dom, "alpha"), "");
    EXPECT_TRUE(contains(outcome.dom, "id=\"alpha-bar\" hidden"));
}

}  // namespace
}  // namespace photonav
