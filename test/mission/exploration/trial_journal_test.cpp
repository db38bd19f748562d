// SPDX-License-Identifier: BSD-3-Clause
// Explorations as they are kept: every number to the last bit, and nothing that no flight gives.
#include "exploration/trial_journal.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "flight/flight_statistics.hpp"
#include "geometry/se3.hpp"
#include "io/error.hpp"
#include "journal_text.hpp"
#include "reason_of.hpp"
#include "temporary_folder.hpp"

namespace photonav {
namespace {

namespace fs = std::filesystem;

Pose somewhere(double angle) {
    Pose pose = Pose::Identity();
    pose.rotate(Eigen::AngleAxisd(angle, Eigen::Vector3d(1., 2., 2.) / 3.));
    pose.translation() << 1. / 3., -0.1, 2.;
    return pose;
}

ExplorationResult makeFlight(const TrialItem& item) {
    ExplorationResult flight;
    flight.planner = item.planner;
    flight.seed = item.seed;
    flight.end = FlightEnd::noWay;
    flight.reason = "the map shows no way to the goal";
    flight.duration = 0.1 + 0.2;
    flight.flown = 1. / 3.;
    flight.lostTime = 0.04;
    flight.timesLost = 2;
    flight.goalError = 1e-300;
    flight.decidedAfter = 0.1;
    flight.leastClearance = 0.7;
    flight.images = 30;
    flight.rejectedImages = 4;
    flight.keyframes = 5;
    flight.blindSteps = 6;
    flight.wallSeconds = 1.7;
    const Matrix6 covariance = Matrix6::Identity() / 7. + Matrix6::Constant(1e-3);
    flight.samples = {{0.1, 0., somewhere(0.4), {somewhere(0.5), covariance}},
                      {0.2, 0.3, somewhere(0.6), {somewhere(0.7), covariance / 3.}}};
    PlanUpdate update{.time = 0.1,
                      .counts = {1, 2, 3, 4},
                      .viewsMarked = 5,
                      .viewsRendered = 6,
                      .fuseSeconds = 0.1,
                      .clearanceSeconds = 0.2,
                      .viewSeconds = 0.3,
                      .planSeconds = 0.4,
                      .cost = 1. / 7.,
                      .length = 2.,
                      .trace = 3.};
    flight.updates = {update, update};
    flight.updates.back().cost = std::numeric_limits<double>::quiet_NaN();
    return flight;
}

std::shared_ptr<TexturedOcTree> makeMap() {
    auto map = std::make_shared<TexturedOcTree>(0.1);
    map->updateNode(octomap::point3d(0.F, 0.F, 0.F), true);
    return map;
}

class TrialFiles : public testing::Test {
  protected:
    fs::path file() const { return temporary_.path() / TrialJournal::kFileName; }

    TrialJournal create(std::vector<ExplorationResult> flights = {}) const {
        return TrialJournal::create(temporary_.path(), {"name", "", {}, {}}, std::move(flights));
    }

    TrialJournal read() const { return TrialJournal::read(temporary_.path()); }

