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
