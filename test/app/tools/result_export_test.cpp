// SPDX-License-Identifier: BSD-3-Clause
#include "interchange/result_export.hpp"

#include <nlohmann/json.hpp>

#include "app/executable.hpp"
#include "bag/mcap_writer.hpp"
#include "dataset/trajectory.hpp"
#include "flight_dataset.hpp"

namespace photonav {
namespace {

using nlohmann::json;

/// {topic: [schema, messages, first time, last time]} of a file, read by an independent reader.
json topicsOf(const std::string& file) {
    const Execution reader = execute(
        fmt::format("python3 {}/test/scripts/mcap_reader.py {}", PHOTONAV_SOURCE_DIR, file));
    EXPECT_EQ(reader.exitCode, 0) << reader.output;
    return json::parse(reader.output, nullptr, false);
}

TEST(McapWriter, PutsMessagesInOrderAndChunks) {
    const test::TemporaryFolder folder;
    McapWriter writer;
    const std::string schema = R"({"type":"object","properties":{"x":{"type":"string"}}})";
    const auto a = writer.addChannel("/a", "X", schema), b = writer.addChannel("/b", "X", schema);
    for (const int i : {5, 3, 4, 0, 2, 1}) {  // 0.4 MB each: two or three a chunk
        writer.add(i % 2 == 0 ? a : b, 0.25 * i, json{{"x", std::string(400000, 'x')}}.dump());
    }
    const json topics = topicsOf(folder.write("a.mcap", writer.content()));
    EXPECT_EQ(topics, (json{{"/a", {"X", 3, 0., 1.}}, {"/b", {"X", 3, 0.25, 1.25}}}));
    EXPECT_EQ(topicsOf(folder.write("b.mcap", McapWriter().content())), json::object());
    try {
        writer.add(a, 1e308, "{}");
        ADD_FAILURE() << "a time of 1e308 s";
    } catch (const std::invalid_argument& error) {
        EXPECT_STREQ(error.what(), "/a: time 1e+308 s is not within 0 and 1e+10 s");
    }
    EXPECT_THROW(writer.add(a, -1., "{}"), std::invalid_argument);
}

TEST(ResultExport, OfAPlanHasItsSceneAndItsPathsInTime) {
    const test::TemporaryFolder folder;
    const std::string out = folder.file("plan");
    ASSERT_EQ(photonav("plan " + config("two_textures") +
                       " --set planner.vertices=60 --quiet --out " + out)
                  .exitCode,
              0);
    const Execution run = photonav("export " + out + "/");
    EXPECT_EQ(run.exitCode, 0) << run.output;
    EXPECT_NE(run.output.find("plan.mcap: "), std::string::npos) << run.output;
    const json topics = topicsOf(out + ".mcap");
    EXPECT_EQ(topics["/map"][0], "foxglove.PointCloud");
    EXPECT_EQ(topics["/path/belief_rrt_star"][0], "foxglove.SceneUpdate");
    const json poses = topics["/pose/rrt_star"];
    EXPECT_EQ(poses[0], "foxglove.PoseInFrame");
    EXPECT_EQ(topics["/belief/rrt_star"][1], poses[1]);
    const Trajectory path = readTrajectory(out + "/path.tum");
    EXPECT_EQ(topics["/pose/belief_rrt_star"][1], path.size());
}

TEST(ResultExport, OfAReplayKeepsTheTimesOfTheRecording) {
    const test::TemporaryFolder folder;
    test::FlightDataset flight;
    flight.frames = 4;
    flight.write(folder.path() / "flight");
    const std::string out = folder.file("replay");
    photonav("replay " + folder.file("flight") + " --odometry --quiet --out " + out);
    photonav("export " + out + " --quiet --out " + folder.file("a.mcap"));
    const json estimate = topicsOf(folder.file("a.mcap"))["/pose/estimate"];
    ASSERT_TRUE(estimate.is_array());
    EXPECT_EQ(estimate[1], 4);
    EXPECT_NEAR(estimate[2].get<double>(), test::FlightDataset::time(0), 1e-6);
    EXPECT_NEAR(estimate[3].get<double>(), test::FlightDataset::time(3), 1e-6);
}

TEST(ResultExport, OfWhatIsNoResultIsRefused) {
    const test::TemporaryFolder folder;
    Execution run = photonav("export " + folder.path().string());
    EXPECT_EQ(run.exitCode, 2);
    EXPECT_NE(run.output.find("not a result folder of photonav"), std::string::npos) << run.output;
    folder.write("report.json", R"({"schema": 1, "voxels": {"centers": "AAAA", "grey": "AAAA"},)"
                                R"("mesh": {}, "paths": []})");
    run = photonav("export " + folder.path().string());
    EXPECT_EQ(run.exitCode, 2);
    EXPECT_NE(run.output.find("report.json: "), std::string::npos) << run.output;
    EXPECT_FALSE(test::fs::exists(folder.path().string() + ".mcap"));
}

TEST(ResultExport, SurfacesThatWereCutAreRefused) {
    const test::TemporaryFolder folder;
    const std::string out = folder.file("info");
    photonav("info " + config("two_textures") + " --cells 2 --quiet --out " + out);
    const json whole = json::parse(test::contentOf(out + "/report.json"));
    const auto expectRefused = [&](const json& report, const std::string& reason) {
        folder.write("info/report.json", report.dump());
        const Execution run = photonav("export " + out);
        EXPECT_EQ(run.exitCode, 2);
        EXPECT_NE(run.output.find("report.json: " + reason), std::string::npos) << run.output;
    };
    json cut = whole;
    cut["mesh"]["uv"] = "";
    expectRefused(cut, "mesh: positions, uv and textures differ in number");
    cut = whole;
    cut["mesh"]["images"] = json::array();
    expectRefused(cut, "mesh: a triangle whose texture is not among the images");
}

TEST(ResultExport, ReplacesAnEarlierExportOnly) {
    const test::TemporaryFolder folder;
    const std::string out = folder.file("info");
    photonav("info " + config("two_textures") + " --cells 2 --quiet --out " + out);
    const std::string user = folder.write("notes.txt", "the user's");
    const std::string report = test::contentOf(out + "/report.json");
    const std::string recording = folder.write("recording.mcap", "\x89MCAP0\r\nof another program");
    for (const std::string& file : {user, recording, out + "/report.json", out + "/new.mcap"}) {
        const Execution run = photonav("export " + out + " --out " + file);
        EXPECT_EQ(run.exitCode, 2) << run.output;
        EXPECT_TRUE(run.output.starts_with("photonav: --out: " + file)) << run.output;
    }
    const Execution empty = photonav("export " + out + " --out ''");
    EXPECT_EQ(empty.exitCode, 2) << empty.output;
    EXPECT_EQ(empty.output.find("photonav: --out: must not be empty"), 0U) << empty.output;
    EXPECT_EQ(test::contentOf(user), "the user's");
    EXPECT_EQ(test::contentOf(out + "/report.json"), report);
    for (int i = 0; i < 2; ++i) EXPECT_EQ(photonav("export " + out).exitCode, 0);
}

}  // namespace
}  // namespace photonav
