// SPDX-License-Identifier: BSD-3-Clause
#include "report.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <fstream>
#include <limits>
#include <sstream>

#include "atomic_file.hpp"
#include "base64.hpp"
#include "error.hpp"
#include "sample_report.hpp"
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
            readReportData(write(content));
        } catch (const InputError& error) {
            return error.what();
        }
        return "no error";
    }

    fs::path folder_;
};

TEST(Base64, KnownValuesAndRoundTrip) {
    EXPECT_EQ(base64Encode("photonav"), "cGhvdG9uYXY=");
    std::string bytes;
    for (int length = 0; length < 300; ++length) {
        EXPECT_EQ(base64Decode(base64Encode(bytes)), bytes);
        bytes += static_cast<char>(length * 37);
    }
    EXPECT_THROW(base64Decode("abc"), std::invalid_argument);
    EXPECT_THROW(base64Decode("a=b="), std::invalid_argument);
    EXPECT_THROW(base64Decode("ab?="), std::invalid_argument);
}

TEST_F(ReportTest, JsonRoundTrip) {
    ReportData data = sampleReport();
    data.voxels = makeReportVoxels({{0.F, 0.F, 0.F}, {1.F, 0.F, 0.F}}, {10, 200}, 0.05);
    data.figures = {{"A figure.", greyPng(ImageF(4, 4, 0.5F))}};
    const nlohmann::json written = toJson(data);
    const ReportData read = readReportData(write(written.dump()));
    EXPECT_EQ(toJson(read), written);
    EXPECT_EQ(read.paths[0].points[7].positionCovariance,
              data.paths[0].points[7].positionCovariance);
    EXPECT_EQ(read.trees[0].edges, data.trees[0].edges);
    EXPECT_EQ(read.views[2].contribution, data.views[2].contribution);
    EXPECT_EQ(read.paths[1].color, kBaselineColor);
    EXPECT_EQ(read.mesh.positions, data.mesh.positions);
}

TEST_F(ReportTest, UnknownNumbersSurvive) {
    ReportData data = sampleReport();
    data.paths[0].points[0].trace = std::numeric_limits<double>::quiet_NaN();
    const ReportData read = readReportData(write(toJson(data).dump()));
    EXPECT_TRUE(std::isnan(read.paths[0].points[0].trace));
}

TEST_F(ReportTest, MalformedInputIsNamed) {
    const std::string file = (folder_ / "report.json").string();
    const nlohmann::json good = toJson(sampleReport());
    EXPECT_EQ(messageOf(good.dump()), "no error");
    EXPECT_EQ(messageOf(good.dump().substr(0, 5000)), file + ": not JSON, or only a part of it");
    EXPECT_EQ(messageOf("[]"), file + ": schema: missing; is this a report of photonav?");

    nlohmann::json bad = good;
    bad["paths"][1]["points"][2]["position"] = {1, 2};
    EXPECT_EQ(messageOf(bad.dump()),
              file + ": paths[1].points[2].position: a list of 3 numbers is expected");
    bad = good;
    bad["views"][0]["point"] = 100000;
    EXPECT_EQ(messageOf(bad.dump()), file + ": views[0].point: no such point of the first path");
    bad = good;
    bad["trees"][0]["edges"] = "abcd";
    EXPECT_EQ(messageOf(bad.dump()), file + ": trees[0].edges: array is cut");
    bad = good;
    bad["mesh"]["images"] = nlohmann::json::array();
    EXPECT_EQ(messageOf(bad.dump()), file + ": mesh.textures: index outside images");
    bad = good;
    bad["title"] = 3;
    EXPECT_EQ(messageOf(bad.dump()), file + ": title: unexpected number");
    EXPECT_THROW(readReportData(folder_ / "absent.json"), InputError);
}

TEST_F(ReportTest, PageIsOneFileWithEverythingInside) {
    const fs::path file = folder_ / "report.html";
    writeReport(file, sampleReport());
    const std::string page = test::contentOf(file);
    EXPECT_EQ(page.find("@PHOTONAV"), std::string::npos);
    EXPECT_EQ(page.find("src=\"http"), std::string::npos);
    EXPECT_EQ(page.find("href=\"http"), std::string::npos);
    EXPECT_EQ(page.find("# </script>"), std::string::npos) << "config may not end the data block";

    const std::string open = "id=\"data\">";
    const std::size_t begin = page.find(open) + open.size();
    const std::string block = page.substr(begin, page.find("</script>", begin) - begin);
    EXPECT_EQ(nlohmann::json::parse(block), toJson(sampleReport()));
}

TEST_F(ReportTest, UnwritableFolderIsRefusedAndNothingIsLeft) {
    EXPECT_THROW(writeReport(folder_ / "absent" / "report.html", sampleReport()), InputError);
    fs::create_directory(folder_ / "report.html");  // a folder in the way: the rename fails
    fs::create_directory(folder_ / "report.html" / "full");
    EXPECT_THROW(writeReport(folder_ / "report.html", sampleReport()), InputError);
    EXPECT_EQ(std::distance(fs::directory_iterator(folder_), {}), 1)
        << "temporary file left behind";
}

TEST(ReportVoxels, CoarsenedWhenTooMany) {
    std::vector<Eigen::Vector3f> centers;
    std::vector<std::uint8_t> grey;
    for (int i = 0; i < 16; ++i)
        for (int j = 0; j < 16; ++j) {
            centers.emplace_back(0.05F * (i + 0.5F), 0.05F * (j + 0.5F), 0.025F);
            grey.push_back(i < 8 ? 40 : 200);
        }
    EXPECT_EQ(makeReportVoxels(centers, grey, 0.05).grey.size(), 256U);
    const ReportVoxels coarse = makeReportVoxels(centers, grey, 0.05, 70);
    EXPECT_EQ(coarse.grey.size(), 64U);
    EXPECT_DOUBLE_EQ(coarse.size, 0.1);
    EXPECT_EQ(std::count(coarse.grey.begin(), coarse.grey.end(), 40), 32);
    EXPECT_FLOAT_EQ(coarse.centers[0], 0.05F);
}

TEST(ReportVoxels, OccupiedCellsOfAMap) {
    TexturedOcTree map(0.1);
    for (int i = 0; i < 8; ++i) {  // all children of one node, alike: they may be pruned
        const octomap::point3d at(0.05F + 0.1F * (i & 1), 0.05F + 0.1F * (i >> 1 & 1),
                                  0.05F + 0.1F * (i >> 2));
        map.updateNode(at, true)->faces[5] = {0.4F, 1.F};
    }
    map.updateNode(octomap::point3d(1.05F, 0.05F, 0.05F), false);
    map.updateNode(octomap::point3d(2.05F, 0.05F, 0.05F), true);
    map.prune();
    const ReportVoxels voxels = makeReportVoxels(map);
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
