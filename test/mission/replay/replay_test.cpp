// SPDX-License-Identifier: BSD-3-Clause
#include "replay/replay.hpp"

#include <fmt/format.h>

#include "io/interrupted.hpp"
#include "mission/replay/replay_fixture.hpp"
#include "replay/replay_calibration.hpp"

namespace photonav {
namespace {

using nlohmann::json;
using test::expectInputError;
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
        if (++count == 3) throw Interrupted();
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

/// By odometry the true pose at which the estimate begins is wrong as well.
TEST(ReplayErrors, CountTheErrorsOfTruePoses) {
    ReplayRun run;
    run.frames = {trackedAt(1., 0., 0., 1.), trackedAt(2., 1.03, 1., 1.)};
    for (ReplayedFrame& frame : run.frames) {
        frame.tracked.T_c_w.covariance = 1e-4 * Matrix6::Identity();
    }
    run.frames[1].index = 1;
    const auto nees = [&] { return evaluate(run).frames.back().normalised->pose; };
    EXPECT_NEAR(nees(), 9. / 6., 1e-6);
    run.truthCovariance.diagonal().head<3>().setConstant(1e-4);
    EXPECT_NEAR(nees(), 4.5 / 6., 1e-6);
    run.odometry = true;
    run.alignedFrame = 0;
    EXPECT_NEAR(nees(), 3. / 6., 1e-6);
    EXPECT_FALSE(evaluate(run).frames.front().normalised);
}

TEST_F(ReplayFixture, TheStartCanBeGiven) {
    useMap();
    fs::remove(data / "groundtruth.txt");
    expectRejected({"--start", "no ground truth"});
    options.up = "y";
    expectRejected({"--up", "needs recorded poses"});
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

/// An alignment to one or two poses has hardly an error, wherever the trajectory is.
TEST_F(ReplayFixture, OdometryIsNotJudgedByTwoPoses) {
    const std::string poses = test::contentOf(data / "groundtruth.txt");
    for (const int known : {2, 3}) {
        std::size_t end = 0;
        for (int line = 0; line < known; ++line) end = poses.find('\n', end) + 1;
        writeText(data / "groundtruth.txt", poses.substr(0, end));
        const json result = run();
        EXPECT_EQ(result["judged"], known);
        EXPECT_EQ(result["ate_rmse_m"].is_null(), known < 3);
        EXPECT_EQ(result["ate_rotation_rmse_deg"].is_null(), known < 3);
    }
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
    rejected([&] { options.up = "floor"; }, {"--up", "needs recorded poses"});
    const double infinite = std::numeric_limits<double>::infinity();
    rejected([&] { options.depthScale = infinite; }, {"--depth-scale", "above 0"});
}

}  // namespace
}  // namespace photonav
