// SPDX-License-Identifier: BSD-3-Clause
// Sweeps: what is run, what is kept of it, and the table it becomes.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <limits>
#include <map>

#include "io/error.hpp"
#include "journal_text.hpp"
#include "reason_of.hpp"
#include "sweep/planner_benchmark.hpp"
#include "sweep/sweep_summary.hpp"
#include "sweep_run.hpp"
#include "temporary_folder.hpp"

namespace photonav {
namespace {

namespace fs = std::filesystem;

using test::makeRun;

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

std::string scenario(const std::string& name) {
    return fmt::format("{}/config/{}.yaml", PHOTONAV_SOURCE_DIR, name);
}

class SweepFiles : public testing::Test {
  protected:
    test::TemporaryFolder temporary_;
    fs::path folder_ = temporary_.path();
};

TEST(SweepAlphas, RangesIncludeTheirEndAndAreRound) {
    EXPECT_EQ(parseAlphas("0.05:0.95:0.1"), SweepConfig{}.alphas);
    EXPECT_EQ(parseAlphas("0:1:0.4"), (std::vector<double>{0., 0.4, 0.8}));
    EXPECT_EQ(parseAlphas("0.3:0.3:0.1"), (std::vector<double>{0.3}));
    EXPECT_EQ(parseAlphas("0.7,0.1"), (std::vector<double>{0.7, 0.1}));
    EXPECT_EQ(parseAlphas("+0.7, 0.1"), (std::vector<double>{0.7, 0.1}));
    for (const char* bad : {"", "0.1:0.9", "0.9:0.1:0.1", "0:1:0", "0:1:-1", "0:1:1e-9", "a",
                            "0.1,"
                            "b"}) {
        EXPECT_TRUE(test::reasonOf([&] { parseAlphas(bad); }).starts_with("--alpha: ")) << bad;
    }
}

TEST(SweepShards, PartitionTheRuns) {
    Config config;
    config.seed = 5;
    config.sweep.runs = 3;
    const auto items = sweepItems(config);
    ASSERT_EQ(items.size(), 3U * 10U * 3U);
    EXPECT_EQ(items.front(), (SweepItem{"belief_rrt_star", 0.05, 5}));
    EXPECT_EQ(items.back(), (SweepItem{"rrt_star", 0.95, 7}));
    std::vector<SweepItem> gathered;
    for (const char* shard : {"1/4", "2/4", "3/4", "4/4"}) {
        const auto part = itemsOf(parseShard(shard), items);
        EXPECT_NEAR(static_cast<double>(part.size()), 22.5, 0.5);
        gathered.insert(gathered.end(), part.begin(), part.end());
    }
    std::set<SweepItem> unique(gathered.begin(), gathered.end());
    EXPECT_EQ(unique, std::set<SweepItem>(items.begin(), items.end()));
    EXPECT_EQ(gathered.size(), items.size());
    EXPECT_EQ(parseShard("+2/4"), (Shard{2, 4}));
    for (const char* bad : {"", "1", "0/2", "3/2", "1/0", "1/2/3", "a/b", "-1/2", "1/"}) {
        EXPECT_TRUE(test::reasonOf([&] { parseShard(bad); }).starts_with("--shard: ")) << bad;
    }
}

TEST(SweepConfigs, SurviveTheirOwnYaml) {
    const Config config = loadConfig(
        scenario("stripes"),
        {"sweep.planners=[rrt_star]", "sweep.alphas=[0.3, 0.1]", "sweep.reference=best.csv"});
    EXPECT_EQ(config.sweep.paper.size(), 10U);
    EXPECT_DOUBLE_EQ(config.sweep.paper[1].goalTrace, 9.25);
    const fs::path copy = fs::temp_directory_path() / "photonav_sweep_config.yaml";
    std::ofstream(copy) << toYaml(config);
    const Config again = loadConfig(copy.string());
    EXPECT_EQ(toYaml(again), toYaml(config));
    EXPECT_EQ(again.sweep.reference, fs::absolute("best.csv").string());
    EXPECT_EQ(again.sweep.alphas, (std::vector<double>{0.3, 0.1}));
    fs::remove(copy);
}

TEST(SweepConfigs, BadOnesAreRefused) {
    const auto reason = [](const std::string& override) {
        return test::reasonOf([&] { loadConfig(scenario("stripes"), {override}); });
    };
    EXPECT_NE(reason("sweep.planners=[rrt_star, rrt_sta]")
                  .find("sweep.planners: 'rrt_sta' is not one of belief_rrt_star, "),
              std::string::npos);
    EXPECT_NE(reason("sweep.planners=[rrt_star, rrt_star]").find("rrt_star twice"),
              std::string::npos);
    EXPECT_NE(reason("sweep.alphas=[0.5, 1.5]").find("1.5 is outside [0, 1]"), std::string::npos);
    EXPECT_NE(reason("sweep.alphas=[]").find("sweep.alphas"), std::string::npos);
    EXPECT_NE(reason("sweep.runs=0").find("sweep.runs"), std::string::npos);
    EXPECT_NE(reason("sweep.paper=[{alpha: 0.1}]").find("sweep.paper[0].length: missing"),
              std::string::npos);
}

TEST(SweepIdentityTest, SaysWhichKeyDiffers) {
    const auto identity = [](const std::vector<std::string>& overrides) {
        return sweepIdentity(loadConfig(scenario("two_textures"), overrides));
    };
    const auto base = identity({});
    EXPECT_EQ(difference(identity({"planner.vertices=300"}), base),
              "planner.vertices: 300 instead of 2500");
    EXPECT_EQ(difference(identity({"sweep.runs=3"}), base), "sweep.runs: 3 instead of 10");
    EXPECT_EQ(difference(runIdentity(identity({"sweep.runs=3", "sweep.alphas=[0.2]", "seed=7"})),
                         runIdentity(base)),
              "");
    // What no run depends on, or what every run sets itself:
    EXPECT_EQ(difference(identity({"planner.alpha=0.7", "planner.name=rrt_star",
                                   "sweep.reference=x.csv", "sweep.paper=[]"}),
                         base),
              "");
}

TEST_F(SweepFiles, TheFolderOfASceneDoesNotMatterItsContentDoes) {
    const auto inFolder = [&](const std::string& name, const std::string& suffix) {
        fs::create_directories(folder_ / name);
        std::ifstream original(std::string(PHOTONAV_SOURCE_DIR) + "/config/scenes/stripes.yaml");
        std::ofstream(folder_ / name / "stripes.yaml") << original.rdbuf() << suffix;
        return sweepIdentity(loadConfig(
            scenario("stripes"), {"scene.file=" + (folder_ / name / "stripes.yaml").string()}));
    };
    const auto base = inFolder("a", "");
    EXPECT_EQ(difference(inFolder("b", ""), base), "");
    EXPECT_TRUE(
        difference(inFolder("c", "# edited\n"), base).starts_with("scene.file (content): "));
}

TEST_F(SweepFiles, TheFilesOfASceneAreNamedWhenTheyChange) {
    const auto write = [&](const std::string& name, const std::string& text) {
        std::ofstream(folder_ / name) << text;
    };
    const auto writeImage = [&](int grey) {
        write("floor.pgm", "P2 2 2 255\n" + std::to_string(grey) + " 200 50 200\n");
    };
    const auto identity = [&](const std::string& scene) {
        return sweepIdentity(
            loadConfig(scenario("stripes"), {"scene.file=" + (folder_ / scene).string()}));
    };
    write("scene.yaml",
          "textures:\n  - {name: floor, type: image, file: floor.pgm}\n"
          "planes:\n  - {corner: [0, 0, 0], u: [9, 0, 0], v: [0, 9, 0], texture: floor}\n");
    write("mesh.obj",
          "mtllib mesh.mtl\nv 0 0 0\nv 9 0 0\nv 0 9 0\nvt 0 0\nvt 1 0\nvt 0 1\n"
          "usemtl floor\nf 1/1 2/2 3/3\n");
    write("mesh.mtl", "newmtl floor\nKd 1 1 1\nmap_Kd floor.pgm\n");
    writeImage(50);
    const auto scene = identity("scene.yaml");
    const auto mesh = identity("mesh.obj");
    EXPECT_EQ(difference(identity("scene.yaml"), scene), "");
    EXPECT_EQ(difference(identity("mesh.obj"), mesh), "");
    writeImage(51);
    const std::string image = "scene.file (content of floor.pgm): ";
    EXPECT_TRUE(difference(identity("scene.yaml"), scene).starts_with(image));
    EXPECT_TRUE(difference(identity("mesh.obj"), mesh).starts_with(image));
    writeImage(50);
    write("mesh.mtl", "newmtl floor\nKd 0.5 0.5 0.5\nmap_Kd floor.pgm\n");
    EXPECT_TRUE(
        difference(identity("mesh.obj"), mesh).starts_with("scene.file (content of mesh.mtl): "))
        << difference(identity("mesh.obj"), mesh);
}

TEST_F(SweepFiles, AJournalGivesBackWhatWasWritten) {
    const SweepItem solved{"rrt_star", 0.15, 3};
    const SweepItem failed{"rrt_star", 0.15, 4};
    SweepRun lost = makeRun(failed, kNone, kNone, kNone);
    lost.goalTrace = kNone;
    lost.status = "no path";
    lost.path.clear();
    {
        SweepJournal journal =
            SweepJournal::create(folder_, {"name", "config: text\n", {{"key", "value"}}, {2, 3}});
        journal.append(makeRun(solved, 0.1 + 0.2, 2. / 3., 1e-300));
        journal.append(lost);
    }
    const SweepJournal journal = SweepJournal::read(folder_);
    EXPECT_EQ(journal.header().name, "name");
    EXPECT_EQ(journal.header().config, "config: text\n");
    EXPECT_EQ(journal.header().identity, (Identity{{"key", "value"}}));
    EXPECT_EQ(journal.header().shard, (Shard{2, 3}));
    ASSERT_EQ(journal.runs().size(), 2U);
    EXPECT_EQ(journal.runs()[0].item, solved);
    EXPECT_EQ(journal.runs()[0].cost, 0.1 + 0.2);  // to the last bit
    EXPECT_EQ(journal.runs()[0].meanTrace, 1e-300);
    EXPECT_EQ(journal.runs()[0].path[1].position.x(), 2. / 3.);
    EXPECT_EQ(journal.runs()[0].path[1].yaw, 0.5);
    EXPECT_TRUE(std::isnan(journal.runs()[1].cost));
    EXPECT_EQ(journal.runs()[1].status, "no path");
    const SweepItem open{"rrt_star", 0.15, 5};
    EXPECT_EQ(journal.missing({solved, open, failed}), (std::vector<SweepItem>{open}));
}

TEST_F(SweepFiles, ACutLineIsDroppedAndWrittenOver) {
    const SweepItem first{"rrt_star", 0.5, 1};
    const SweepItem second{"rrt_star", 0.5, 2};
    {
        SweepJournal journal = SweepJournal::create(folder_, {"name", "", {}, {}});
        journal.append(makeRun(first, 1., 2., 3.));
        journal.append(makeRun(second, 4., 5., 6.));
    }
    const fs::path file = folder_ / SweepJournal::kFileName;
    fs::resize_file(file, fs::file_size(file) - 20);
    SweepJournal cut = SweepJournal::read(folder_);
    ASSERT_EQ(cut.runs().size(), 1U);
    cut.append(makeRun(second, 7., 5., 6.));
    const SweepJournal whole = SweepJournal::read(folder_);
    ASSERT_EQ(whole.runs().size(), 2U);
    EXPECT_EQ(whole.runs()[1].cost, 7.);

    test::writeJournal(file, "{\"photonav_sweep\": 99}\n");
    EXPECT_NE(test::reasonOf([&] { SweepJournal::read(folder_); }).find("line 1"),
              std::string::npos);
    fs::remove(file);
    EXPECT_NE(test::reasonOf([&] { SweepJournal::read(folder_); }).find("is this a sweep?"),
              std::string::npos);
}

TEST_F(SweepFiles, ARunThatIsThereTwiceMustBeTheSame) {
    SweepRun run = makeRun({"rrt_star", 0.5, 7}, 1., 2., 3.);
    SweepJournal journal = SweepJournal::create(folder_, {"name", "", {}, {}}, {run});
    run.seconds *= 2.;
    journal.append(run);
    EXPECT_EQ(SweepJournal::read(folder_).runs().size(), 1U);
    run.goalTrace = 2.5;
    journal.append(run);
    const std::string file = (folder_ / SweepJournal::kFileName).string();
    EXPECT_EQ(test::reasonOf([&] { SweepJournal::read(folder_); }),
              file + ": rrt_star alpha 0.5 seed 7: is there twice, with different results");
}

TEST_F(SweepFiles, NumbersThatNoRunGivesAreRefused) {
    SweepJournal::create(folder_, {"name", "", {}, {}},
                         {makeRun({"rrt_star", 0.5, 7}, 1., 2., 3.)});
    const fs::path file = folder_ / SweepJournal::kFileName;
    const std::string good = test::withoutChecksums(test::contentOf(file));
    for (const auto& [number, other] : {std::pair{"\"seed\":7", "\"seed\":1e308"},
                                        {"\"seed\":7", "\"seed\":4294967296"},
                                        {"\"seed\":7", "\"seed\":-1"},
                                        {"\"cost\":1.0", "\"cost\":-1.0"},
                                        {"\"cost\":1.0", "\"cost\":1e300"},
                                        {"\"cost\":1.0", "\"cost\":0.99"},
                                        {"\"length\":2.0", "\"length\":0.0"},
                                        {"\"length\":2.0", "\"length\":2.01"},
                                        {"\"cost\":1.0,\"goal_trace\":1.5,\"length\":2.0",
                                         "\"cost\":5e3,\"goal_trace\":1.5,\"length\":5e3"},
                                        {"\"path\":[", "\"path\":[],\"other\":["},
                                        {"\"vertices\":100", "\"vertices\":1e30"},
                                        {"\"views\":40", "\"views\":0.5"}}) {
        std::string bad = good;
        ASSERT_NE(bad.find(number), std::string::npos) << bad;
        bad.replace(bad.find(number), std::string(number).size(), other);
        test::writeJournal(file, bad);
        EXPECT_NE(test::reasonOf([&] { SweepJournal::read(folder_); }).find("line 2"),
                  std::string::npos)
            << other;
    }
    test::writeJournal(file, good);
    EXPECT_EQ(SweepJournal::read(folder_).runs().size(), 1U);
}

/// Bits that flip on a disk, and numbers that somebody has typed.
TEST_F(SweepFiles, AChangedLineIsRefused) {
    SweepJournal::create(folder_, {"name", "", {}, {}},
                         {makeRun({"rrt_star", 0.5, 7}, 1., 2., 3.)});
    const fs::path file = folder_ / SweepJournal::kFileName;
    const std::string good = test::contentOf(file);
    for (std::size_t i = 0; i < good.size(); ++i) {
        std::string bad = good;
        bad[i] ^= 1;
        if (bad[i] == '\n' || good[i] == '\n') continue;  // then it is a cut line
        std::ofstream(file) << bad;
        const std::string reason = test::reasonOf([&] { SweepJournal::read(folder_); });
        EXPECT_NE(reason.find(i <= good.find('\n') ? "line 1" : "line 2"), std::string::npos)
            << i << ": " << reason;
    }
    std::string typed = good;
    typed.replace(typed.find("\"cost\":1.0"), 10, "\"cost\":1.5");
    std::ofstream(file) << typed;
    EXPECT_EQ(test::reasonOf([&] { SweepJournal::read(folder_); }),
              file.string() + ": line 2: its checksum does not fit: it was changed, or is damaged");
}

Config smallSweep() {
    return loadConfig(scenario("two_textures"),
                      {"planner.vertices=60", "planner.view_pitch=0.5", "sweep.runs=2",
                       "sweep.alphas=[0.2, 0.8]", "sweep.planners=[pa_rrt_star]"});
}

TEST(SweepThreads, GiveTheRunsOfASingleOne) {
    const Config config = smallSweep();
    const World world(config);
    const auto items = sweepItems(config);
    const std::atomic<bool> interrupted{false};
    std::vector<std::map<SweepItem, std::size_t>> views(2);
    for (const unsigned jobs : {1U, 2U}) {
        runItems(config, world, items, jobs, interrupted,
                 [&](const SweepRun& run) { views[jobs - 1][run.item] = run.views; });
    }
    EXPECT_EQ(views[0].size(), 4U);
    EXPECT_EQ(views[0], views[1]);
}

TEST(SweepThreads, HandOnWhatIsThrownAndStopWhenInterrupted) {
    const Config config = smallSweep();
    const World world(config);
    const auto items = sweepItems(config);
    std::atomic<bool> interrupted{false};
    EXPECT_THROW(runItems(config, world, items, 2, interrupted,
                          [](const SweepRun&) { throw InputError("disk", "", "full"); }),
                 InputError);
    std::size_t done = 0;
    runItems(config, world, items, 1, interrupted, [&](const SweepRun&) {
        ++done;
        interrupted = true;
    });
    EXPECT_EQ(done, 1U);
}

TEST(PlannerBenchmark, ARunThatIsInterruptedEndsAndDoesNotCount) {
    const Config config = smallSweep();
    const World world(config);
    std::atomic<bool> interrupted{false};
    int begun = 0;
    const BenchmarkOutcome outcome = benchmarkPlanners(
        config, world, {}, interrupted, [&](const SweepItem&) { interrupted = ++begun == 2; });
    EXPECT_EQ(begun, 2);
    EXPECT_EQ(outcome.runs.size(), 1U);
    EXPECT_EQ(outcome.curves.size(), 1U);
}

TEST(SweepStatistics, AreMeanAndSampleDeviation) {
    EXPECT_DOUBLE_EQ(statisticOf({1., 2., 4.}).mean, 7. / 3.);
    EXPECT_DOUBLE_EQ(statisticOf({1., 2., 4.}).deviation, std::sqrt(7. / 3.));
    EXPECT_TRUE(std::isnan(statisticOf({1.}).deviation));
    EXPECT_TRUE(std::isnan(statisticOf({}).mean));
}

TEST_F(SweepFiles, ReferencesGiveTheExcess) {
    const std::string file = (folder_ / "best.csv").string();
    std::ofstream(file) << "alpha,cost,length,planner\n0.05,2.5,12,a\n0.15,4,11,b\n";
    const ReferenceCosts reference(file);
    EXPECT_NEAR(reference.excess(makeRun({"pa_rrt_star", 0.15, 1}, 4.4, 0., 0.)), 0.1, 1e-12);
    EXPECT_TRUE(std::isnan(reference.excess(makeRun({"pa_rrt_star", 0.25, 1}, 4.4, 0., 0.))));
    EXPECT_TRUE(
        std::isnan(ReferenceCosts().excess(makeRun({"pa_rrt_star", 0.15, 1}, 4.4, 0., 0.))));
    std::ofstream(file) << "alpha,length\n0.05,2.5\n";
    EXPECT_NE(test::reasonOf([&] { ReferenceCosts r(file); }).find("no column cost"),
              std::string::npos);
    std::ofstream(file) << "alpha,cost\n0.05\n";
    EXPECT_NE(test::reasonOf([&] { ReferenceCosts r(file); }).find("line 2"), std::string::npos);
    for (const char* cost : {"0", "-1", "1e-308", "1e308"}) {
        std::ofstream(file) << "alpha,cost\n0.05," << cost << "\n";
        EXPECT_NE(test::reasonOf([&] { ReferenceCosts r(file); }).find("line 2: the cost is not"),
                  std::string::npos)
            << cost;
    }
    std::ofstream(file) << "alpha,cost\n0.05,2\n0.05,3\n";
    EXPECT_NE(test::reasonOf([&] { ReferenceCosts r(file); }).find("line 3: alpha 0.05 is there"),
              std::string::npos);
}

TEST(SweepTables, HaveThePapersRowBesideOurs) {
    const test::SampleSweep sample;
    const auto cells = summarize(sample.config, sample.runs, {});
    ASSERT_EQ(cells.size(), 3U);
    const auto first = toJson(cells[0]);
    EXPECT_EQ(first["runs"], 2);
    EXPECT_EQ(first["solved"], 1);
    EXPECT_EQ(first["cost_mean"], 3.);
    EXPECT_TRUE(first["cost_std"].is_null());
    EXPECT_EQ(first["vertices_mean"], 100.);
    EXPECT_EQ(first["paper_length"], 40.45);
    EXPECT_DOUBLE_EQ(first["paper_mean_trace"].get<double>(), 0.0775);  // printed x100
    EXPECT_DOUBLE_EQ(first["paper_goal_trace"].get<double>(), 0.0925);
    const auto second = toJson(cells[1]);
    EXPECT_EQ(second["planner"], "belief_rrt_star");
    EXPECT_EQ(second["length_mean"], 12.);
    EXPECT_DOUBLE_EQ(second["length_std"].get<double>(), std::sqrt(2.));
    EXPECT_TRUE(second["paper_length"].is_null());
    EXPECT_TRUE(toJson(cells[2])["paper_length"].is_null());  // plans without views
}

TEST(SweepTables, CsvQuotesWhatNeedsIt) {
    EXPECT_EQ(toCsv({{{"a", 0.1}, {"b", nullptr}, {"c", "plain"}},
                     {{"a", 2}, {"b", "x, \"y\""}, {"c", ""}}},
                    {"c", "a", "b"}),
              "c,a,b\nplain,0.1,\n,2,\"x, \"\"y\"\"\"\n");
}

}  // namespace
}  // namespace photonav
