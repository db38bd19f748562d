// SPDX-License-Identifier: BSD-3-Clause
// The first flight of an exploration on the disk, while it is flown and after a kill.
#include "explorations/flight_store.hpp"

#include <gtest/gtest.h>

#include <chrono>
#include <fstream>
#include <sstream>
#include <thread>

#include "app/executable.hpp"
#include "app/explorations/quick_exploration.hpp"
#include "flightlog/flight_logger.hpp"
#include "geometry/constants.hpp"
#include "io/error.hpp"
#include "map/octree_file.hpp"
#include "mission/exploration/room_to_explore.hpp"
#include "temporary_folder.hpp"

namespace photonav {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

/// A program that is killed is an exception here.
struct Killed {};

class FlightStoreTest : public testing::Test {
  protected:
    FlightStoreTest() { config.goal.position.x() = 3.; }

    /// Flies until so many updates are done.
    void fly(std::uint32_t seed, std::size_t updates) {
        const World world(test::roomToExplore(), config);
        const PlanningProblem problem(config, world);
        FlightLogger logger(config, world, {config.planner, seed});
        FlightStore store(folder.path(), {"the flight", "", {}, {}},
                          [](const FlightLog& log) { return std::to_string(log.moments.size()); });
        const auto onMoment = [&](const ExplorationMoment& moment) {
            logger.add(moment);
            store.add(moment, logger.log());
            map = moment.map.cells()->size();
            if (logger.log().moments.size() == updates) throw Killed();
        };
        EXPECT_THROW(explore(setUpExploration(problem), config.planner, seed, kNotInterrupted,
                             {.moment = onMoment}),
                     Killed);
    }

    std::vector<std::string> lines() const {
        std::istringstream content(test::contentOf(folder.path() / "flight.jsonl"));
        std::vector<std::string> found;
        for (std::string line; std::getline(content, line);) found.push_back(line);
        return found;
    }

    Config config = test::flightThroughRoom();
    test::TemporaryFolder folder;
    std::size_t map = 0;  // cells after the last update
};

TEST_F(FlightStoreTest, HoldsTheFlightUntilTheLastKeyframe) {
    fly(1, 1);
    EXPECT_EQ(loadTexturedOcTree(folder.file("map.ot"))->size(), map);
    EXPECT_EQ(test::contentOf(folder.path() / "report.html"), "1");
    fly(1, 4);
    ASSERT_EQ(lines().size(), 1U + 4U);
    for (std::size_t i = 1; i < 5; ++i) {
        const json moment = json::parse(lines()[i]);
        EXPECT_FALSE(moment.at("tree").empty());
        EXPECT_FALSE(moment.at("cells").empty());
        EXPECT_GT(moment.at("update").at("length"), 0.);
    }
    EXPECT_EQ(storedFlight(folder.path()).keyframes, 4U);
}

/// The next program is killed as well, before it is where the first one was, and the last of all
/// goes on. The first one was killed within a line.
TEST_F(FlightStoreTest, AFlightThatIsFlownAgainLosesNothingThatIsStored) {
    fly(1, 3);
    const std::vector<std::string> first = lines();
    std::ofstream(folder.file("flight.jsonl"), std::ios::app) << R"({"update": {"ti)";
    fly(1, 2);
    EXPECT_EQ(storedFlight(folder.path()).keyframes, 3U);
    fly(1, 5);
    ASSERT_EQ(lines().size(), 1U + 5U);
    for (std::size_t i = 0; i < first.size(); ++i) EXPECT_EQ(lines()[i], first[i]);
}

TEST_F(FlightStoreTest, AnotherFlightReplacesTheStoredOne) {
    fly(1, 3);
    const std::vector<std::string> first = lines();
    testing::internal::CaptureStderr();
    fly(2, 2);
    EXPECT_NE(testing::internal::GetCapturedStderr().find("not the flight that was killed"),
              std::string::npos);
    ASSERT_EQ(lines().size(), 1U + 2U);
    EXPECT_NE(json::parse(lines()[2])["flown"], json::parse(first[2])["flown"]);
}

TEST(LimitedShareTest, LeavesOutWhatTakesTooLong) {
    LimitedShare never(0.), always(kInfinity);
    int first = 0, all = 0;
    for (int i = 0; i < 5; ++i) {
        never.call([&] {
            ++first;
            std::this_thread::sleep_for(std::chrono::milliseconds(1));
        });
        always.call([&] { ++all; });
    }
    EXPECT_EQ(first, 1);
    EXPECT_EQ(all, 5);
}

/// `photonav explore`, killed while its only flight is flown.
TEST(KilledExploration, IsFlownAgainToTheSameResult) {
    const test::TemporaryFolder folder;
    const auto command = [&](const std::string& name, const std::string& more) {
        return fmt::format(
            "{} explore {} {} --set goal=[2,9,2] --planners rrt_star --quiet --out {} {}",
            PHOTONAV_BINARY, config("two_textures"), kQuickExploration, folder.file(name), more);
    };
    const Execution whole = execute(command("whole", ""));
    ASSERT_LT(whole.exitCode, 2) << whole.output;
    const Execution killed =
        interrupt(command("out", ""),
                  fmt::format("[ $(cat {}.unfinished/flight.jsonl 2>/dev/null | wc -l) -gt 3 ]",
                              folder.file("out")),
                  0., "KILL");
    const fs::path left = folder.path() / "out.unfinished";
    ASSERT_FALSE(fs::exists(folder.path() / "out")) << killed.output;
    EXPECT_GE(storedFlight(left).keyframes, 3U);
    EXPECT_GT(loadTexturedOcTree(left / "map.ot")->size(), 10U);
    EXPECT_NE(test::contentOf(left / "report.html").find("as far as it was flown"),
              std::string::npos);
    std::ofstream(left / "map.ot.tmp-1-2-3") << "half a ma";
    expectBadInput(execute(command("out", "")), "of a flight that was killed: go on with --resume");
    expectBadInput(execute(command("out", "--resume --seed 7")),
                   "of a flight that was killed, rrt_star seed 1: go on with");
    const Execution resumed = execute(command("out", "--resume"));
    EXPECT_EQ(resumed.exitCode, whole.exitCode) << resumed.output;
    for (const char* file : {"map.ot", "trajectory.tum", "trajectory.cov", "groundtruth.tum"}) {
        EXPECT_TRUE(test::contentOf(folder.path() / "out" / file) ==
                    test::contentOf(folder.path() / "whole" / file))
            << file;
    }
    for (const char* file : {"flight.jsonl", "map.ot.tmp-1-2-3"}) {
        EXPECT_FALSE(fs::exists(folder.path() / "out" / file)) << file;
    }
}

}  // namespace
}  // namespace photonav
