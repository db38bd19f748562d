// SPDX-License-Identifier: BSD-3-Clause
// `photonav explore --serve` and `--film`, and the log of the flight, as a user has them.
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <httplib.h>

#include <array>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "app/executable.hpp"
#include "app/explorations/quick_exploration.hpp"
#include "flightlog/flight_log.hpp"
#include "live/live_server.hpp"
#include "temporary_folder.hpp"

namespace photonav {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

const std::string kShortFlight = kQuickExploration + "--planner rrt_star ";

class ExploreWatch : public testing::Test {
  protected:
    std::string at(const std::string& name) const { return (folder_ / name).string(); }
    std::string commandFor(const std::string& name, const std::string& arguments) const {
        return fmt::format("explore {} {} {} --out {}", config("two_textures"), kShortFlight,
                           arguments, at(name));
    }
    Execution explore(const std::string& name, const std::string& arguments) const {
        return photonav(commandFor(name, arguments));
    }
    json read(const std::string& name) const {
        return json::parse(std::ifstream(folder_ / name), nullptr, false);
    }
    FlightLog log(const std::string& name) const {
        return flightLogFrom(read(name + "/flight.json"));
    }

    /// The log without the times that the machine took.
    json untimed(const std::string& name) const {
        json content = read(name + "/flight.json");
        for (json& moment : content["moments"]) {
            for (const char* key : {"fuse_s", "clearance_s", "views_s", "plan_s"}) {
                moment["update"].erase(key);
            }
        }
        return content;
    }

