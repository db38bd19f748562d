// SPDX-License-Identifier: BSD-3-Clause
// photonav report, keys, completion and doctor, as a user runs them.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
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

/// script(1) makes a terminal.
TEST(KeysCommand, FitIntoEightyColumnsOfATerminal) {
    const Execution run =
        execute(fmt::format("script -qec '{} keys' /dev/null < /dev/null", PHOTONAV_BINARY));
    EXPECT_EQ(run.exitCode, 0) << run.output;
    EXPECT_NE(run.output.find("planner.alpha = 0.1"), std::string::npos) << run.output;
    EXPECT_NE(run.output.find("    1: the shortest path, 0: the most certain one"),
              std::string::npos);
    std::istringstream lines(run.output);
    for (std::string line; std::getline(lines, line);) {
        EXPECT_LE(line.size(), 81U) << line;  // with the carriage return
        EXPECT_EQ(line.find('|'), std::string::npos) << line;
    }
}

TEST(KeysCommand, ListsThoseOfMapsAndReplaysAsDocumented) {
    const std::string page = test::contentOf(PHOTONAV_SOURCE_DIR "/docs/config.md");
    for (const auto& [of, key] : {std::pair("map", "min_range"), std::pair("scans", "scanner"),
                                  std::pair("replay", "max_width")}) {
        const Execution run = photonav(fmt::format("keys --of {}", of));
        EXPECT_EQ(run.exitCode, 0) << of;
        EXPECT_NE(run.output.find(fmt::format("| `{}` |", key)), std::string::npos) << run.output;
        EXPECT_NE(page.find(fmt::format("<!-- keys --of {} -->\n{}", of, run.output)),
                  std::string::npos)
            << "run scripts/update-docs --run build";
    }
    EXPECT_EQ(photonav("keys --of nothing").exitCode, 2);
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
    const std::string zsh = photonav("completion zsh").output;
    EXPECT_TRUE(zsh.starts_with("#compdef photonav\n"));
    EXPECT_NE(zsh.find("*--alpha[1 the shortest path"), std::string::npos);
    EXPECT_EQ(photonav("completion fish").exitCode, 2);
}

TEST(Doctor, FindsNothingWrongHere) {
    const Execution run = photonav("doctor");
    EXPECT_EQ(run.exitCode, 0) << run.output;
    EXPECT_NE(run.output.find("ok        sample plan"), std::string::npos) << run.output;
}

}  // namespace
}  // namespace photonav
