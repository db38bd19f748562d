// SPDX-License-Identifier: BSD-3-Clause
// photonav report, keys, completion and doctor, as a user runs them.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <set>
#include <sstream>
#include <string>
#include <utility>

#include "app/command_test.hpp"
#include "io/folder_transaction.hpp"

namespace photonav {
namespace {

namespace fs = std::filesystem;

class ReportCommand : public CommandTest {};

TEST_F(ReportCommand, ReportIsRebuiltFromItsFolder) {
    ASSERT_EQ(plan(kQuickPlan).exitCode, 0);
    fs::remove(folder_ / "report.html");
    EXPECT_EQ(photonav("report " + folder_.string()).exitCode, 0);
    EXPECT_TRUE(fs::exists(folder_ / "report.html"));
    {
        const FolderTransaction other(folder_);
        const Execution run = photonav("report " + folder_.string());
        EXPECT_EQ(run.exitCode, 2);
        EXPECT_EQ(run.output,
                  "photonav: " + folder_.string() + ": another photonav is writing it\n");
    }
    EXPECT_FALSE(fs::exists(folder_.string() + ".unfinished"));
    std::ofstream(folder_ / "report.json") << "{";
    EXPECT_EQ(photonav("report " + folder_.string()).exitCode, 2);
}

TEST(KeysCommand, FitIntoEightyColumns) {
    const Execution run = photonav("keys");
    EXPECT_EQ(run.exitCode, 0) << run.output;
    EXPECT_NE(run.output.find("planner.alpha = 0.1"), std::string::npos) << run.output;
    EXPECT_NE(run.output.find("    1: the shortest path, 0: the most certain one"),
              std::string::npos);
    std::istringstream lines(run.output);
    for (std::string line; std::getline(lines, line);) {
        EXPECT_LE(line.size(), 80U) << line;
        EXPECT_EQ(line.find('|'), std::string::npos) << line;
    }
}

TEST(KeysCommand, ListsThoseOfMapsAndReplaysAsDocumented) {
    const std::string page = test::contentOf(PHOTONAV_SOURCE_DIR "/docs/config.md");
    for (const auto& [of, key] : {std::pair("map", "min_range"), std::pair("scans", "scanner"),
                                  std::pair("replay", "max_width")}) {
        const Execution run = photonav(fmt::format("keys --markdown --of {}", of));
        EXPECT_EQ(run.exitCode, 0) << of;
        EXPECT_NE(run.output.find(fmt::format("| `{}` |", key)), std::string::npos) << run.output;
        EXPECT_NE(page.find(fmt::format("<!-- keys --of {} -->\n{}", of, run.output)),
                  std::string::npos)
            << "run scripts/update-docs --run build";
    }
    EXPECT_EQ(photonav("keys --of nothing").exitCode, 2);
    expectBadInput(photonav("keys alpha"), "did you mean 'planner.alpha'?");
    expectBadInput(photonav("keys vertices"), "did you mean 'planner.vertices' or 'explore.vert");
}

/// What a shell offers for the words typed so far, the last one unfinished.
std::string completed(const std::string& words, const std::string& script) {
    return execute(fmt::format("bash -c 'source {0}; COMP_WORDS=({1}); "
                               "COMP_CWORD=$((${{#COMP_WORDS[@]}} - 1)); compopt() {{ :; }}; "
                               "_photonav; echo \"${{COMPREPLY[*]}}\"'",
                               script, words))
        .output;
}

TEST(Completion, OffersCommandsOptionsAndKeys) {
    const test::TemporaryFolder folder;
    const Execution bash = photonav("completion bash");
    EXPECT_EQ(bash.exitCode, 0);
    const std::string script = folder.write("photonav.bash", bash.output);
    EXPECT_EQ(completed("photonav re", script), "replay reference report\n");
    EXPECT_EQ(completed("photonav plan --al", script), "--alpha\n");
    EXPECT_EQ(completed("photonav plan a.yaml --set planner.al", script), "planner.alpha=\n");
    EXPECT_EQ(completed("photonav plan " + folder.file("photonav.b"), script), script + "\n");
    EXPECT_EQ(photonav("completion fish").exitCode, 2);
}

TEST(Completion, OffersValues) {
    const test::TemporaryFolder folder;
    const std::string script = folder.write("photonav.bash", photonav("completion bash").output);
    EXPECT_EQ(completed("photonav completion \"\"", script), "bash zsh\n");
    EXPECT_EQ(completed("photonav keys planner.al", script), "planner.alpha\n");
    EXPECT_EQ(completed("photonav keys --markdown planner.al", script), "planner.alpha\n");
    EXPECT_EQ(completed("photonav keys --of \"\"", script), "plan map scans replay\n");
    EXPECT_EQ(completed("photonav map --depth \"\"", script), "recorded monocular\n");
    EXPECT_EQ(completed("photonav posters --rank-by g", script), "goal\n");
    EXPECT_EQ(completed("photonav replay --stereo s", script), "sgbm\n");
    EXPECT_EQ(completed("photonav sweep a.yaml --planners rrt_star,pa", script),
              "rrt_star,pa_rrt_star\n");
    EXPECT_EQ(completed("photonav map --quiet " + folder.file("photonav.b"), script),
              script + "\n");
}

/// The options of zsh's script that are followed by no value.
std::set<std::string> flagsOfZsh(const std::string& script) {
    std::set<std::string> flags;
    std::istringstream lines(script);
    for (std::string line; std::getline(lines, line);) {
        const std::size_t begin = line.find("'*--"), end = line.find('[');
        if (begin == std::string::npos || line.find("]'") == std::string::npos) continue;
        flags.insert(line.substr(begin + 4, end - begin - 4));
    }
    return flags;
}

TEST(Completion, OfZshKnowsFlagsAndEscapesTexts) {
    const std::string zsh = photonav("completion zsh").output;
    EXPECT_TRUE(zsh.starts_with("#compdef photonav\n"));
    EXPECT_EQ(flagsOfZsh(zsh), (std::set<std::string>{"audit",
                                                      "calibrate",
                                                      "evolution",
                                                      "exposure",
                                                      "film",
                                                      "from-scratch",
                                                      "goal-only",
                                                      "help",
                                                      "json",
                                                      "markdown",
                                                      "no-calibrate",
                                                      "no-exposure",
                                                      "no-odometry",
                                                      "no-photometric-goal",
                                                      "no-realtime",
                                                      "odometry",
                                                      "photometric-goal",
                                                      "quiet",
                                                      "realtime",
                                                      "resume",
                                                      "tilt"}));
    EXPECT_NE(
        zsh.find("'*--alpha[1\\: the shortest path, 0\\: the most certain one (default\\: the "
                 "config'\\''s)]:value:_files'"),
        std::string::npos);
    EXPECT_NE(zsh.find("'*--depth[recorded (also"), std::string::npos);
    EXPECT_NE(zsh.find("]:value:(recorded monocular)'"), std::string::npos);
    EXPECT_NE(zsh.find("'keys:List the keys of a config\\: values"), std::string::npos);
}

TEST(Doctor, FindsNothingWrongHere) {
    const Execution run = photonav("doctor");
    EXPECT_EQ(run.exitCode, 0) << run.output;
    EXPECT_NE(run.output.find("ok        sample plan"), std::string::npos) << run.output;
}

}  // namespace
}  // namespace photonav
