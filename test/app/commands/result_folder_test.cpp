// SPDX-License-Identifier: BSD-3-Clause
// Results replace and remove files only in folders that results made.
#include "commands/result_folder.hpp"

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
        claimFolder(folder, inputs);
    } catch (const InputError& error) {
        return error.what();
    }
    return "";
}

TEST(ResultFolder, FilesOfOthersAreNotReplaced) {
    const TemporaryFolder folder;
    for (const char* name : {"path.tum", "result.json", "report.html", "runs.jsonl", "map.ot"}) {
        const fs::path own = folder.path() / "own";
        write(own / name, "{}");
        const std::string text = complaint(own);
        EXPECT_NE(text.find((own / name).string() + ": would be replaced"), std::string::npos)
            << text;
        EXPECT_EQ(test::contentOf(own / name), "{}");
        EXPECT_FALSE(fs::exists(own / ".photonav"));
        fs::remove_all(own);
    }
}

TEST(ResultFolder, FoldersOfResultsAreUsedAgain) {
    const TemporaryFolder folder;
    const fs::path marked = folder.path() / "marked";
    EXPECT_EQ(complaint(marked), "");
    write(marked / "path.tum", "");
    EXPECT_EQ(complaint(marked), "");
    const fs::path older = folder.path() / "older";
    write(older / "path.tum", "");
    write(older / "result.json", R"({"schema": 1, "command": "plan", "version": "0.1.0"})");
    EXPECT_EQ(complaint(older), "");
    const fs::path notes = folder.path() / "notes";
    write(notes / "notes.txt", "");
    EXPECT_EQ(complaint(notes), "");
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
    EXPECT_NE(run.output.find("mine/trace.png: would be replaced"), std::string::npos)
        << run.output;
    EXPECT_EQ(test::contentOf(folder.path() / "mine/trace.png"), "mine");
}

TEST(ResultFolder, NothingIsLeftOfARunWithoutResult) {
    const TemporaryFolder folder;
    const fs::path made = folder.path() / "new";
    const fs::path old = folder.path() / "old";
    fs::create_directories(old);
    for (const fs::path& path : {made, old}) {
        const NoEmptyFolder guard(path);
        claimFolder(path, {});
    }
    EXPECT_FALSE(fs::exists(made));
    EXPECT_TRUE(fs::is_empty(old));
}

}  // namespace
}  // namespace photonav
