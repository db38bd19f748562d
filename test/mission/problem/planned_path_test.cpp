// SPDX-License-Identifier: BSD-3-Clause
#include "problem/planned_path.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "reason_of.hpp"
#include "temporary_folder.hpp"

namespace photonav {
namespace {

class PlannedPathTest : public testing::Test {
  protected:
    PlannedPathTest() {
        config_.start.position = {1., 2., 2.};
        config_.goal.position = {3., 4., 2.};
    }
    PlannedPath read(const std::string& result) const {
        return readPlannedPath(folder_.write("result.json", result), config_);
    }
    /// @param points "x, y, z; yaw" of each waypoint
    PlannedPath readPoints(const std::vector<std::pair<std::string, std::string>>& points) const {
        std::string path;
        for (const auto& [position, yaw] : points) {
            path += fmt::format("{}{{\"waypoint\": true, \"position\": [{}], \"yaw\": {}}}",
                                path.empty() ? "" : ", ", position, yaw);
        }
        return read(
            fmt::format("{{\"command\": \"plan\", \"planner\": \"rrbt\", \"path\": [{}]}}", path));
    }
    void expectReason(const std::function<void()>& read, const std::string& reason) const {
        const std::string said = test::reasonOf(read);
        EXPECT_NE(said.find("result.json: " + reason), std::string::npos) << said;
    }

    test::TemporaryFolder folder_;
    Config config_ = loadConfig(PHOTONAV_SOURCE_DIR "/config/two_textures.yaml", {});
};

TEST_F(PlannedPathTest, HasItsWaypoints) {
    const PlannedPath path = readPoints({{"1, 2, 2", "0"}, {"3, 4, 2", "0.5"}});
    EXPECT_EQ(path.planner, "rrbt");
    ASSERT_EQ(path.waypoints.size(), 2U);
    EXPECT_EQ(path.waypoints[1].position, Eigen::Vector3d(3., 4., 2.));
    EXPECT_EQ(path.waypoints[1].yaw, 0.5);
}

TEST_F(PlannedPathTest, StaysWithinTheBoundsOfItsConfig) {
    for (const char* far : {"1e6, 2, 2", "1e300, 2, 2", "1, 2, 2.1"}) {
        expectReason([&] { readPoints({{"1, 2, 2", "0"}, {far, "0"}}); }, "path: (");
    }
    expectReason(
        [&] {
            readPoints({{"1, 2, 2", "0"}, {"3, 4, 2", "1e9"}});
        },
        "path: a heading of 1000000000 rad");
}

TEST_F(PlannedPathTest, HasNoMoreStepsThanAFlight) {
    config_.belief.ds = 1e-5;
    expectReason(
        [&] {
            readPoints({{"1, 2, 2", "0"}, {"3, 2, 2", "0"}});
        },
        "path: 2e+05 steps of planner.ds");
}

/// `fly PLAN --set goal=...` would report its arrival at another goal.
TEST_F(PlannedPathTest, LeadsFromTheStartToTheGoalOfItsConfig) {
    expectReason(
        [&] {
            readPoints({{"3, 4, 2", "0"}, {"1, 2, 2", "0"}});
        },
        "path: begins at (3, 4, 2), but the start of the config is (1, 2, 2)");
    expectReason(
        [&] {
            readPoints({{"1, 2, 2", "0"}, {"3, 3.9, 2", "0"}});
        },
        "path: ends at (3, 3.9, 2), but the goal of the config is (3, 4, 2)");
}

TEST_F(PlannedPathTest, OtherFilesAreRefused) {
    expectReason([&] { read("[]"); }, "not a JSON object");
    expectReason([&] { read(R"({"command": "fly"})"); }, "command: not a result of photonav plan");
    expectReason([&] { read(R"({"command": 3})"); }, "command: not a result of photonav plan");
    expectReason([&] { read(R"({"command": "plan", "path": 1})"); }, "path: not as");
    expectReason([&] { read(R"({"command": "plan", "path": []})"); }, "path: no path was found");
}

}  // namespace
}  // namespace photonav
