// SPDX-License-Identifier: BSD-3-Clause
// The table of best known paths, and the default planner measured by it.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "io/error.hpp"
#include "problem/planning_problem.hpp"
#include "sweep/reference_table.hpp"
#include "sweep/sweep_summary.hpp"
#include "temporary_folder.hpp"

namespace photonav {
namespace {

namespace fs = std::filesystem;

std::string config(const std::string& name) {
    return fmt::format("{}/config/{}.yaml", PHOTONAV_SOURCE_DIR, name);
}

ReferenceTable referenceOf(const std::string& name) {
    ReferenceTable table(fmt::format("{}/config/reference/{}.csv", PHOTONAV_SOURCE_DIR, name));
    table.read();
    return table;
}

Config loadProblem(const std::string& name, double alpha) {
    return loadConfig(config(name), {fmt::format("planner.alpha={}", alpha)});
}

TEST(Reference, CoversEveryCellAndItsPathsCostWhatItSays) {
    const std::atomic<bool> interrupted = false;
    for (const std::string name : {"two_textures", "stripes"}) {
        const ReferenceTable table = referenceOf(name);
        EXPECT_EQ(table.alphas().size(), 10U);
        for (const double alpha : {0.05, 0.25, 0.75}) {
            const Config config = loadProblem(name, alpha);
            const World world(config);
            PlanningProblem problem(config, world);
            const ReferencePath* reference = table.at(alpha);
            ASSERT_NE(reference, nullptr);
            const auto path = problem.descend(reference->waypoints, {.moves = 0}, interrupted);
            ASSERT_TRUE(path.has_value());
            // Along bars, rounding of single-precision sums is all the information there is.
            EXPECT_NEAR(path->cost, reference->cost, 1e-5 * reference->cost);
            EXPECT_NEAR(path->length, reference->length, 1e-4 * reference->length);
            EXPECT_TRUE(path->points.front().T_w_b.translation().isApprox(config.start.position));
            EXPECT_TRUE(path->points.back().T_w_b.translation().isApprox(config.goal.position));
        }
    }
}

/// Fewer vertices and seeds than promised for the whole table, to be quick.
TEST(Reference, TheDefaultPlannerComesWithinHalfAPercent) {
    for (const auto& [name, alpha] : {std::pair{"two_textures", 0.45}, {"stripes", 0.25}}) {
        Config config = loadProblem(name, alpha);
        config.vertices = 1200;
        const World world(config);
        PlanningProblem problem(config, world);
        double mean = 0.;
        for (const std::uint32_t seed : {101U, 102U}) {
            mean += 0.5 * problem.solve(problem.makePlanner("belief_rrt_star", seed)).path->cost;
        }
        EXPECT_LT(mean, 1.005 * referenceOf(name).at(alpha)->cost) << name;
    }
}

class ReferenceFiles : public testing::Test {
  protected:
    test::TemporaryFolder folder_;
    fs::path file_ = folder_.path() / "table.csv";
};

TEST_F(ReferenceFiles, ComeBackAsTheyWereWrittenAndOnlyGetBetter) {
    ReferencePath path{.alpha = 0.15,
                       .cost = 3.5,
                       .length = 9.,
                       .meanTrace = 0.1,
                       .goalTrace = 0.01,
                       .planner = "pa_rrt_star",
                       .vertices = 7,
                       .labels = 3,
                       .seed = 5,
                       .waypoints = {Pose::Identity(), Pose::Identity()}};
    path.waypoints[1].translation() << 1.25, -2., 3.;
    ReferenceTable table(file_);
    table.read();
    EXPECT_TRUE(table.alphas().empty());
    EXPECT_TRUE(table.offer(path));
    path.cost = 3.6;
    EXPECT_FALSE(table.offer(path));
    table.addNote("all that was tried");
    table.write();
    table.read();
    table.write();
    EXPECT_EQ(ReferenceCosts(file_.string()).at(0.15), 3.5);
    std::string note;
    std::getline(std::ifstream(file_), note);
    EXPECT_EQ(note, "# all that was tried");
    ReferenceTable again(file_);
    again.read();
    ASSERT_NE(again.at(0.15), nullptr);
    EXPECT_EQ(again.at(0.15)->cost, 3.5);
    EXPECT_EQ(again.at(0.15)->planner, "pa_rrt_star");
    ASSERT_EQ(again.at(0.15)->waypoints.size(), 2U);
    EXPECT_TRUE(again.at(0.15)->waypoints[1].isApprox(path.waypoints[1]));
}

TEST_F(ReferenceFiles, NameTheLineThatIsWrong) {
    std::ofstream(file_) << "# a note\n"
                            "alpha,cost,length,mean_trace,goal_trace,planner,vertices,labels,seed\n"
                            "0.1,cheap,1,1,1,rrt_star,1,1,1\n";
    const auto complaint = [&] {
        return test::messageOf<InputError>([&] { ReferenceTable(file_).read(); });
    };
    EXPECT_NE(complaint().find("table.csv: line 3"), std::string::npos) << complaint();
    std::ofstream(file_) << "alpha,cost,length,mean_trace,goal_trace,planner,vertices,labels,seed\n"
                            "0.1,1,1,1,1,rrt_star,1,1,1\n";
    std::ofstream(folder_.path() / "table_paths.csv") << "alpha,x,y,z,yaw\n0.1,0,far,0,0\n";
    EXPECT_NE(complaint().find("table_paths.csv: line 2"), std::string::npos) << complaint();
}

/// What an interrupted search from scratch has found takes the place of a cheaper path in no file.
TEST(ReferenceTableTest, ASearchFromScratchReplacesAPathWhenItHasEnded) {
    const test::TemporaryFolder folder;
    const std::string file = folder.file("table.csv");
    const auto costInFile = [&] {
        ReferenceTable table(file);
        table.read();
        return table.at(0.5)->cost;
    };
    const auto path = [](double cost) {
        return ReferencePath{.alpha = 0.5,
                             .cost = cost,
                             .planner = "rrt_star",
                             .waypoints = {Pose::Identity(), Pose::Identity()}};
    };
    ReferenceTable table(file);
    table.offer(path(7.));
    table.setAside(0.5);
    EXPECT_EQ(table.at(0.5), nullptr);
    table.write();
    EXPECT_EQ(costInFile(), 7.);
    table.offer(path(9.));
    table.write();
    EXPECT_EQ(costInFile(), 7.);
    table.offer(path(6.));
    table.write();
    EXPECT_EQ(costInFile(), 6.);
    table.setAside(0.5);
    table.offer(path(8.));
    table.dropAside(0.5);
    table.write();
    EXPECT_EQ(costInFile(), 8.);
}

}  // namespace
}  // namespace photonav
