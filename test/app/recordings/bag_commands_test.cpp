// SPDX-License-Identifier: BSD-3-Clause
// Recordings in bags, mapped and replayed.
#include "app/executable.hpp"
#include "bag_of_recording.hpp"
#include "dataset/trajectory.hpp"
#include "flight_dataset.hpp"
#include "mapping/map_config.hpp"
#include "recordings/map_command.hpp"
#include "recordings/replay_command.hpp"
#include "shared/command_io.hpp"

namespace photonav {
namespace {

using test::contentOf;

class BagCommands : public testing::Test {
  protected:
    void SetUp() override {
        flight_.frames = 6;
        flight_.write(tum_);
    }

    test::FlightDataset flight_;
    test::TemporaryFolder folder_;
    test::fs::path tum_ = folder_.path() / "flight";
    std::string bag_ = folder_.file("flight.bag");
    std::atomic<bool> interrupted_{false};
};

TEST_F(BagCommands, ReplayTheFlightThatTheFolderHolds) {
    test::writeBag(bag_, tum_, {.compression = "lz4"});
    ReplayCommandOptions options;
    options.odometry = true;
    options.dataset = tum_.string();
    options.out = folder_.path() / "of_folder";
    runReplay(options, interrupted_);
    options.dataset = bag_;
    options.depthScale = 5000.;
    options.out = folder_.path() / "of_bag";
    const CommandReport report = runReplay(options, interrupted_);
    EXPECT_EQ(report.result["dataset"]["layout"], "ROS bag");
    for (const char* name : {"trajectory.tum", "groundtruth.tum"}) {
        const Trajectory expected = readTrajectory(folder_.file("of_folder/") + name);
        const Trajectory trajectory = readTrajectory(folder_.file("of_bag/") + name);
        ASSERT_EQ(trajectory.size(), expected.size());
        for (std::size_t i = 0; i < expected.size(); ++i) {
            EXPECT_EQ(trajectory[i].timestamp, expected[i].timestamp);
            EXPECT_TRUE(trajectory[i].T_w_c.isApprox(expected[i].T_w_c, 1e-8)) << name << i;
        }
    }
    EXPECT_FALSE(test::fs::exists(options.out / "images.txt"));  // no files that COLMAP could read
}

TEST_F(BagCommands, MapTheRoomThatTheFolderShows) {
    test::writeBag(bag_, tum_, {.depthEncoding = "32FC1"});
    MapCommandOptions options;
    options.resolution = 0.1;
    options.dataset = tum_.string();
    options.out = folder_.path() / "of_folder";
    runMap(options, interrupted_);
    options.dataset = bag_;
    options.out = folder_.path() / "of_bag";
    EXPECT_EQ(runMap(options, interrupted_).exitCode, kDone);
    EXPECT_EQ(contentOf(options.out / "map.bt"), contentOf(folder_.path() / "of_folder/map.bt"));
    const MapOptions again = *optionsOfMap((options.out / "map.ot").string());
    EXPECT_EQ(again.dataset, bag_);
    EXPECT_EQ(again.depthScale, 1.);
}

TEST_F(BagCommands, RefuseABagWithoutNeededTopicsInOneLine) {
    test::writeBag(bag_, tum_, {.depthTopic = ""});
    Execution outcome = photonav("replay " + bag_ + " --odometry --out " + folder_.file("out"));
    EXPECT_EQ(outcome.exitCode, kBadInput);
    EXPECT_NE(outcome.output.find("flight.bag: no depth images"), std::string::npos)
        << outcome.output;
    outcome = photonav("replay " + tum_.string() + " --odometry --topics image=/a");
    EXPECT_NE(outcome.output.find("photonav: --topics: is for ROS bags"), std::string::npos);
    outcome = photonav("replay " + bag_ + " --odometry --topics picture=/a");
    EXPECT_NE(outcome.output.find("--topics: 'picture=/a' is not one of image=, depth="),
              std::string::npos)
        << outcome.output;
    outcome = photonav("map " + folder_.file("none.bag"));
    EXPECT_NE(outcome.output.find("none.bag: no such file"), std::string::npos) << outcome.output;
    EXPECT_FALSE(test::fs::exists(folder_.file("out")));
}

}  // namespace
}  // namespace photonav
