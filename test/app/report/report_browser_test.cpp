// SPDX-License-Identifier: BSD-3-Clause
// The report page in a real browser: headless Chromium with a software renderer.
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <sstream>

#include "app/flightlog/sample_log.hpp"
#include "app/report/sample_report.hpp"
#include "io/base64.hpp"
#include "live/live_server.hpp"
#include "report/report.hpp"
#include "report/sweep_report.hpp"
#include "sweep_run.hpp"
#include "temporary_folder.hpp"

namespace photonav {
namespace {

namespace fs = std::filesystem;

constexpr const char* kChromium = "/usr/bin/chromium";

struct Outcome {
    std::string dom;  ///< the page after its scripts ran
    std::string log;  ///< what Chromium said, its console included
};

class ReportBrowserTest : public testing::Test {
  protected:
    void SetUp() override {
#ifdef __SANITIZE_ADDRESS__
        GTEST_SKIP() << "the page runs in the browser, not under the sanitizers";
#endif
        if (!fs::exists(kChromium)) GTEST_SKIP() << kChromium << " is not installed";
        std::string name = (fs::temp_directory_path() / "photonav_browser_XXXXXX").string();
        ASSERT_NE(mkdtemp(name.data()), nullptr);
        folder_ = name;
    }
    void TearDown() override {
        if (!folder_.empty()) fs::remove_all(folder_);
    }

    /// Opens the page of `data` and returns it as it stands a few (virtual) seconds later.
    /// @param script appended to the page: what a visitor would do
    Outcome open(const ReportData& data, const std::string& hash = "",
                 const std::string& options = "", const std::string& script = "") const {
        writeReport(folder_ / "report.html", reportJson(data));
        if (!script.empty())
            std::ofstream(folder_ / "report.html", std::ios::app)
                << "<script>" << script << "</script>";
        return openAddress("file://" + (folder_ / "report.html").string() + hash, options);
    }

    Outcome openAddress(const std::string& address, const std::string& options = "") const {
        const std::string command =
            std::string(kChromium) +
            " --headless --no-sandbox --use-angle=swiftshader --enable-unsafe-swiftshader"
            " --disable-background-networking --disable-component-update --disable-sync"
            " --no-first-run --enable-logging=stderr --virtual-time-budget=8000"
            " --window-size=1400,2200 --user-data-dir=" +
            (folder_ / "profile").string() + " " + options + " --dump-dom '" + address + "' >" +
            (folder_ / "dom").string() + " 2>" + (folder_ / "log").string();
        EXPECT_EQ(std::system(command.c_str()), 0) << test::contentOf(folder_ / "log");
        return {test::contentOf(folder_ / "dom"), test::contentOf(folder_ / "log")};
    }

