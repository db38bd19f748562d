// SPDX-License-Identifier: BSD-3-Clause
#include "recordings/map_command.hpp"

#include <octomap/ColorOcTree.h>
#include <octomap/OcTree.h>

#include "app/executable.hpp"
#include "dataset/trajectory.hpp"
#include "depth/stereo_depth.hpp"
#include "euroc_dataset.hpp"
#include "map/octree_file.hpp"
#include "mapping/map_config.hpp"
#include "tum_dataset.hpp"

namespace photonav {
namespace {

using test::expectInputError;
using test::writeText;

class MapCommand : public testing::Test {
  protected:
    MapCommand() {
        dataset.write(data);
        options.dataset = data.string();
        options.out = folder.path() / "out";
        options.compareEvery = 2;
    }

    /// Expects an InputError, and (but for a folder that cannot be written) nothing in the results.
    void expectRejected(const std::vector<std::string>& parts) const {
        expectInputError([&] { runMap(options, running); }, parts);
        EXPECT_FALSE(test::fs::exists(options.out));
    }

    test::TemporaryFolder folder;
    test::fs::path data = folder.path() / "data";
    test::FloorDataset dataset;
    MapCommandOptions options;
    std::atomic<bool> running{false};
};

TEST_F(MapCommand, MapsATexturedFloorAndPredictsItsImages) {
    std::size_t calls = 0;
    options.progress = [&](std::size_t done, std::size_t total) {
        EXPECT_EQ(done, ++calls);
        EXPECT_EQ(total, 6U);
    };
    std::vector<std::size_t> compared;
    options.comparison = [&](std::size_t done, std::size_t total) {
        compared.push_back(done);
        EXPECT_EQ(total, 3U);
    };
    const CommandReport report = runMap(options, running);
    EXPECT_EQ(report.exitCode, 0);
    EXPECT_EQ(calls, 6U);
    EXPECT_EQ(compared, (std::vector<std::size_t>{0, 1, 2}));
    const auto& result = report.result;
    EXPECT_EQ(result["command"], "map");
    EXPECT_EQ(result["frames"]["used"], 6);
    // 2 m x 1.5 m in view and 0.5 m of motion, cells of 5 cm
    EXPECT_NEAR(result["voxels"]["occupied"].get<double>(), 2.5 * 1.5 / 0.0025, 150.);
    EXPECT_GT(result["voxels"]["free"].get<double>(), 5000.);
    const auto& mean = result["comparison"]["mean"];
    EXPECT_EQ(result["comparison"]["frames"].size(), 3U);
    EXPECT_GT(mean["predicted"].get<double>(), 0.9);
    EXPECT_LT(mean["mean_abs_intensity"].get<double>(), 0.03);
    EXPECT_GT(mean["contrast"].get<double>(), 4. * mean["mean_abs_intensity"].get<double>());
    EXPECT_LT(mean["mean_abs_depth"].get<double>(), 0.05);
}

TEST_F(MapCommand, WritesWhatOtherProgramsRead) {
    const CommandReport report = runMap(options, running);
    for (const char* name : {"comparison_0.png", "comparison_2.png", "report.html"}) {
        EXPECT_TRUE(test::fs::exists(options.out / name)) << name;
    }
    const auto file = [&](const char* name) { return (options.out / name).string(); };
    EXPECT_GT(loadTexturedOcTree(file("map.ot"))->size(), 1000U);
    const std::unique_ptr<octomap::AbstractOcTree> colour(
        octomap::AbstractOcTree::read(file("map_color.ot")));
    EXPECT_NE(dynamic_cast<octomap::ColorOcTree*>(colour.get()), nullptr);
    EXPECT_GT(octomap::OcTree(file("map.bt")).size(), 1000U);
    const Trajectory trajectory = readTrajectory(file("trajectory.tum"));
    ASSERT_EQ(trajectory.size(), 6U);
    EXPECT_TRUE(trajectory[2].T_w_c.isApprox(dataset.T_w_c(2), 1e-5));
    EXPECT_EQ(nlohmann::json::parse(test::contentOf(file("result.json"))), report.result);
    const auto page = nlohmann::json::parse(test::contentOf(file("report.json")));
    ASSERT_EQ(page["frames"].size(), 3U);
    EXPECT_EQ(page["frames"][1]["believed"]["position"], page["paths"][0]["points"][2]["position"]);
    EXPECT_TRUE(page["figures"].empty());  // the pictures are shown once

    writeText(data / "groundtruth.txt",
              "100 0 5e6 1.5 1 0 0 0\n");  // refused: all is left as it is
    expectInputError([&] { runMap(options, running); }, {"groundtruth.txt"});
    EXPECT_TRUE(test::fs::exists(options.out / "comparison_0.png"));
}

TEST_F(MapCommand, TurnsTheRecordedWorldUpright) {
    options.up = "-y";  // the recorded floor becomes a wall
    const CommandReport report = runMap(options, running);
    const auto& bounds = report.result["voxels"]["bounds"];
    EXPECT_LE(bounds[1][0].get<double>() - bounds[0][0].get<double>(), 0.1 + 1e-9);
    EXPECT_GT(bounds[1][1].get<double>() - bounds[0][1].get<double>(), 1.5);
    EXPECT_LT(report.result["comparison"]["mean"]["mean_abs_intensity"].get<double>(), 0.03);
    EXPECT_EQ(report.result["dataset"]["up"], "-y");
}

TEST_F(MapCommand, LevelsATiltedWorldByItsFloor) {
    dataset.pitch = 0.8;
    dataset.tilt = Eigen::AngleAxisd(0.35, Eigen::Vector3d(1., 2., 0.).normalized());
    dataset.write(data);
    options.up = "floor";
    const CommandReport report = runMap(options, running);
    const auto& bounds = report.result["voxels"]["bounds"];
    EXPECT_LE(bounds[1][2].get<double>() - bounds[0][2].get<double>(), 0.1 + 1e-9);
    EXPECT_NEAR(report.result["dataset"]["tilt_degrees"].get<double>(), 20.05, 0.1);
    EXPECT_LT(report.result["comparison"]["mean"]["mean_abs_intensity"].get<double>(), 0.03);
    const Eigen::Vector3d up = dataset.tilt * Eigen::Vector3d::UnitZ();
    options.up = fmt::format("{},{},{}", up.x(), up.y(), up.z());
    EXPECT_NEAR(runMap(options, running).result["dataset"]["tilt_degrees"].get<double>(), 20.05,
                0.01);
}

TEST_F(MapCommand, ItsConfigMakesTheSameMapAgain) {
    options.up = "-y";
    options.every = 2;
    options.resolution = 0.1;
    const CommandReport first = runMap(options, running);
    const auto config = (options.out / "config.yaml").string();
    EXPECT_TRUE(isMapConfig(config));
    MapCommandOptions again;
    again.compareEvery = 2;
    again.out = folder.path() / "again";
    readMapConfig(config, again);
    const CommandReport second = runMap(again, running);
    for (const char* key : {"dataset", "frames", "voxels", "comparison", "resolution"}) {
        EXPECT_EQ(first.result[key], second.result[key]) << key;
    }
    writeText(config, "dataset: here\nupp: z\n");
    expectInputError([&] { readMapConfig(config, again); }, {"config.yaml", "upp", "'up'"});
}

TEST_F(MapCommand, UsesEveryNthFrameAndListsTheSkipped) {
    options.every = 3;
    std::ofstream(data / "rgb.txt", std::ios::app) << "900 rgb/0.png\n";
    const CommandReport report = runMap(options, running);
    EXPECT_EQ(report.result["frames"]["recorded"], 7);
    EXPECT_EQ(report.result["frames"]["used"], 2);
    ASSERT_EQ(report.result["frames"]["skipped"].size(), 1U);
    EXPECT_EQ(report.result["frames"]["skipped"][0]["reason"], "no depth image within 0.02 s");
}

TEST_F(MapCommand, InterruptedItKeepsWhatItHas) {
    options.progress = [&](std::size_t done, std::size_t) { running = done == 2; };
    const CommandReport report = runMap(options, running);
    EXPECT_EQ(report.exitCode, 130);
    EXPECT_TRUE(report.result["interrupted"].get<bool>());
    EXPECT_EQ(report.result["frames"]["used"], 2);
    EXPECT_EQ(readTrajectory((options.out / "trajectory.tum").string()).size(), 2U);
    EXPECT_GT(loadTexturedOcTree((options.out / "map.ot").string())->size(), 100U);
}

TEST_F(MapCommand, InterruptedBeforeTheFirstFrameItStillEndsInOrder) {
    running = true;
    const CommandReport report = runMap(options, running);
    EXPECT_EQ(report.exitCode, 130);
    EXPECT_EQ(report.result["frames"]["used"], 0);
    EXPECT_TRUE(test::fs::exists(options.out / "result.json"));
}

TEST_F(MapCommand, RejectsOptionsOutOfRange) {
    const auto rejected = [&](auto change, const std::vector<std::string>& parts) {
        const MapCommandOptions good = options;
        change();
        expectRejected(parts);
        options = good;
    };
    rejected([&] { options.resolution = 0.; }, {"--resolution", "not a positive"});
    rejected([&] { options.resolution = std::nan(""); }, {"--resolution"});
    rejected([&] { options.every = 0; }, {"--every", "at least 1"});
    rejected([&] { options.up = "w"; }, {"--up", "'w'", "-y"});
    rejected([&] { options.up = "0,0,0"; }, {"--up", "'0,0,0'"});
    rejected([&] { options.up = "0,1"; }, {"--up", "'0,1'"});
    rejected([&] { options.fusion.maxRange = -1.; }, {"--max-range"});
    rejected([&] { options.fusion.maxRange = 0.1; }, {"--max-range", "least range"});
    rejected([&] { options.depthScale = 0.; }, {"--depth-scale"});
    rejected([&] { options.resolution = 1e-5; }, {"--resolution", "too large"});
    rejected(
        [&] {
            options.depth = "monocular";
            options.fusion.minRange = 0.;
        },
        {"--min-range", "0.05 m"});
}

TEST_F(MapCommand, RejectsAFolderItCannotWriteBeforeTheWork) {
    writeText(folder.path() / "file", "");
    options.out = folder.path() / "file" / "out";
    options.progress = [](std::size_t, std::size_t) { ADD_FAILURE() << "work was done"; };
    expectRejected({"file/out", "cannot be"});
    options.out = "/proc/photonav";
    expectRejected({"/proc/photonav", "cannot be"});
}

TEST_F(MapCommand, WithoutDepthImages) {
    test::fs::remove_all(data / "depth");
    test::fs::remove(data / "depth.txt");
    expectRejected({"depth.txt: no such file", "map --depth monocular"});
    options.depth = "monocular";
    const CommandReport report = runMap(options, running);
    EXPECT_EQ(report.result["frames"]["used"], 6);
    const auto& depth = report.result["monocular"];
    EXPECT_GE(depth["references"], 1);
    EXPECT_TRUE(depth["converged"].is_number());
    EXPECT_TRUE(depth["completeness"].is_null());
    EXPECT_EQ(report.exitCode, 1);  // a floor that is smooth
    EXPECT_EQ(
        report.summary.rows[0].second,
        "the map is empty: the camera moves too little to measure depth, or there is no texture");
    EXPECT_TRUE(report.result["comparison"]["frames"][0]["mean_abs_depth"].is_null());
    EXPECT_TRUE(report.result["comparison"]["frames"][0]["mean_abs_intensity"].is_null());
    EXPECT_FALSE(report.result["comparison"]["mean"].contains("mean_abs_depth"));
    EXPECT_TRUE(test::fs::exists(options.out / "convergence.png"));
    MapCommandOptions again;
    readMapConfig((options.out / "config.yaml").string(), again);
    again.out = options.out;
    again.compareEvery = 0;
    EXPECT_EQ(runMap(again, running).result["voxels"], report.result["voxels"]);
    EXPECT_FALSE(test::fs::exists(options.out / "comparison_0.png"));
}

TEST_F(MapCommand, DepthOfOneImageCannotBeHad) {
    options.depth = "monocular";
    options.frames = ":1";
    const CommandReport report = runMap(options, running);
    EXPECT_EQ(report.exitCode, 1);
    EXPECT_EQ(report.summary.rows[0].second,
              "the map is empty: depth is measured from image to image, and there is only one");
}

TEST_F(MapCommand, BlackImagesAreNotCompared) {
    const auto blacken = [&](int i) {
        cv::imwrite((data / fmt::format("rgb/{}.png", i)).string(),
                    cv::Mat(60, 80, CV_8UC1, cv::Scalar(0)));
    };
    const auto full = runMap(options, running).result;
    blacken(2);
    const CommandReport some = runMap(options, running);
    EXPECT_EQ(some.result["frames"]["used"], 5);
    EXPECT_EQ(some.result["frames"]["black"], 1);
    EXPECT_EQ(some.result["frames"]["skipped"][0]["reason"], "black");
    EXPECT_EQ(some.result["comparison"]["frames"].size(), 2U);
    EXPECT_NEAR(some.result["comparison"]["mean"]["mean_abs_intensity"].get<double>(),
                full["comparison"]["mean"]["mean_abs_intensity"].get<double>(), 0.01);
    for (int i = 0; i < dataset.frames; ++i) blacken(i);
    const CommandReport none = runMap(options, running);
    EXPECT_EQ(none.exitCode, 1);
    EXPECT_EQ(none.summary.rows[0].second, "the map is empty: all images are black");
}

TEST_F(MapCommand, InfoSaysWhatAMapHolds) {
    const auto voxels = runMap(options, running).result["voxels"];
    const auto map = (options.out / "map.ot").string();
    const auto out = (folder.path() / "info").string();
    const Execution good = photonav(fmt::format("info {} --json --out {}", map, out));
    ASSERT_EQ(good.exitCode, 0) << good.output;
    const auto result = nlohmann::json::parse(good.output);
    EXPECT_EQ(result["voxels"], voxels);
    EXPECT_EQ(result["resolution"], 0.05);
    EXPECT_GT(result["textured"].get<double>(), 0.9);
    EXPECT_TRUE(test::fs::exists(folder.path() / "info/overview.png"));
    const auto expectRefused = [](const std::string& arguments, const std::string& reason) {
        const Execution run = photonav(arguments);
        EXPECT_EQ(run.exitCode, 2);
        EXPECT_NE(run.output.find(reason), std::string::npos) << run.output;
    };
    expectRefused("info " + map + " --at 1,2,3", "--at: is for a planning problem");
    expectRefused("plan " + map, "map.ot: is a map, not a planning problem");
    expectRefused("plan " + (options.out / "config.yaml").string(), "dataset: this is the config");
}

TEST_F(MapCommand, MapsWhatTwoCamerasSee) {
    const test::WallDataset wall{.width = 320, .height = 240, .frames = 6};
    const auto mav = folder.path() / "mav";
    wall.write(mav);
    options.dataset = mav.string();
    const auto result = runMap(options, running).result;
    EXPECT_EQ(result["dataset"]["layout"], "EuRoC");
    EXPECT_EQ(result["frames"]["used"], 6);
    EXPECT_TRUE(result["dataset"]["depth_scale"].is_null());
    EXPECT_GT(result["voxels"]["occupied"].get<int>(), 200);
    EXPECT_LT(result["comparison"]["mean"]["mean_abs_depth"].get<double>(), 0.06);
    // The wall is where it is in the world, and not where the cameras are.
    const auto bounds = result["voxels"]["bounds"];
    EXPECT_NEAR(0.5 * (bounds[0][0].get<double>() + bounds[1][0].get<double>()), 2., 0.15);
    // Poses are those of the rectified left camera.
    const StereoDepth stereo(wall.camera(0), wall.camera(1), {});
    const Pose T_w_left = wall.T_w_b(2) * wall.camera(0).T_b_c;
    const Trajectory trajectory = readTrajectory((options.out / "trajectory.tum").string());
    EXPECT_TRUE(trajectory[2].T_w_c.isApprox(T_w_left * stereo.T_r_c().inverse(), 1e-6));
    MapCommandOptions again;
    readMapConfig((options.out / "config.yaml").string(), again);
    EXPECT_EQ(again.stereo, "bm");
    options.stereo = "xy";
    expectInputError([&] { runMap(options, running); }, {"--stereo", "'xy'"});
    options.stereo.clear();
    options.cameraFile = "camera.yaml";
    expectInputError([&] { runMap(options, running); }, {"--camera", "EuRoC"});
    options.cameraFile.clear();
    test::fs::remove_all(mav / "mav0/state_groundtruth_estimate0");
    expectInputError([&] { runMap(options, running); }, {"mav", "no poses"});
}

TEST_F(MapCommand, RejectsDamagedDatasets) {
    options.dataset = (folder.path() / "nothing").string();
    expectRejected({"nothing", "no such folder"});
    options.dataset = data.string();
    cv::imwrite((data / "depth/3.png").string(), cv::Mat(30, 40, CV_16UC1, cv::Scalar(1)));
    expectRejected({"depth/3.png", "40x30", "80x60"});
    test::fs::resize_file(data / "rgb/2.png", 100);
    expectRejected({"rgb/2.png", "damaged"});
    std::ofstream(data / "camera.yaml", std::ios::app) << "fxx: 1\n";
    expectRejected({"camera.yaml", "fxx"});
    test::fs::remove(data / "camera.yaml");
    writeText(data / "groundtruth.txt", "100 0 0 nan 0 0 0 1\n");
    expectRejected({"groundtruth.txt", "line 1", "not a finite number"});
}

TEST_F(MapCommand, NoticesADepthScaleThatIsWrongByAThousand) {
    options.depthScale = 5.;
    expectRejected({"--depth-scale", "implausible depths", "too small"});
    options.depthScale = 5e6;
    expectRejected({"--depth-scale", "implausible depths", "too large"});
    options.depth = "monocular";
    expectRejected({"--depth-scale", "implausible depths", "too large"});
}

/// It is not the cells that are too small.
TEST_F(MapCommand, NamesThePoseThatIsTooFarAway) {
    writeText(data / "groundtruth.txt", "100 0 5e6 1.5 1 0 0 0\n");
    expectRejected({"groundtruth.txt", "100.000000 s", "5e+06 m from the origin", "1638.4 m"});
}

}  // namespace
}  // namespace photonav
