// SPDX-License-Identifier: BSD-3-Clause
// Results replace folders that results made, and nothing else.
#include "shared/result_folder.hpp"

#include <gtest/gtest.h>

#include <fstream>

#include "app/executable.hpp"
#include "io/error.hpp"
#include "temporary_folder.hpp"

namespace photonav {
namespace {

namespace fs = std::filesystem;
using test::TemporaryFolder;

void write(const fs::path& file, const std::string& text) {
    fs::create_directories(file.parent_path());
    std::ofstream(file) << text;
}

std::string complaint(const fs::path& folder, const InputPaths& inputs = {}) {
    try {
        beginResult(folder, inputs);
    } catch (const InputError& error) {
        return error.what();
    }
    return "";
}

TEST(ResultFolder, NeitherIsNorContainsAnInput) {
    const TemporaryFolder folder;
    const fs::path data = folder.path() / "data";
    write(data / "scenes/a.yaml", "");
    for (const fs::path& out : {data, data / "", data / "scenes", data / "scenes/.."}) {
        const std::string text = complaint(out, {"", data / "scenes/a.yaml"});
        EXPECT_NE(text.find("scenes/a.yaml, which this run reads"), std::string::npos) << out;
    }
    EXPECT_NE(complaint(data, {data}), "");
    EXPECT_EQ(complaint(data / "out", {data / "scenes/a.yaml", data}), "");
    EXPECT_EQ(complaint(folder.path() / "dat", {data}), "");
}

TEST(ResultFolder, ACommandRefusesAFolderOfSomeoneElse) {
    const TemporaryFolder folder;
    write(folder.path() / "mine/trace.png", "mine");
    const auto run = photonav("plan " PHOTONAV_SOURCE_DIR "/config/two_textures.yaml --out " +
                              (folder.path() / "mine").string());
    EXPECT_EQ(run.exitCode, 2);
    EXPECT_NE(run.output.find("mine/trace.png: is not of an earlier result, or was changed since"),
              std::string::npos)
        << run.output;
    EXPECT_EQ(test::contentOf(folder.path() / "mine/trace.png"), "mine");
}

/// Results of a command, interrupted or not, in a folder.
class InterruptedResult : public testing::Test {
  protected:
    fs::path commit(const std::string& note, bool isInterrupted,
                    FolderTransaction::Unfinished unfinished = {}) const {
        FolderTransaction folder = beginResult(given_, {}, unfinished);
        write(folder.path() / "figures/note.txt", note);
        return commitResult(folder, {{"interrupted", isInterrupted}});
    }

    std::string noteIn(const std::string& name) const {
        return test::contentOf(folder_.path() / name / "figures/note.txt");
    }

    const TemporaryFolder folder_;
    fs::path given_ = folder_.path() / "out";
};

TEST_F(InterruptedResult, ReplacesNoEarlierOne) {
    EXPECT_EQ(commit("first", true), given_);
    EXPECT_EQ(commit("second", false), given_);
    EXPECT_EQ(commit("third", true), given_.string() + "-interrupted");
    EXPECT_EQ(commit("fourth", true), given_.string() + "-interrupted");
    EXPECT_EQ(noteIn("out"), "second");
    EXPECT_EQ(noteIn("out-interrupted"), "fourth");
    EXPECT_EQ(std::distance(fs::directory_iterator(folder_.path()), {}), 2);
    commit("fifth", true, FolderTransaction::Unfinished::kept);  // all runs so far, and more
    EXPECT_EQ(noteIn("out"), "fifth");
}

TEST_F(InterruptedResult, NoOtherResultHasItsName) {
    EXPECT_NE(complaint(given_.string() + "-interrupted/").find("ends in -interrupted"),
              std::string::npos);
}

TEST_F(InterruptedResult, IsBesideTheFolderThatALinkLeadsTo) {
    fs::create_directories(folder_.path() / "disk");
    fs::create_directory_symlink(folder_.path() / "disk", folder_.path() / "link");
    given_ = folder_.path() / "link/out/";
    commit("whole", false);
    EXPECT_EQ(commit("part", true), folder_.path() / "link/out-interrupted");
    fs::create_directory_symlink(folder_.path() / "disk/out", folder_.path() / "here");
    given_ = folder_.path() / "here";
    commit("another", true);
    EXPECT_EQ(noteIn("disk/out"), "whole");
    EXPECT_EQ(noteIn("disk/out-interrupted"), "another");
}

TEST_F(InterruptedResult, IsNotLostWhereItCannotBe) {
    commit("whole", false);
    write(folder_.path() / "out-interrupted/mine.txt", "mine");
    try {
        commit("part", true);
        FAIL() << "mine.txt is in the way";
    } catch (const InputError& error) {
        const std::string text = error.what();
        EXPECT_NE(text.find("out-interrupted/mine.txt: is not of an earlier result"),
                  std::string::npos)
            << text;
        EXPECT_NE(text.find("what was done is in "), std::string::npos) << text;
    }
    EXPECT_EQ(noteIn("out"), "whole");
    EXPECT_EQ(noteIn("out.unfinished"), "part");
    EXPECT_EQ(commit("next", false), given_);
    EXPECT_EQ(std::distance(fs::directory_iterator(folder_.path()), {}), 2);
}

TEST(ResultFolder, ARunWithFewerFilesLeavesNoneOfAnEarlierOne) {
    const TemporaryFolder folder;
    const std::string plan = "plan " PHOTONAV_SOURCE_DIR
                             "/config/two_textures.yaml --quiet --set planner.vertices=60 --out " +
                             (folder.path() / "out").string();
    ASSERT_LE(photonav(plan + " --evolution").exitCode, 1);
    EXPECT_TRUE(fs::exists(folder.path() / "out/tree_evolution.png"));
    ASSERT_LE(photonav(plan).exitCode, 1);
    EXPECT_TRUE(fs::exists(folder.path() / "out/report.html"));
    EXPECT_FALSE(fs::exists(folder.path() / "out/tree_evolution.png"));
}

TEST(ResultFolder, AReportThatWasRebuiltIsStillOurs) {
    const TemporaryFolder folder;
    const std::string out = (folder.path() / "out").string();
    const std::string info =
        "info " PHOTONAV_SOURCE_DIR "/config/two_textures.yaml --quiet --out " + out;
    ASSERT_EQ(photonav(info).exitCode, 0);
    ASSERT_EQ(photonav("report " + out).exitCode, 0);
    EXPECT_EQ(photonav(info).exitCode, 0);
}

}  // namespace
}  // namespace photonav
