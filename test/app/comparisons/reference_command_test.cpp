// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <gtest/gtest.h>

#include "app/executable.hpp"
#include "io/file_lock.hpp"
#include "sweep/reference_table.hpp"
#include "temporary_folder.hpp"

namespace photonav {
namespace {

TEST(ReferenceCommand, NeverMakesItsTableWorse) {
    const test::TemporaryFolder folder;
    const std::string file = folder.file("table.csv");
    const std::string command = fmt::format(
        "reference {} --alpha 0.5 --vertices 150 --labels 2 --runs 1"
        " --set planner.view_pitch=0.5 --file {} --quiet --planners ",
        config("two_textures"), file);
    ASSERT_EQ(photonav(command + "belief_rrt_star --moves 2000").exitCode, 0);
    ReferenceTable table(file);
    table.read();
    const double best = table.at(0.5)->cost;
    ASSERT_EQ(photonav(command + "belief_rrt_star --moves 0 --set seed=2").exitCode, 0);
    table.read();
    EXPECT_LE(table.at(0.5)->cost, best * (1. + 1e-9));
    const Execution wrong = photonav(command + "no_such_planner");
    EXPECT_EQ(wrong.exitCode, 2);
    EXPECT_NE(wrong.output.find("no_such_planner"), std::string::npos);
}

TEST(ReferenceCommand, EveryRunHasItsOwnSeed) {
    const test::TemporaryFolder folder;
    const auto costOf = [&](const std::string& runs) {
        const std::string file = folder.file("table.csv");
        const std::string command = fmt::format(
            "reference {} --alpha 0.5 --vertices 150 --labels 2 --moves 0 --planners "
            "belief_rrt_star --set planner.view_pitch=0.5 --set planner.shortcut=0 --from-scratch "
            "--file {} --quiet {}",
            config("two_textures"), file, runs);
        EXPECT_EQ(photonav(command).exitCode, 0);
        ReferenceTable table(file);
        table.read();
        return table.at(0.5)->cost;
    };
    const double first = costOf("--runs 1 --set seed=2");
    const double second = costOf("--runs 1 --set seed=3");
    ASSERT_LT(second, first);
    EXPECT_EQ(costOf("--runs 2 --set seed=2"), second);
}

/// The table is replaced as it grows, and only by what was found.
TEST(ReferenceCommand, FromScratchLosesNothing) {
    const test::TemporaryFolder folder;
    const std::string file = folder.file("table.csv");
    const std::string mine = folder.write(".probe", "mine");
    ReferenceTable earlier(file);
    for (const double alpha : {0.1, 0.5}) {
        earlier.offer({.alpha = alpha,
                       .cost = 1e-3,
                       .planner = "rrt_star",
                       .waypoints = {Pose::Identity(), Pose::Identity()}});
    }
    earlier.write();
    const std::string command = fmt::format(
        "reference {} --alpha 0.5 --labels 2 --runs 1 --moves 0 --planners rrt_star --quiet "
        "--set planner.kappa=2.5 --from-scratch --file ",
        config("two_textures"));
    ASSERT_EQ(photonav(command + file + " --vertices 2").exitCode, 1) << "found a path";
    ReferenceTable table(file);
    table.read();
    EXPECT_EQ(table.alphas(), (std::vector<double>{0.1, 0.5}));
    ASSERT_EQ(photonav(command + file + " --vertices 500").exitCode, 0);
    table.read();
    EXPECT_EQ(table.at(0.1)->cost, 1e-3);
    EXPECT_GT(table.at(0.5)->cost, 1.);
    EXPECT_EQ(test::contentOf(mine), "mine");

    {
        const FileLock other(file);
        expectBadInput(photonav(command + file), "table.csv: another photonav is writing it");
    }
    EXPECT_FALSE(std::filesystem::exists(file + ".lock"));
    expectBadInput(photonav(command + folder.file("table.txt")), "is not named *.csv");
    std::string impossible = test::contentOf(file);
    impossible.replace(impossible.find("0.1,0.001"), 9, "0.1,-1e300");
    expectBadInput(photonav(command + folder.write("nonsense.csv", impossible)),
                   "nonsense.csv: line");

    const std::string foreign = folder.write("user.csv", "x,y\n1,2\n");
    expectBadInput(photonav(command + foreign), "user.csv: line 1: expected alpha");
    EXPECT_EQ(test::contentOf(foreign), "x,y\n1,2\n");
    const std::string beside = folder.write("new_paths.csv", "x,y\n1,2\n");
    expectBadInput(photonav(command + folder.file("new.csv")), "new_paths.csv: line 1: expected");
    EXPECT_EQ(test::contentOf(beside), "x,y\n1,2\n");
}

}  // namespace
}  // namespace photonav