    const test::TemporaryFolder temporary_;
    const TrialItem first_{"rrt_star/forward", 3}, second_{"rrt_star/forward", 4};
};

TEST_F(TrialFiles, GiveBackWhatWasWritten) {
    const ExplorationResult flight = makeFlight(first_);
    create().append(flight);
    const TrialJournal journal = read();
    ASSERT_EQ(journal.runs().size(), 1U);
    const ExplorationResult& again = journal.runs().front();
    EXPECT_EQ(TrialKind::save(again, temporary_.path()),
              TrialKind::save(flight, temporary_.path()));
    EXPECT_EQ(again.end, FlightEnd::noWay);
    EXPECT_EQ(again.duration, 0.1 + 0.2);  // to the last bit
    EXPECT_EQ(again.goalError, 1e-300);
    EXPECT_EQ(again.samples[1].T_c_w.matrix(), flight.samples[1].T_c_w.matrix());
    EXPECT_EQ(again.samples[1].belief.mean.matrix(), flight.samples[1].belief.mean.matrix());
    EXPECT_EQ(again.samples[1].belief.covariance, flight.samples[1].belief.covariance);
    EXPECT_EQ(neesPerDof(again), neesPerDof(flight));
    EXPECT_EQ(again.updates[0].counts.verticesRewired, 4U);
    EXPECT_EQ(again.updates[0].cost, 1. / 7.);
    EXPECT_TRUE(std::isnan(again.updates[1].cost));
    EXPECT_EQ(again.map, nullptr);
    EXPECT_EQ(journal.missing({first_, second_}), std::vector{second_});
}

TEST_F(TrialFiles, GiveBackWhatAFlightInRealTimeMissed) {
    ExplorationResult flight = makeFlight(first_);
    flight.realTime.emplace();
    flight.realTime->planAge = {3, 0.1 + 0.2, 1., 2.};
    flight.realTime->waited = 2;
    create({makeFlight(second_)}).append(flight);
    const std::vector<ExplorationResult> flights = read().runs();
    ASSERT_EQ(flights.size(), 2U);
    EXPECT_FALSE(flights[0].realTime);
    ASSERT_TRUE(flights[1].realTime);
    EXPECT_EQ(flights[1].realTime->planAge.median, 0.1 + 0.2);
    EXPECT_EQ(flights[1].realTime->waited, 2U);
}

TEST_F(TrialFiles, AFlightThatIsThereTwiceMustBeTheSame) {
    ExplorationResult flight = makeFlight(first_);
    TrialJournal journal = create({flight});
    flight.wallSeconds = 20.;
    flight.updates[0].planSeconds = 5.;
    flight.map = makeMap();
    journal.append(flight);
    EXPECT_EQ(read().runs().size(), 1U);
    flight.updates[0].length = 2.5;
    journal.append(flight);
    EXPECT_EQ(
        test::reasonOf([&] { read(); }),
        file().string() + ": rrt_star/forward seed 3: is there twice, with different results");
}

TEST_F(TrialFiles, ACutLineIsDropped) {
    create({makeFlight(first_)}).append(makeFlight(second_));
    fs::resize_file(file(), fs::file_size(file()) - 20);
    TrialJournal cut = read();
    ASSERT_EQ(cut.runs().size(), 1U);
    cut.append(makeFlight(second_));
    EXPECT_EQ(read().runs().size(), 2U);
}

TEST_F(TrialFiles, NumbersThatNoFlightGivesAreRefused) {
    create({makeFlight(first_)});
    const std::string good = test::withoutChecksums(test::contentOf(file()));
    for (const auto& [text, other] : {std::pair{"\"seed\":3", "\"seed\":-3"},
                                      {"\"seed\":3", "\"seed\":4294967296"},
                                      {"\"images\":30", "\"images\":1e30"},
                                      {"\"images\":30", "\"images\":4294967296"},
                                      {"\"end\":\"no way\"", "\"end\":\"stopped\""},
                                      {"\"rejected_images\":4", "\"rejected_images\":31"},
                                      {"\"covariance\":[", "\"covariance\":[-"},
                                      {"\"time\":0.2", "\"time\":0.05"},
                                      {"\"lost_s\":0.04", "\"lost_s\":-1"},
                                      {"\"lost_s\":0.04", "\"lost_s\":1e999"},
                                      {"\"lost_s\":0.04", "\"lost_s\":null"},
                                      {"\"distance\":0.3", "\"distance\":\"far\""},
                                      {"\"plan_s\":0.4", "\"plan_s\":-0.4"},
                                      {"\"T_c_w\":[", "\"T_c_w\":[2,"},
                                      {",-0.1,", ",-1e300,"},
                                      {",2.0],", ",2.0,3.0],"}}) {
        std::string bad = good;
        ASSERT_NE(bad.find(text), std::string::npos) << text << " in " << bad;
        bad.replace(bad.find(text), std::string(text).size(), other);
        test::writeJournal(file(), bad);
        EXPECT_NE(test::reasonOf([&] { read(); }).find("line 2: not a flight of this version"),
                  std::string::npos)
            << other;
    }
    std::string mirrored = good;  // no rotation
    const std::size_t pose = mirrored.find("\"T_c_w\":[") + 9;
    mirrored.insert(pose, "-");
    test::writeJournal(file(), mirrored);
    EXPECT_NE(test::reasonOf([&] { read(); }).find("line 2"), std::string::npos);
    std::string untracked = good;
    const std::size_t samples = untracked.find("\"samples\":[") + 11;
    untracked.erase(samples, untracked.find("\"seed\"") - 2 - samples);
    test::writeJournal(file(), untracked);
    EXPECT_NE(test::reasonOf([&] { read(); }).find("line 2"), std::string::npos) << untracked;
    for (const auto& [text, other] : {std::pair{"\"name\":\"name\"", "\"name\":\"../name\""},
                                      {"\"shard\":[1,1]", "\"shard\":[0,0]"},
                                      {"\"shard\":[1,1]", "\"shard\":[2,1]"}}) {
        std::string bad = good;
        ASSERT_NE(bad.find(text), std::string::npos) << text << " in " << bad;
        bad.replace(bad.find(text), std::string(text).size(), other);
        test::writeJournal(file(), bad);
        EXPECT_NE(test::reasonOf([&] { read(); }).find("line 1"), std::string::npos) << other;
    }
    test::writeJournal(file(), "{\"photonav_sweep\":2}\n");
    EXPECT_NE(test::reasonOf([&] { read(); }).find("line 1"), std::string::npos);
}

TEST_F(TrialFiles, TheFirstFlightKeepsItsMap) {
    ExplorationResult flight = makeFlight(first_);
    flight.map = makeMap();
    create({flight, makeFlight(second_)});
    std::vector<ExplorationResult> flights = read().runs();
    ASSERT_TRUE(flights[0].map);
    EXPECT_EQ(flights[0].map->size(), flight.map->size());
    keepMapOf(first_, flights);
    EXPECT_EQ(flights.size(), 2U);
    keepMapOf(second_, flights);  // which has no map: it is flown again
    ASSERT_EQ(flights.size(), 1U);
    EXPECT_EQ(itemOf(flights[0]), first_);
    EXPECT_FALSE(flights[0].map);
}

TEST_F(TrialFiles, AMapThatIsMissingOrDamagedIsNoticed) {
    ExplorationResult flight = makeFlight(first_);
    flight.map = makeMap();
    create({flight});
    std::ofstream(temporary_.path() / "map.ot") << "cut";
    EXPECT_NE(test::reasonOf([&] { read(); }).find("map.ot: "), std::string::npos);
    fs::remove(temporary_.path() / "map.ot");
    EXPECT_FALSE(read().runs().front().map);
}

TEST(TrialIdentity, IsThatOfWhatFlightsDependOn) {
    const auto identity = [](const std::vector<std::string>& overrides) {
        return TrialKind::identity(
            loadConfig(fmt::format("{}/config/two_textures.yaml", PHOTONAV_SOURCE_DIR), overrides));
    };
    const Identity base = identity({});
    EXPECT_EQ(difference(identity({"fly.rate=11"}), base), "fly.rate: 11 instead of 0");
    EXPECT_EQ(difference(identity({"sweep.runs=3"}), base), "");
    EXPECT_EQ(difference(identity({"planner.name=rrt_star"}), base),
              "explore.planners: [rrt_star] instead of [belief_rrt_star]");
    EXPECT_EQ(
        difference(identity({"planner.name=rrt_star", "explore.planners=[belief_rrt_star]"}), base),
        "");
    EXPECT_EQ(difference(TrialKind::runIdentity(identity(
                             {"seed=7", "explore.trials=3", "explore.planners=[rrt_star]"})),
                         TrialKind::runIdentity(base)),
              "");
}

}  // namespace
}  // namespace photonav
