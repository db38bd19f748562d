// SPDX-License-Identifier: BSD-3-Clause
// Replays in a map: a scene, or what a recording was fused into.
#include <fmt/format.h>

#include "map/octree_file.hpp"
#include "mapping/recording_map.hpp"
#include "mission/replay/replay_fixture.hpp"
#include "render/area_sensor.hpp"
#include "replay/blur_estimate.hpp"

namespace photonav {
namespace {

using nlohmann::json;
using test::expectInputError;
using test::FlightDataset;
using test::kScene;
using test::ReplayFixture;
using test::writeText;
namespace fs = std::filesystem;

class ReplayInMap : public ReplayFixture {
  protected:
    /// Localises in the map of a recording.
    FusedRecording useMapOf(const MapOptions& mapOptions) {
        TexturedOcTree map(mapOptions.resolution);
        const FusedRecording fused = fuseRecording(map, openForMap(mapOptions), mapOptions);
        options.odometry = false;
        options.mapFile = (folder.path() / "map.ot").string();
        saveTexturedOcTree(map, options.mapFile);
        return fused;
    }
};

TEST_F(ReplayInMap, LocalisesInAScene) {
    useMap();
    const json result = run();
    EXPECT_FALSE(isLostForGood(replayed));
    EXPECT_EQ(result["tracked"], 12);
    EXPECT_EQ(result["ate_alignment"], "none");
    EXPECT_LT(result["ate_rmse_m"].get<double>(), 2e-3);
}

/// The images of the flight are rendered, and so blurrier than those of a sensor in focus.
TEST_F(ReplayInMap, InAMeshShowsThePointSpreadOfTheImages) {
    useMap();
    run();
    const auto blur = estimateBlur(replayed);
    ASSERT_TRUE(blur);
    EXPECT_NEAR(blur->variance, kRenderedBlur * kRenderedBlur, 2. * blur->sigma);
    EXPECT_TRUE(blur->contradicts(kAreaBlur)) << blur->blur;
    EXPECT_FALSE(blur->contradicts(kRenderedBlur)) << blur->blur;
    replayed.frames.resize(4);
    EXPECT_FALSE(estimateBlur(replayed)) << "too few images";
}

TEST_F(ReplayInMap, LocalisesInTheMapOfItsOwnFirstHalf) {
    MapOptions map;
    map.dataset = data.string();
    map.resolution = 0.025;
    map.frames = ":6";
    EXPECT_EQ(useMapOf(map).frames, 6U);
    options.frames = "4:10";
    const json result = run();
    EXPECT_FALSE(isLostForGood(replayed));
    EXPECT_EQ(result["frames"], 6);
    EXPECT_EQ(result["tracked"], 6);
    EXPECT_LT(result["ate_rmse_m"].get<double>(), 0.02);
}

/// The farther an image was taken from those that the map was made of, the more does depth that
/// does not fit its images displace what it shows.
TEST_F(ReplayInMap, DepthErrorsOfTheSensorAreInTheMap) {
    MapOptions map;
    map.dataset = data.string();
    map.resolution = 0.025;
    map.frames = ":6";
    const Trajectory makers = useMapOf(map).trajectory;
    const std::string beside = (folder.path() / "trajectory.tum").string();
    writeTrajectory(beside, makers);
    run();
    const ReplayRun registered = replayed;
    std::ofstream(data / "camera.yaml", std::ios::app) << "depth_error: 0.1\n";
    run();
    for (const std::size_t i : {std::size_t(3), registered.frames.size() - 1}) {
        const UncertainPose& before = registered.frames[i].tracked.T_c_w;
        const UncertainPose& now = replayed.frames[i].tracked.T_c_w;
        EXPECT_EQ(now.mean.matrix(), before.mean.matrix());
        const Pose T_c_k = now.mean * makers[std::min(i, makers.size() - 1)].T_w_c;
        const double added = (now.covariance - before.covariance)(0, 0);
        EXPECT_NEAR(std::sqrt(added), 0.1 * T_c_k.translation().norm(), 2e-3) << i;
    }
    fs::remove(beside);
    run();
    EXPECT_EQ(replayed.frames.back().tracked.T_c_w.covariance,
              registered.frames.back().tracked.T_c_w.covariance);
    writeText(beside, "0 0 0\n");
    expectRejected({"trajectory.tum"});
}

TEST_F(ReplayInMap, UpFromTheFloorIsTheMapsOwn) {
    useMap();
    options.up = "floor";
    expectRejected({"--up: floor", "the map's own is taken"});
    writeText(folder.path() / "config.yaml",
              fmt::format("dataset: {}\nup: 0.1,0,1\n", data.string()));
    EXPECT_EQ(Replay(options).recording().up, *parseUp("0.1,0,1"));
}

TEST_F(ReplayInMap, LocalisesInAMapMadeWithoutDepthImages) {
    FlightDataset longer{.frames = 20};
    longer.write(data);
    MapOptions map;
    map.dataset = data.string();
    map.depth = "monocular";
    map.fusion.minRange = 0.5;
    const json depth = useMapOf(map).monocular;
    EXPECT_GE(depth["references"], 1);
    EXPECT_GT(depth["completeness"].get<double>(), 0.15);
    EXPECT_LT(depth["median_relative_error"].get<double>(), 0.03);
    EXPECT_LT(depth["share_above_10_percent"].get<double>(), 0.05);
    EXPECT_NEAR(depth["converged"].get<double>() + depth["given_up"].get<double>() +
                    depth["searching"].get<double>(),
                1., 1e-9);
    options.minOverlap = 0.1;
    options.frames = "2:10";
    const json result = run();
    EXPECT_EQ(result["tracked"], 8);
    EXPECT_LT(result["ate_rmse_m"].get<double>(), 0.08);
    map.depth = "sonar";
    expectInputError([&] { openForMap(map); }, {"--depth", "'sonar'"});
}

/// The sample flights in the scenes they were flown in, hovering at the goal included.
TEST_F(ReplayInMap, TheSampleFlightsAreTrackedInTheirScenes) {
    const std::string source = PHOTONAV_SOURCE_DIR;
    options.odometry = false;
    for (const auto& [name, scene] :
         {std::pair("flight_down", "two_textures"), std::pair("flight_front45", "room")}) {
        options.dataset = source + "/data/" + name;
        options.mapFile = source + "/config/scenes/" + scene + ".yaml";
        const json result = run();
        EXPECT_EQ(result["lost"], 0) << name;
        // 9 to 10.5 mm: a few images of almost nothing (sigma 35 mm) decide it.
        EXPECT_LT(result["ate_rmse_m"], 0.015) << name;
        EXPECT_GT(result["nees_per_dof"], 0.5) << name;
        EXPECT_LT(result["nees_per_dof"], 1.5) << name;  // 1.35 on one processor, less on others
    }
}

TEST_F(ReplayInMap, InTheMapOfAnotherRoomItIsLostAtOnce) {
    useMap();
    std::string other = kScene;
    other.replace(other.find("seed: 4"), 7, "seed: 9");
    writeText(folder.path() / "room.yaml", other);
    const json result = run();
    EXPECT_TRUE(isLostForGood(replayed));
    EXPECT_EQ(result["tracked"], 0);
    EXPECT_EQ(result["lost"], 10);
    const auto verdict = result["verdict"].get<std::string>();
    EXPECT_TRUE(verdict.starts_with("lost at once")) << verdict;
    EXPECT_NE(verdict.find("use the same world frame (--up, --start)"), std::string::npos)
        << verdict;
    EXPECT_EQ(verdict.find("--min-overlap"), std::string::npos) << verdict;
}

TEST_F(ReplayInMap, LostForTooLittleOverlapItNamesTheOption) {
    useMap();
    options.minOverlap = 0.5;
    std::string small = kScene;  // a floor that fills a small part of the images
    small.replace(small.find("u: [6, 0, 0], v: [0, 6, 0]"), 26, "u: [2.7, 0, 0], v: [0, 3, 0]");
    writeText(folder.path() / "room.yaml", small);
    const auto verdict = run()["verdict"].get<std::string>();
    EXPECT_NE(verdict.find("overlap 0."), std::string::npos) << verdict;
    EXPECT_NE(verdict.find("--min-overlap"), std::string::npos) << verdict;
}

}  // namespace
}  // namespace photonav
