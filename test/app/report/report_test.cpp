// SPDX-License-Identifier: BSD-3-Clause
#include "report/report.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <fstream>
#include <limits>
#include <sstream>

#include "app/report/sample_report.hpp"
#include "io/atomic_file.hpp"
#include "io/base64.hpp"
#include "io/error.hpp"
#include "temporary_folder.hpp"

namespace photonav {
namespace {

namespace fs = std::filesystem;

/// A folder of its own, gone afterwards.
class ReportTest : public testing::Test {
  protected:
    void SetUp() override {
        folder_ = fs::temp_directory_path() / ("photonav_report_" + std::to_string(getpid()));
        fs::create_directories(folder_);
    }
    void TearDown() override { fs::remove_all(folder_); }

    fs::path write(const std::string& content) const {
        writeFileAtomically(folder_ / "report.json", content);
        return folder_ / "report.json";
    }
    std::string messageOf(const std::string& content) const {
        try {
            readReportJson(write(content));
        } catch (const InputError& error) {
            return error.what();
        }
        return "no error";
    }

    fs::path folder_;
};

TEST(Base64, KnownValues) {  // RFC 4648
    EXPECT_EQ(base64Encode(""), "");
    EXPECT_EQ(base64Encode("f"), "Zg==");
    EXPECT_EQ(base64Encode("fo"), "Zm8=");
    EXPECT_EQ(base64Encode("foobar"), "Zm9vYmFy");
    EXPECT_EQ(base64Encode("\xff\xfe\xfd"), "//79");
}

TEST_F(ReportTest, FiguresAreOnThePageAndInThreeFormats) {
    ReportData data = sampleReport();
    Plot plot;
    plot.curve({{0., 0.}, {1., 1.}}, {});
    writeResultFolder(folder_, data, {{"my.trace", "A curve.", {"curve", {{plot}}}}});
    ASSERT_EQ(data.figures.size(), 1U);
    EXPECT_EQ(data.figures[0].caption, "A curve.");
    EXPECT_EQ(test::contentOf(folder_ / "my.trace.png"), data.figures[0].image);
    EXPECT_NE(test::contentOf(folder_ / "my.trace.svg").find(">curve</text>"), std::string::npos);
    EXPECT_EQ(test::contentOf(folder_ / "my.trace.pdf").find("%PDF"), 0U);
}

TEST(ReportJson, HoldsTheNumbersAsTheyAre) {
    ReportData data = sampleReport();
    data.voxels = {{0.F, 0.F, 0.F, 1.F, 0.F, 0.F}, {10, 200}, 0.05};
    data.figures = {{"A figure.", "png"}};
    data.paths[0].points[0].trace = std::numeric_limits<double>::quiet_NaN();
    data.result["planners"] = {"rrt_star"};
    data.title = "cut \xE2";  // not UTF-8
    const auto written = nlohmann::json::parse(reportJson(data));
    EXPECT_EQ(written["schema"], 1);
    EXPECT_EQ(written["result"], data.result);
    EXPECT_EQ(written["voxels"]["grey"], base64Encode("\x0A\xC8"));
    EXPECT_EQ(written["voxels"]["centers"].get<std::string>().size(), 32U);  // of 24 bytes
    EXPECT_EQ(written["figures"][0]["image"], "data:image/png;base64," + base64Encode("png"));
    EXPECT_TRUE(written["paths"][0]["points"][0]["trace"].is_null());
    const auto& point = written["paths"][0]["points"][7];
    EXPECT_EQ(point["distance"], data.paths[0].points[7].distance);
    EXPECT_EQ(point["position_covariance"][4], data.paths[0].points[7].positionCovariance(1, 1));
    EXPECT_EQ(written["planner_colors"].dump(), R"({"rrt_star":"#1c6cd6"})");
    EXPECT_EQ(written["paths"][1]["color"], hexColor(data.paths[1].color));
    EXPECT_EQ(written["paths"][1]["mean_trace"], 0.2);
}

TEST_F(ReportTest, JsonIsReadAsItWasWritten) {
    const std::string content = reportJson(sampleReport());
    EXPECT_EQ(readReportJson(write(content)), content);
    const std::string file = (folder_ / "report.json").string();
    EXPECT_EQ(messageOf(content), "no error");
    EXPECT_EQ(messageOf(content.substr(0, 5000)), file + ": not JSON, or only a part of it");
    EXPECT_EQ(messageOf("[]"), file + ": schema: missing; is this a report of photonav?");
    EXPECT_EQ(messageOf(R"({"schema": 2})"),
              file + ": schema: written by another version of photonav");
    EXPECT_THROW(readReportJson(folder_ / "absent.json"), InputError);
}

TEST_F(ReportTest, PageIsOneFileWithEverythingInside) {
    const fs::path file = folder_ / "report.html";
    writeReport(file, reportJson(sampleReport()));
    const std::string page = test::contentOf(file);
    EXPECT_EQ(page.find("@PHOTONAV"), std::string::npos);
    EXPECT_EQ(page.find("src=\"http"), std::string::npos);
    EXPECT_EQ(page.find("href=\"http"), std::string::npos);
    EXPECT_EQ(page.find("# </script>"), std::string::npos) << "config may not end the data block";

    const std::string open = "id=\"data\">";
    const std::size_t begin = page.find(open) + open.size();
    const std::string block = page.substr(begin, page.find("</script>", begin) - begin);
    EXPECT_EQ(nlohmann::json::parse(block), nlohmann::json::parse(reportJson(sampleReport())));
}

TEST_F(ReportTest, UnwritableFolderIsRefusedAndNothingIsLeft) {
    EXPECT_THROW(writeReport(folder_ / "absent" / "report.html", "{}"), InputError);
    fs::create_directory(folder_ / "report.html");  // a folder in the way: the rename fails
    fs::create_directory(folder_ / "report.html" / "full");
    EXPECT_THROW(writeReport(folder_ / "report.html", "{}"), InputError);
    EXPECT_EQ(std::distance(fs::directory_iterator(folder_), {}), 1)
        << "temporary file left behind";
}

TEST(DrawnVoxels, CoarsenedWhenTooMany) {
    TexturedOcTree map(0.05);
    for (int i = 0; i < 16; ++i) {
        for (int j = 0; j < 16; ++j) {
            const auto at = [](int k) { return 0.05F * (static_cast<float>(k) + 0.5F); };
            map.updateNode(octomap::point3d(at(i), at(j), 0.025F), true)->faces[5] = {
                i < 8 ? 0.2F : 0.8F, 1.F};
        }
    }
    EXPECT_EQ(drawnVoxels(map).grey.size(), 256U);
    const DrawnVoxels coarse = drawnVoxels(map, 70);
    EXPECT_EQ(coarse.grey.size(), 64U);
    EXPECT_DOUBLE_EQ(coarse.size, 0.1);
    EXPECT_EQ(std::count(coarse.grey.begin(), coarse.grey.end(), greyLevel(0.2F)), 32);
    EXPECT_FLOAT_EQ(coarse.centers[0], 0.05F);
}

/// One leaf of 65536 cells a side, which a file of 60 bytes can hold, and a cell beside others.
TEST(DrawnVoxels, ALeafIsExpandedAtTheSizeThatIsDrawn) {
    TexturedOcTree map(0.1);
    map.obtainRoot().setLogOdds(1.F);
    const DrawnVoxels drawn = drawnVoxels(map);
    EXPECT_EQ(drawn.grey.size(), 262144U);
    EXPECT_DOUBLE_EQ(drawn.size, 102.4);
    EXPECT_FLOAT_EQ(drawn.centers[0], -3276.8F + 51.2F);
    EXPECT_EQ(drawnVoxels(map, 1).size, 6553.6);
}

TEST(DrawnVoxels, OccupiedCellsOfAMap) {
    TexturedOcTree map(0.1);
    for (int i = 0; i < 8; ++i) {  // all children of one node, alike: they may be pruned
        const octomap::point3d at(0.05F + 0.1F * (i & 1), 0.05F + 0.1F * (i >> 1 & 1),
                                  0.05F + 0.1F * (i >> 2));
        map.updateNode(at, true)->faces[5] = {0.4F, 1.F};
    }
    map.updateNode(octomap::point3d(1.05F, 0.05F, 0.05F), false);
    map.updateNode(octomap::point3d(2.05F, 0.05F, 0.05F), true);
    map.prune();
    const DrawnVoxels voxels = drawnVoxels(map);
    EXPECT_DOUBLE_EQ(voxels.size, 0.1);
    ASSERT_EQ(voxels.grey.size(), 9U);
    EXPECT_EQ(std::count(voxels.grey.begin(), voxels.grey.end(), 102), 8);
    EXPECT_EQ(std::count(voxels.grey.begin(), voxels.grey.end(), 128), 1);
    Eigen::Map<const Eigen::Matrix3Xf> centers(voxels.centers.data(), 3, 9);
    EXPECT_NEAR(centers.row(1).maxCoeff(), 0.15, 1e-6);
    EXPECT_NEAR(centers.row(2).minCoeff(), 0.05, 1e-6);
}

}  // namespace
}  // namespace photonav
