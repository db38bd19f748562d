// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cstring>
#include <fstream>

#include "app/interchange/other_program.hpp"
#include "dataset/colmap_model.hpp"
#include "dataset/trajectory.hpp"
#include "flight_dataset.hpp"

namespace photonav {
namespace {

/// A flight that was tracked, and its result, which has a model of COLMAP.
class Colmap : public testing::Test {
  protected:
    void SetUp() override {
        if (!isInstalled("colmap")) GTEST_SKIP() << "colmap is not installed";
        flight.speed = 0.06;
        flight.write(data);
        folder.write("room.yaml", test::kScene);
        const Execution run = replay(data, model);
        ASSERT_EQ(run.exitCode, 0) << run.output;
    }
    Execution replay(const std::string& recording, const std::string& out) const {
        return photonav("replay " + recording + " --map " + folder.file("room.yaml") +
                        " --quiet --out " + out);
    }
    /// @param text "MODEL", "DATA" and "HERE" are replaced by the folders
    void colmap(std::string text) const {
        for (const auto& [word, value] :
             {std::pair{"MODEL", model}, {"DATA", data}, {"HERE", folder.path().string()}}) {
            for (std::size_t at; (at = text.find(word)) != std::string::npos;) {
                text.replace(at, std::strlen(word), value);
            }
        }
        const Execution run = otherProgram("colmap " + text);
        ASSERT_EQ(run.exitCode, 0) << text << '\n' << run.output;
    }

    test::TemporaryFolder folder;
    test::FlightDataset flight;
    std::string data = folder.file("flight"), model = folder.file("model");
};

/// The third coordinate of a model's points, sorted.
std::vector<double> heightsIn(const std::string& points) {
    std::vector<double> heights;
    std::ifstream file(points);
    for (std::string line; std::getline(file, line);) {
        if (line.starts_with('#')) continue;
        std::istringstream fields(line);
        double id = 0., x = 0., y = 0., z = 0.;
        if (fields >> id >> x >> y >> z) heights.push_back(z);
    }
    std::ranges::sort(heights);
    return heights;
}

/// As docs/how-to/other-programs.md has it: only with the right poses are the points on the floor.
TEST_F(Colmap, TriangulatesTheFloorWithOurPoses) {
    const std::string list =
        execute("grep '^[0-9]' " + model + "/images.txt | cut -d' ' -f10").output;
    EXPECT_EQ(std::ranges::count(list, '\n'), flight.frames) << list;
    folder.write("images.txt", list);
    test::fs::create_directory(folder.file("points"));
    const Camera& camera = flight.camera;
    colmap(
        fmt::format("feature_extractor --database_path HERE/a.db --image_path DATA "
                    "--image_list_path HERE/images.txt --SiftExtraction.use_gpu 0 "
                    "--SiftExtraction.num_threads 1 --ImageReader.single_camera 1 "
                    "--ImageReader.camera_model PINHOLE --ImageReader.camera_params "
                    "{0},{0},80,60",
                    camera.fx()));
    colmap(
        "sequential_matcher --database_path HERE/a.db --SequentialMatching.overlap 3 "
        "--SiftMatching.use_gpu 0 --SiftMatching.num_threads 2");
    colmap(
        "point_triangulator --database_path HERE/a.db --image_path DATA --input_path MODEL "
        "--output_path HERE/points");
    colmap("model_converter --input_path HERE/points --output_path HERE/points --output_type TXT");
    const std::vector<double> heights = heightsIn(folder.file("points/points3D.txt"));
    ASSERT_GT(heights.size(), 50U);
    EXPECT_NEAR(heights[heights.size() / 2], 0.01, 0.01);
    EXPECT_GT(heights[heights.size() / 10], -0.05);
    EXPECT_LT(heights[heights.size() * 9 / 10], 0.32);  // the crate
}

TEST_F(Colmap, WritesModelsThatAreReplayed) {
    colmap("image_undistorter --image_path DATA --input_path MODEL --output_path HERE/room");
    colmap(
        "model_converter --input_path HERE/room/sparse --output_path HERE/room/sparse "
        "--output_type TXT");
    const Sequence ours = readColmapSequence(model);
    const Sequence theirs = readColmapSequence(folder.file("room"));
    ASSERT_EQ(theirs.frames.size(), std::size_t(flight.frames));
    EXPECT_NEAR(theirs.camera.cx(), ours.camera.cx(), 1e-6);
    for (int i = 0; i < flight.frames; ++i) {
        EXPECT_TRUE(theirs.frames[i].T_c_w.isApprox(ours.frames[i].T_c_w, 1e-6));
    }
    const Execution run = replay(folder.file("room"), folder.file("out"));
    ASSERT_EQ(run.exitCode, 0) << run.output;
    const Trajectory found = readTrajectory(folder.file("out/trajectory.tum"));
    ASSERT_EQ(found.size(), std::size_t(flight.frames));
    for (int i = 0; i < flight.frames; ++i) {
        EXPECT_LT((found[i].T_w_c.translation() - flight.T_w_c(i).translation()).norm(), 0.005);
    }
}

}  // namespace
}  // namespace photonav