    fs::path folder_;
};

bool contains(const std::string& text, const std::string& part) {
    return text.find(part) != std::string::npos;
}

/// The value of a data-... attribute of <html>; empty if it is not there.
std::string published(const std::string& dom, const std::string& name) {
    const std::string root = dom.substr(dom.find("<html"), dom.find('>', dom.find("<html")));
    const std::size_t begin = root.find("data-" + name + "=\"");
    if (begin == std::string::npos) return {};
    const std::size_t value = begin + name.size() + 7;
    return root.substr(value, root.find('"', value) - value);
}

void expectNoErrors(const Outcome& outcome) {
    EXPECT_EQ(published(outcome.dom, "errors"), "");
    std::istringstream lines(outcome.log);
    for (std::string line; std::getline(lines, line);)
        EXPECT_FALSE(contains(line, ":CONSOLE")) << line;
}

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

/// The report of a flight that is logged, or shown live.
ReportData flightReport(const nlohmann::json& flight) {
    ReportData data;
    data.title = "A flight";
    data.start = {0, 1, 1.5};
    data.goal = {3, 1, 1.5};
    data.result = {{"command", "explore"}};
    data.flight = flight;
    return data;
}

/// What the page shows of the flight at this time.
constexpr const char* kPublishFlight = R"js(
  setTimeout(() => {
    const result = document.documentElement.dataset, text = (id) => document.getElementById(id).textContent;
    const shown = () => [flight3d.cubes(), text('flight-clock'), result.moment].join('|');
    const slider = document.getElementById('flight-time');
    const moveTo = (time) => {
      slider.value = time;
      slider.dispatchEvent(new Event('input'));
    };
    result.atEnd = shown();
    moveTo(1.6);
    result.back = shown();
    result.numbers = text('flight-numbers');
    moveTo(3.2);
    result.forth = shown();
    moveTo(0.2);
    document.getElementById('flight-play').click();
    setTimeout(() => {
      result.played = slider.value;
      result.button = text('flight-play');
      const canvas = document.getElementById('obstacles'), pen = canvas.getContext('2d');
      const colors = new Set(new Uint32Array(pen.getImageData(0, 0, canvas.width, canvas.height).data.buffer));
      result.grid = colors.size;
    }, 4000);
  }, 1500);
)js";

TEST_F(ReportBrowserTest, AFlightIsShownAgainAtAnyTime) {
    const Outcome outcome =
        open(flightReport(flightLogJson(test::sampleLog())), "", "", kPublishFlight);
    expectNoErrors(outcome);
    EXPECT_EQ(published(outcome.dom, "canvas"), "drawn");
    // Six new cells a moment; at the third one, one goes and one is painted otherwise.
    EXPECT_EQ(published(outcome.dom, "at-end"), "17|3.5 of 3.5&nbsp;s|2");
    EXPECT_EQ(published(outcome.dom, "back"), "12|1.6 of 3.5&nbsp;s|1");
    EXPECT_EQ(published(outcome.dom, "forth"), "17|3.2 of 3.5&nbsp;s|2");
    EXPECT_TRUE(contains(published(outcome.dom, "numbers"), "Update2 of 3, at 1.5&nbsp;s"));
    EXPECT_TRUE(contains(published(outcome.dom, "numbers"), "3, 40, 5"));
    EXPECT_EQ(published(outcome.dom, "played"), "3.5");  // to its end
    EXPECT_EQ(published(outcome.dom, "button"), "Play");
    EXPECT_GT(std::atoi(published(outcome.dom, "grid").c_str()), 3);
    EXPECT_TRUE(contains(outcome.dom, "class=\"good\">arrived</span>"));
}

TEST_F(ReportBrowserTest, AFlightIsFollowedWhileItIsFlown) {
    const FlightLog log = test::sampleLog();
    const std::string page =
        reportPage(reportJson(flightReport({{"header", headerJson(log)}, {"live", true}})));
    LiveServer server({}, page);
    for (const LoggedMoment& moment : log.moments) {
        server.publish("moment", momentJson(log, moment).dump());
    }
    server.publish("end", endJson(log).dump());
    const Outcome outcome = openAddress(server.url());
    expectNoErrors(outcome);
    EXPECT_EQ(published(outcome.dom, "canvas"), "drawn");
    EXPECT_EQ(published(outcome.dom, "moment"), "2");
    EXPECT_TRUE(contains(outcome.dom, "<output id=\"flight-clock\">3.5 of 3.5&nbsp;s</output>"));
    EXPECT_TRUE(contains(outcome.dom, "class=\"good\">arrived</span>"));
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

constexpr const char* kPlayFrames = R"js(
  setTimeout(() => {
    const button = document.getElementById('play'), state = document.documentElement.dataset;
    const said = () => `${state.frame} ${button.textContent} ${document.getElementById('frame').alt}`;
    state.before = said();
    document.getElementById('frame-speed').value = '4';
    button.click();
    state.begun = said();
    setTimeout(() => { state.ended = said(); }, 2000);
  }, 1500);
)js";

TEST_F(ReportBrowserTest, PicturesArePlayedAndEnd) {
    ReportData data = sampleReport();
    for (const char* caption : {"first", "second", "third"})
        data.frames.push_back({caption, data.views.front().image});
    const Outcome outcome = open(data, "", "", kPlayFrames);
    expectNoErrors(outcome);
    EXPECT_EQ(published(outcome.dom, "before"), "2 Play third");
    EXPECT_EQ(published(outcome.dom, "begun"), "0 Pause first");
    EXPECT_EQ(published(outcome.dom, "ended"), "2 Play third");
}

}  // namespace
}  // namespace photonav
