// SPDX-License-Identifier: BSD-3-Clause
// What a report page plays: a logged flight, one that is shown while it is flown, and pictures.
#include "app/report/browser.hpp"
#include "app/report/sample_report.hpp"
#include "drawing/flightlog/sample_log.hpp"
#include "live/live_server.hpp"

namespace photonav {
namespace {

using ReportPlayerTest = ReportBrowserTest;

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
    setTimeout(() => {
      const canvas = document.getElementById('difference'), pen = canvas.getContext('2d');
      const at = (x) => [...pen.getImageData(x, canvas.height / 2, 1, 1).data].slice(0, 3).join(' ');
      result.difference = `${canvas.width}: ${at(1)}, ${at(canvas.width - 2)}`;
    }, 1000);
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

TEST_F(ReportPlayerTest, AFlightIsShownAgainAtAnyTime) {
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
    // Both are white on the left; on the right they differ by half of the scale of colours.
    EXPECT_EQ(published(outcome.dom, "difference"), "94: 68 1 84, 36 137 141");
    EXPECT_EQ(published(outcome.dom, "played"), "3.5");  // to its end
    EXPECT_EQ(published(outcome.dom, "button"), "Play");
    EXPECT_GT(std::atoi(published(outcome.dom, "grid").c_str()), 3);
    EXPECT_TRUE(contains(outcome.dom, "class=\"good\">arrived</span>"));
}

TEST_F(ReportPlayerTest, AFlightIsFollowedWhileItIsFlown) {
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

TEST_F(ReportPlayerTest, PicturesArePlayedAndEnd) {
    ReportData data = sampleReport();
    for (const char* caption : {"first", "second", "third"})
        data.frames.push_back({caption, data.views.front().image});
    const Outcome outcome = open(data, "", "", kPlayFrames);
    expectNoErrors(outcome);
    EXPECT_EQ(published(outcome.dom, "before"), "2 Play third");
    EXPECT_EQ(published(outcome.dom, "begun"), "0 Pause first");
    EXPECT_EQ(published(outcome.dom, "ended"), "2 Play third");
}

// The second flight is chosen, and played to its end.
constexpr const char* kPlaySecondFlight = R"js(
  setTimeout(() => {
    const choice = document.getElementById('frame-series'), state = document.documentElement.dataset;
    state.flights = choice.hidden ? 'hidden' : [...choice.options].map((option) => option.value).join();
    state.first = document.getElementById('frame').alt;
    choice.value = 'b';
    choice.dispatchEvent(new Event('change'));
    state.second = document.getElementById('frame').alt;
    const robot = view3d.layers.robot.object;
    const body = () => { const p = robot.children[1].position; return `${p.x} ${p.y} ${p.z}`; };
    state.robot = `${body()}, ${robot.children.length}`;
    document.getElementById('frame-slider').value = 1;
    document.getElementById('frame-slider').dispatchEvent(new Event('input'));
    state.later = `${body()}, ${robot.children.length}`;
  }, 1500);
)js";

TEST_F(ReportPlayerTest, FlightsArePlayedWithTheirRobotIn3d) {
    ReportData data = sampleReport();
    data.result = {{"command", "fly"}, {"status", "done"}, {"planners", nlohmann::json::array()}};
    const auto frame = [&](const char* caption, const char* series, double x) {
        ReportFrame shown{caption, data.views.front().image, series};
        shown.believed = PathPoint{};
        shown.believed->T_w_c.translation() = shown.believed->position = {x, 0.5, 2.};
        return shown;
    };
    data.frames = {frame("a0", "a", 1.), frame("b0", "b", 2.), frame("b1", "b", 3.)};
    data.frames[1].truth = Eigen::Vector3d(2.1, 0.5, 2.);
    const Outcome outcome = open(data, "", "", kPlaySecondFlight);
    expectNoErrors(outcome);
    EXPECT_EQ(published(outcome.dom, "flights"), "a,b");
    EXPECT_EQ(published(outcome.dom, "first"), "a0");
    EXPECT_EQ(published(outcome.dom, "second"), "b0");
    EXPECT_EQ(published(outcome.dom, "robot"), "2 0.5 2, 5");  // frustum, body, ellipsoid, truth
    EXPECT_EQ(published(outcome.dom, "later"), "3 0.5 2, 3");  // its true position is not known
}

// The picture follows the frames, and the frames follow the picture.
constexpr const char* kMoveBoth = R"js(
  setTimeout(() => {
    const state = document.documentElement.dataset;
    const said = () => `${state.waypoint} ${document.getElementById('frame-caption').textContent}`;
    const move = (id, value) => {
      const slider = document.getElementById(id);
      slider.value = value;
      slider.dispatchEvent(new Event('input'));
      return said();
    };
    Object.assign(state, {before: said(), byFrame: move('waypoint', 7), byPicture: move('frame-slider', 1)});
  }, 1500);
)js";

TEST_F(ReportPlayerTest, ThePictureOfTheNearestFrameIsShown) {
    ReportData data = sampleReport();
    data.result = {{"command", "map"}};
    data.views.clear();
    for (const std::size_t point : {2U, 5U, 9U}) {
        ReportFrame frame{fmt::format("picture {}", point), greyPng(ImageF(4, 6, 0.5F))};
        frame.believed = data.paths[0].points[point];
        frame.color = data.paths[0].color;
        data.frames.push_back(frame);
    }
    const Outcome outcome = open(data, "", "", kMoveBoth);
    expectNoErrors(outcome);
    EXPECT_EQ(published(outcome.dom, "before"),
              "2 Picture 1 of 3, at frame 2 of the path: picture 2");
    EXPECT_EQ(published(outcome.dom, "by-frame"),
              "7 Picture 2 of 3, at frame 5 of the path: picture 5");
    EXPECT_EQ(published(outcome.dom, "by-picture"),
              "5 Picture 2 of 3, at frame 5 of the path: picture 5");
}

}  // namespace
}  // namespace photonav