    test::TemporaryFolder temporary_;
    fs::path folder_ = temporary_.path();
};

TEST_F(ExploreWatch, TheLogHoldsTheFlight) {
    ASSERT_EQ(explore("a", "").exitCode, 0);
    const FlightLog log = this->log("a");
    const json result = read("a/result.json");
    ASSERT_EQ(log.moments.size(), result["updates"].size());
    EXPECT_EQ(log.end, "arrived");
    EXPECT_EQ(log.moments.back().update.time, result["updates"].back()["time"]);
    std::size_t flown = log.rest.size();
    for (const LoggedMoment& moment : log.moments) flown += moment.flown.size();
    EXPECT_GT(flown, 10U);
    // The robot flies a little after the last image.
    EXPECT_NEAR(log.rest.back().length, result["length"].get<double>(), 0.05);
    EXPECT_FALSE(log.moments.front().pictures.observed.empty());
    EXPECT_FALSE(log.moments.front().pictures.tree.empty());
    EXPECT_GT(log.moments.front().cells.greys.size(), 50U);
    EXPECT_EQ(read("a/report.json")["flight"]["moments"].size(), log.moments.size());
    EXPECT_LT(fs::file_size(folder_ / "a/flight.json"), 1U << 20U);
    for (const char* name : {"stages.png", "plans.png", "bands.png"}) {
        EXPECT_GT(fs::file_size(folder_ / "a" / name), 10000U) << name;
    }
}

TEST_F(ExploreWatch, AServedFlightIsTheSameToTheBit) {
    ASSERT_EQ(explore("alone", "").exitCode, 0);
    const std::string command =
        fmt::format("{} {} 2>&1", PHOTONAV_BINARY, commandFor("served", "--serve 0 --quiet"));
    FILE* run = popen(command.c_str(), "r");  // NOLINT(cert-env33-c)
    std::array<char, 256> line{};
    ASSERT_NE(std::fgets(line.data(), line.size(), run), nullptr);
    const std::string said = line.data();
    const std::string at = "photonav: watch the flight at http://127.0.0.1:";
    ASSERT_TRUE(said.starts_with(at)) << said;
    httplib::Client client("127.0.0.1", std::stoi(said.substr(at.size())));
    client.set_read_timeout(60);
    const auto page = client.Get("/");
    ASSERT_TRUE(page);
    EXPECT_NE(page->body.find("\"live\":true"), std::string::npos);
    std::string events;
    client.Get("/events", [&](const char* bytes, std::size_t count) {
        events.append(bytes, count);
        return true;
    });
    EXPECT_EQ(pclose(run), 0);
    const json served = untimed("served");
    EXPECT_EQ(served, untimed("alone"));
    for (const char* file : {"map.ot", "trajectory.tum", "trajectory.cov", "groundtruth.tum"}) {
        EXPECT_EQ(test::contentOf(folder_ / "served" / file),
                  test::contentOf(folder_ / "alone" / file))
            << file;
    }
    // The browser got what the log holds.
    std::size_t moments = 0;
    for (std::size_t i = 0; (i = events.find("event: moment", i)) != std::string::npos; ++i) {
        ++moments;
    }
    EXPECT_EQ(moments, served["moments"].size());
    EXPECT_NE(events.find("event: end"), std::string::npos);
    EXPECT_NE(events.find("\"arrived\""), std::string::npos);
}

TEST_F(ExploreWatch, CtrlCEndsTheServerWithABrowserThatListens) {
    const Execution run = interrupt(
        fmt::format("{} {} --serve 0", PHOTONAV_BINARY, commandFor("out", "--set goal=[2,9,2]")),
        fmt::format("[ -s {}.unfinished/trials.jsonl ]", at("out")));
    EXPECT_EQ(run.exitCode, 130) << run.output;
    EXPECT_EQ(log("out").end, "stopped");
    EXPECT_TRUE(fs::exists(folder_ / "out/report.html"));
}

TEST_F(ExploreWatch, RefusesAPortThatCannotBeUsed) {
    const LiveServer other({}, "page");
    const std::string url = other.url();
    const std::string port = url.substr(url.rfind(':') + 1, url.size() - url.rfind(':') - 2);
    const auto refuses = [&](const std::string& arguments, const std::string& reason) {
        const Execution run = explore("bad", arguments);
        EXPECT_EQ(run.exitCode, 2) << arguments;
        EXPECT_EQ(run.output, "photonav: --serve: " + reason + "\n");
        EXPECT_TRUE(fs::is_empty(folder_));
    };
    refuses("--serve " + port, fmt::format("127.0.0.1:{}: the port is in use", port));
    refuses("--serve 65536", "65536: the port is not between 0 and 65535");
    refuses("--serve=-1", "-1: the port is not between 0 and 65535");
    refuses("--serve lab:port", "lab:port: is not PORT, ADDRESS:PORT or [IPV6]:PORT");
}

TEST_F(ExploreWatch, TheLogOutlivesResumesAndMerges) {
    const std::string two = "--trials 2 --time-limit 2 ";
    ASSERT_EQ(explore("whole", two).exitCode, 1);
    const std::string kept = test::contentOf(folder_ / "whole/flight.json");
    ASSERT_EQ(explore("whole", "--trials 3 --time-limit 2 --resume --film").exitCode, 1);
    EXPECT_EQ(test::contentOf(folder_ / "whole/flight.json"), kept);
    // A film begins as every EBML file does, of which WebM is one.
    EXPECT_TRUE(test::contentOf(folder_ / "whole/film.webm").starts_with("\x1A\x45\xDF\xA3"));
    EXPECT_GT(fs::file_size(folder_ / "whole/film.webm"), 10000U);
    const Execution again = explore("whole", "--trials 3 --time-limit 2 --resume --serve 0");
    EXPECT_EQ(again.exitCode, 2);
    EXPECT_NE(again.output.find("--serve: the first flight has been flown"), std::string::npos);
    ASSERT_EQ(explore("1of2", two + "--shard 1/2").exitCode, 1);
    ASSERT_EQ(explore("2of2", two + "--shard 2/2").exitCode, 1);
    const std::string shards =
        fmt::format("explore --merge {} {} --out {}", at("2of2"), at("1of2"), at("merged"));
    ASSERT_EQ(photonav(shards).exitCode, 1);
    EXPECT_EQ(untimed("merged"), untimed("whole"));
    EXPECT_EQ(log("2of2").seed, 2U);
}

}  // namespace
}  // namespace photonav
