// SPDX-License-Identifier: BSD-3-Clause
#include "replay/replay.hpp"

#include <fmt/format.h>

#include "map/octree_file.hpp"
#include "mapping/recording_map.hpp"
#include "mission/replay/replay_fixture.hpp"
#include "render/interruptible_views.hpp"
#include "replay/replay_calibration.hpp"

namespace photonav {
namespace {

using nlohmann::json;
using test::expectInputError;
using test::FlightDataset;
using test::kScene;
using test::ReplayFixture;
using test::writeText;
namespace fs = std::filesystem;

TEST_F(ReplayFixture, OdometryFollowsTheFlight) {
    const json result = run();
    EXPECT_FALSE(isLostForGood(replayed));
    EXPECT_EQ(result["frames"], 12);
    EXPECT_EQ(result["tracked"], 12);
    EXPECT_EQ(result["lost"], 0);
    EXPECT_TRUE(result["lost_intervals"].empty());
    EXPECT_LT(result["ate_rmse_m"].get<double>(), 3e-3);
    EXPECT_GE(result["ate_max_m"].get<double>(), result["ate_rmse_m"].get<double>());
    EXPECT_EQ(result["ate_alignment"], "SE(3), by the positions");
    EXPECT_EQ(result["rpe"]["frame"]["pairs"], 11);
    EXPECT_LT(result["rpe"]["frame"]["translation_m"].get<double>(), 2e-3);
    EXPECT_LT(result["rpe"]["second"]["rotation_deg"].get<double>(), 0.2);
    EXPECT_TRUE(result["rpe"]["metre"].is_null());  // 0.33 m flown
    EXPECT_TRUE(result["nees_per_dof"].is_number());
    EXPECT_GT(result["fps"].get<double>(), 0.);
}

TEST_F(ReplayFixture, OdometryAtTheWidthAskedFor) {
    const auto errorAt = [&](std::optional<int> maxWidth) {
        options.maxWidth = maxWidth;
        return run()["ate_rmse_m"].get<double>();
    };
    const double byDefault = errorAt({});
    EXPECT_DOUBLE_EQ(errorAt(80), byDefault);  // half of the images' 160
    EXPECT_NE(errorAt(40), byDefault);
    EXPECT_LT(errorAt(160), 3e-3);
    EXPECT_NE(errorAt(160), byDefault);
}

/// A tracker of large images whose third one is stopped.
ReplayTracker stoppedTracker(const Camera& camera) {
    ReplayTracker tracker;
    tracker.camera = camera;
    tracker.track = [count = 0](const View&, double) mutable -> TrackedFrame {
        if (++count == 3) throw RenderingStopped();
        return {};
    };
    tracker.predict = [](const TrackedView& frame, const auto&) { return frame.view; };
    return tracker;
}

Recording fiveGreyImages() {
    Recording recording;
    recording.sequence.camera = makeCamera(1500, 20, 1.2);
    for (int i = 0; i < 5; ++i) {
        Sequence::Entry entry;
        entry.timestamp = i;
        recording.sequence.frames.push_back(entry);
    }
    recording.view = [](std::size_t) {
        return View{ImageF(20, 1500, 0.5F), ImageF(20, 1500, 1.F)};
    };
    return recording;
}

TEST(Replaying, EndsWhenTheTrackerHasGivenUp) {
    const Recording recording = fiveGreyImages();
    ReplayTracker tracker;
    tracker.camera = recording.sequence.camera;
    int count = 0;
    tracker.track = [&](const View&, double) {
        TrackedFrame frame;
        frame.rejected = true;
        ++count;
        return frame;
    };
    tracker.predict = [](const TrackedView& frame, const auto&) { return frame.view; };
    EXPECT_EQ(replay(recording, tracker, {}, {}).frames.size(), 5U) << "it never does";
    count = 0;
    tracker.hasGivenUp = [&] { return count == 3; };
    const ReplayRun run = replay(recording, tracker, {}, {});
    EXPECT_EQ(run.frames.size(), 3U);
    EXPECT_EQ(run.stopped, "none of 3 images that show something could be found");
}

TEST(Replaying, KeepsTheFramesBeforeAViewThatWasStopped) {
    const Recording recording = fiveGreyImages();
    const ReplayRun run = replay(recording, stoppedTracker(recording.sequence.camera), {}, {});
    EXPECT_TRUE(run.interrupted);
    EXPECT_EQ(run.frames.size(), 2U);
    ASSERT_EQ(run.strips.size(), 2U);
    EXPECT_EQ(run.strips[0].observed.intensity.getWidth(), 375U);  // halved twice
    EXPECT_EQ(run.strips[0].predicted.depth.getHeight(), 5U);
}

TEST_F(ReplayFixture, StopsWhenAsked) {
    const Replay replay(options);
    std::size_t calls = 0;
    const auto count = [&](std::size_t done) { EXPECT_EQ(done, ++calls); };
    replayed = replay.run([&] { return calls == 4; }, count);
    EXPECT_EQ(calls, 4U);
    EXPECT_EQ(replayed.frames.size(), 4U);
    EXPECT_TRUE(replayed.interrupted);
    EXPECT_FALSE(isLostForGood(replayed));
}

/// Every run begins anew.
TEST_F(ReplayFixture, RunsTwiceTheSame) {
    const Replay replay(options);
    const Trajectory first = meansOf(beliefsOf(replay.run()));
    const Trajectory second = meansOf(beliefsOf(replay.run()));
    ASSERT_EQ(first.size(), second.size());
    EXPECT_EQ(first.back().T_w_c.matrix(), second.back().T_w_c.matrix());
}

TEST_F(ReplayFixture, SaysWhichValuesAreInUse) {
    EXPECT_FALSE(Replay(options).options().startSigma);
    EXPECT_TRUE(Replay(options).options().scale);
    useMap();
    const Replay inMap(options);
    EXPECT_EQ(inMap.options().startSigma, kStartSigma);
    EXPECT_GT(inMap.options().scale, 0.);
    EXPECT_NEAR(inMap.medianDepth().value_or(0.), 1.5, 0.3);
    options.leastSigma = 0.003;
    EXPECT_EQ(Replay(options).options().leastSigma, 0.003);
}

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
TEST_F(ReplayFixture, TheSampleFlightsAreTrackedInTheirScenes) {
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
        EXPECT_LT(result["nees_per_dof"], 1.35) << name;
    }
}

ReplayedFrame trackedAt(double timestamp, double x, double trueX, double keyframe) {
    ReplayedFrame frame;
    frame.timestamp = timestamp;
    frame.status = FrameStatus::tracked;
    frame.tracked.T_c_w.mean.translation().x() = x;
    frame.tracked.keyframe = keyframe;
    frame.tracked.alignment.verdict = Verdict::converged;
    frame.tracked.alignment.information = Matrix6::Identity();
    frame.truth_c_w = Pose::Identity();
    frame.truth_c_w->translation().x() = trueX;
    return frame;
}

/// Odometry's errors are those of single alignments, to whichever keyframe.
TEST(AlignmentErrors, AreOfTheKeyframeAlignedTo) {
    ReplayRun run;
    run.frames = {trackedAt(1., 0., 0., 1.), trackedAt(2., 1.1, 1., 1.), trackedAt(3., 2.3, 2., 2.),
                  trackedAt(4., 3., 3., 1.)};
    run.frames[0].tracked.alignment.information.setZero();  // of its own keyframe
    run.odometry = true;
    run.scale = 0.5;
    const auto errors = alignmentErrors(run);
    ASSERT_EQ(errors.size(), 3U);
    EXPECT_NEAR(errors[0].xi.x(), -0.1, 1e-12);
    EXPECT_NEAR(errors[1].xi.x(), -0.2, 1e-12);
    EXPECT_NEAR(errors[2].xi.x(), 0., 1e-12);
    EXPECT_TRUE(errors[0].information.isApprox(2. * Matrix6::Identity()));
    run.odometry = false;
    EXPECT_NEAR(alignmentErrors(run)[1].xi.x(), -0.3, 1e-12);
}

TEST_F(ReplayFixture, TheStartCanBeGiven) {
    useMap();
    fs::remove(data / "groundtruth.txt");
    expectRejected({"--start", "no ground truth"});
    options.up = "y";
    expectRejected({"--up", "no true poses"});
    options.up = "z";
    const Pose T_w_c = flight.T_w_c(0);
    const Eigen::Quaterniond q(T_w_c.linear());
    const auto& p = T_w_c.translation();
    options.start = fmt::format("{},{},{},{},{},{},{}", p.x() + 0.03, p.y(), p.z() - 0.02, q.x(),
                                q.y(), q.z(), q.w());
    const json result = run();
    EXPECT_FALSE(isLostForGood(replayed));
    EXPECT_TRUE(result["ate_rmse_m"].is_null());
    EXPECT_TRUE(result["nees_per_dof"].is_null());
    EXPECT_TRUE(estimate()[8].T_w_c.isApprox(flight.T_w_c(8), 5e-3));
    writeReplayTables(folder.path(), replayed, evaluate(replayed));
    EXPECT_TRUE(fs::exists(folder.path() / "trajectory.tum"));
    EXPECT_FALSE(fs::exists(folder.path() / "groundtruth.tum"));
}

TEST_F(ReplayFixture, InTheMapOfAnotherRoomItIsLostAtOnce) {
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
    EXPECT_NE(verdict.find("must share a world (--up, --start)"), std::string::npos) << verdict;
    EXPECT_EQ(verdict.find("--min-overlap"), std::string::npos) << verdict;
}

TEST_F(ReplayFixture, LostForTooLittleOverlapItNamesTheOption) {
    useMap();
    options.minOverlap = 0.5;
    std::string small = kScene;  // a floor that fills a small part of the images
    small.replace(small.find("u: [6, 0, 0], v: [0, 6, 0]"), 26, "u: [2.7, 0, 0], v: [0, 3, 0]");
    writeText(folder.path() / "room.yaml", small);
    const auto verdict = run()["verdict"].get<std::string>();
    EXPECT_NE(verdict.find("overlap 0."), std::string::npos) << verdict;
    EXPECT_NE(verdict.find("--min-overlap"), std::string::npos) << verdict;
}

/// What it begins with is nowhere near the truth, and must not count.
TEST_F(ReplayFixture, OdometryIsAlignedToTheGroundTruthWhereItBegins) {
    const std::string poses = test::contentOf(data / "groundtruth.txt");
    const json all = run();
    EXPECT_TRUE(all["nees_per_dof"].is_number());
    fs::remove(data / "depth/0.png");  // the first image cannot be used
    const json second = run();
    EXPECT_EQ(second["unreadable"], 1);
    EXPECT_NEAR(second["nees_per_dof"].get<double>(), all["nees_per_dof"].get<double>(), 0.5);
    flight.write(data);
    const auto firstLines = [&](int n) {
        std::size_t end = 0;
        while (n-- > 0) end = poses.find('\n', end) + 1;
        return end;
    };
    writeText(data / "groundtruth.txt", poses.substr(firstLines(3)));
    const json late = run();
    EXPECT_EQ(late["judged"], 9);
    EXPECT_TRUE(late["nees_per_dof"].is_null());
    EXPECT_LT(late["ate_rmse_m"].get<double>(), 3e-3);
    EXPECT_TRUE(estimate()[3].T_w_c.isApprox(flight.T_w_c(3), 1e-6));
    EXPECT_TRUE(estimate()[0].T_w_c.isApprox(flight.T_w_c(0), 5e-3));
    options.start = "1,2,3,0,0,0,1";
    expectRejected({"--start", "with ground truth"});
}

TEST_F(ReplayFixture, RejectsWhatItCannotReplay) {
    const auto rejected = [&](auto change, const std::vector<std::string>& parts) {
        const ReplayOptions good = options;
        change();
        expectRejected(parts);
        options = good;
    };
    rejected([&] { options.odometry = false; }, {"--map", "--odometry"});
    rejected([&] { options.mapFile = "x.ot"; }, {"--odometry", "not together"});
    rejected([&] { options.depthScale = 5.; }, {"--depth-scale", "implausible", "too small"});
    rejected([&] { options.depthScale = 5e6; }, {"--depth-scale", "implausible", "too large"});
    rejected([&] { options.every = 0; }, {"--every"});
    rejected([&] { options.up = "q"; }, {"--up", "'q'"});
    rejected([&] { options.stereo = "xy"; }, {"--stereo", "'xy'"});
    rejected([&] { options.stereo = "bm"; }, {"--stereo", "EuRoC"});
    rejected([&] { options.startSigma = 0.1; }, {"--start-sigma", "--map"});
    rejected([&] { options.frames = "3"; }, {"--frames", "'3'"});
    rejected([&] { options.frames = "20:"; }, {"--frames", "none of 12"});
    rejected([&] { options.frames = "3:4"; }, {"single frame"});
    rejected([&] { options.start = "1,2,3"; }, {"--start", "x,y,z,qx"});
    rejected([&] { options.start = "1,2,3,0,0,0,0"; }, {"--start", "unit quaternion"});
    rejected([&] { options.dataset = "/nowhere"; }, {"/nowhere", "no such folder"});
    rejected([&] { options.cameraFile = "/no.yaml"; }, {"/no.yaml", "no such file"});
    rejected([&] { useMap(), options.mapFile = "/no.ot"; }, {"/no.ot"});
    rejected(
        [&] {
            writeText(folder.path() / "large.yaml",
                      "width: 640\nheight: 480\nfx: 500\nfy: 500\ncx: 320\ncy: 240\n");
            options.cameraFile = (folder.path() / "large.yaml").string();
        },
        {"rgb/0.png", "160x120 pixels, not the 640x480 of", "large.yaml (width, height)"});
    rejected(
        [&] {
            writeText(folder.path() / "scaled.yaml",
                      "width: 160\nheight: 120\nfx: 130\nfy: 130\ncx: 80\ncy: 60\n"
                      "depth_scale: 5\n");
            options.cameraFile = (folder.path() / "scaled.yaml").string();
        },
        {"scaled.yaml: depth_scale: implausible"});
    writeText(data / "groundtruth.txt", "5 0 0 1 0 0 0 1\n");
    expectRejected({"groundtruth.txt", "poses from 5.000", "images from 50.000 to 51.100"});
    fs::remove(data / "groundtruth.txt");
    rejected([&] { options.up = "floor"; }, {"--up", "no true poses"});
    const double infinite = std::numeric_limits<double>::infinity();
    rejected([&] { options.depthScale = infinite; }, {"--depth-scale", "above 0"});
}

}  // namespace
}  // namespace photonav
