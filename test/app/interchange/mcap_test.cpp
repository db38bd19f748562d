// SPDX-License-Identifier: BSD-3-Clause
#include <nlohmann/json.hpp>

#include "app/interchange/other_program.hpp"
#include "dataset/trajectory.hpp"
#include "temporary_folder.hpp"

namespace photonav {
namespace {

using nlohmann::json;

Eigen::Vector3d positionIn(const json& message) {
    const json& p = message["pose"]["position"];
    return {p["x"].get<double>(), p["y"].get<double>(), p["z"].get<double>()};
}

/// @mcap/core comes from npm: NODE_PATH names the folder with it.
TEST(FoxglovesReader, FindsTheMessagesOfAPlan) {
    if (execute("node -e 'require(\"@mcap/core\")'").exitCode != 0) {
        GTEST_SKIP() << "node with @mcap/core is not installed (npm install @mcap/core; "
                        "NODE_PATH=$PWD/node_modules)";
    }
    const test::TemporaryFolder folder;
    const std::string out = folder.file("plan");
    photonav("plan " + config("two_textures") + " --set planner.vertices=60 --quiet --out " + out);
    ASSERT_EQ(photonav("export " + out).exitCode, 0);
    const std::string scripts = std::string(PHOTONAV_SOURCE_DIR) + "/test/scripts/";
    const Execution run = execute("node " + scripts + "mcap_messages.js " + out + ".mcap");
    ASSERT_EQ(run.exitCode, 0) << run.output;
    json topics = json::parse(run.output);
    const Trajectory path = readTrajectory(out + "/path.tum");
    const json& poses = topics["/pose/belief_rrt_star"];
    ASSERT_EQ(poses[1], path.size());
    const std::array ends{path.front(), path.back()};
    for (std::size_t i = 0; i < 2; ++i) {
        EXPECT_NEAR(poses[2 + i].get<double>(), ends[i].timestamp, 1e-6);
        EXPECT_TRUE(positionIn(poses[4][i]).isApprox(ends[i].T_w_c.translation(), 1e-6));
    }
    // And what our reader finds, which follows the specification.
    for (json& topic : topics) topic.erase(4);
    const Execution ours = execute("python3 " + scripts + "mcap_reader.py " + out + ".mcap");
    EXPECT_EQ(topics, json::parse(ours.output, nullptr, false)) << ours.output;
}

}  // namespace
}  // namespace photonav
