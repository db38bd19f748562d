// SPDX-License-Identifier: BSD-3-Clause
#include "recordings/scan_command.hpp"

#include "map/octree_file.hpp"
#include "mapping/map_config.hpp"
#include "mapping/scan_map.hpp"
#include "tum_dataset.hpp"

namespace photonav {
namespace {

using test::expectInputError;
using test::writeText;

/// A square metre of floor, one station.
std::string floorScan(bool withStation) {
    std::string rows;
    int count = 0;
    for (int i = 0; i < 50; ++i) {
        for (int j = 0; j < 50; ++j, ++count) {
            rows += std::to_string(i * 0.02) + " " + std::to_string(j * 0.02) + " 0.02 " +
                    (i < 25 ? "40 40 40\n" : "200 200 200\n");
        }
    }
    std::string header = "ply\nformat ascii 1.0\nelement vertex " + std::to_string(count) + "\n";
    for (const char* axis : {"x", "y", "z"}) header += std::string("property float ") + axis + "\n";
    for (const char* c : {"red", "green", "blue"})
        header += std::string("property uchar ") + c + "\n";
    if (!withStation) return header + "end_header\n" + rows;
    for (const char* axis : {"x", "y", "z"}) {
        header += std::string(axis[0] == 'x' ? "element camera 1\n" : "") +
                  "property float view_p" + axis + "\n";
    }
    return header + "end_header\n" + rows + "0.5 0.5 1.5\n";
}

class ScanCommand : public testing::Test {
  protected:
    ScanCommand() {
        test::fs::create_directories(scans);
        options.scans = scans.string();
        options.out = folder.path() / "out";
    }

    test::TemporaryFolder folder;
    test::fs::path scans = folder.path() / "scans";
    ScanCommandOptions options;
    std::atomic<bool> running{false};
};

TEST_F(ScanCommand, MapsAFolderOfStations) {
    writeText(scans / "1.ply", floorScan(true));
    writeText(scans / "2.ply", floorScan(true));
    ASSERT_TRUE(isScan(options.scans));
    const CommandReport report = runScanMap(options, running);
    EXPECT_EQ(report.exitCode, 0);
    EXPECT_EQ(report.result["stations"].size(), 2U);
    EXPECT_EQ(report.result["stations"][0]["points"], 2500);
    EXPECT_EQ(report.result["voxels"]["occupied"], 400);
    EXPECT_GT(report.result["voxels"]["free"], 1000);
    const auto map = loadTexturedOcTree((options.out / "map.ot").string());
    EXPECT_TRUE(map->isNodeOccupied(map->search(0.1, 0.1, 0.02)));
    for (const char* name :
         {"map.bt", "map_color.ot", "result.json", "overview.png", "report.html"})
        EXPECT_TRUE(test::fs::exists(options.out / name)) << name;
}

TEST_F(ScanCommand, AnEmptyMapIsNoAnswer) {
    writeText(scans / "1.ply", floorScan(true));
    options.maxRange = 1e-3;
    const CommandReport report = runScanMap(options, running);
    EXPECT_EQ(report.exitCode, 1);
    EXPECT_EQ(report.summary.rows[0].second,
              "the map is empty: no surface within --max-range 0.001 m");
    EXPECT_TRUE(test::fs::exists(options.out / "report.html"));
}

TEST_F(ScanCommand, AStationThatMissesASurfaceDoesNotEraseIt) {
    writeText(scans / "1.ply", floorScan(true));
    // Three more stations look through a bar of the floor at points below it.
    std::string below = floorScan(true);
    for (std::size_t at = 0; (at = below.find(" 0.02 ", at)) != std::string::npos;)
        below.replace(at, 6, " -.40 ");
    for (const char* name : {"2.ply", "3.ply", "4.ply"}) writeText(scans / name, below);
    runScanMap(options, running);
    const auto map = loadTexturedOcTree((options.out / "map.ot").string());
    EXPECT_TRUE(map->isNodeOccupied(map->search(0.49, 0.49, 0.02)));
}

TEST_F(ScanCommand, WhereTheScannerStoodCanBeSaid) {
    writeText(scans / "1.ply", floorScan(false));
    options.scans = (scans / "1.ply").string();
    EXPECT_EQ(runScanMap(options, running).result["voxels"]["free"], 0);
    options.scanner = Eigen::Vector3d(0.5, 0.5, 1.5);
    EXPECT_GT(runScanMap(options, running).result["voxels"]["free"], 1000);
    writeText(scans / "2.ply", floorScan(false));
    options.scans = scans.string();
    expectInputError([&] { runScanMap(options, running); }, {"--scanner", "2 files"});
}

TEST_F(ScanCommand, ItsConfigMakesTheMapAgain) {
    writeText(scans / "1.ply", floorScan(false));
    options.resolution = 0.1;
    options.scanner = Eigen::Vector3d(0.5, 0.5, 1.5);
    const auto voxels = runScanMap(options, running).result["voxels"];
    const std::string config = (options.out / "config.yaml").string();
    ASSERT_TRUE(isScanConfig(config));
    EXPECT_FALSE(isMapConfig(config));
    ScanCommandOptions again;
    keysOf(again).read(config);
    again.out = folder.path() / "again";
    EXPECT_EQ(runScanMap(again, running).result["voxels"], voxels);
    writeText(folder.path() / "typo.yaml", "scans: scans\nresolutoin: 0.1\n");
    expectInputError([&] { keysOf(again).read((folder.path() / "typo.yaml").string()); },
                     {"typo.yaml", "resolutoin"});
}

TEST_F(ScanCommand, ABadStationStopsItBeforeAnyWork) {
    writeText(scans / "1.ply", floorScan(true));
    writeText(scans / "2.ply",
              "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\n"
              "property float y\nproperty float z\nend_header\n0 0 0\n");
    options.progress = [](std::size_t, std::size_t) { ADD_FAILURE() << "work was done"; };
    expectInputError([&] { runScanMap(options, running); }, {"2.ply", "no colour"});
    EXPECT_FALSE(test::fs::exists(options.out));
    test::fs::remove(scans / "2.ply");
    options.resolution = 1e-5;
    expectInputError([&] { runScanMap(options, running); }, {"1.ply", "--resolution"});
    EXPECT_FALSE(test::fs::exists(options.out));
}

}  // namespace
}  // namespace photonav
