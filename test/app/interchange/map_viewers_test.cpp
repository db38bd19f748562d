// SPDX-License-Identifier: BSD-3-Clause
#include <regex>

#include "app/interchange/other_program.hpp"
#include "core/map/carpet_map.hpp"
#include "map/octree_file.hpp"
#include "map/point_cloud.hpp"
#include "map/surface_cloud.hpp"
#include "temporary_folder.hpp"

namespace photonav {
namespace {

using test::carpetMap;

TEST(Octovis, ReadsAllNodesOfTheGreyMap) {
    if (!isInstalled("octovis")) GTEST_SKIP() << "octovis is not installed";
    const test::TemporaryFolder folder;
    const TexturedOcTree map = carpetMap();
    saveColorOcTree(map, folder.file("map_color.ot"));
    // Its window stays open until the program is told to end.
    const Execution run = execute(fmt::format(
        "{{ QT_QPA_PLATFORM=offscreen octovis {0} > {0}.log 2>&1 & for i in $(seq 300); do "
        "grep -q Done {0}.log && break; sleep 0.1; done; kill $!; cat {0}.log; }}",
        folder.file("map_color.ot")));
    EXPECT_NE(run.output.find(fmt::format("ColorOcTree\nDone ({} nodes)", map.size())),
              std::string::npos)
        << run.output;
}

/// The cubes of the VRML file that OctoMap's bt2vrml makes of our occupancy.
TEST(OctomapTools, SeeTheOccupiedCells) {
    if (!isInstalled("bt2vrml")) GTEST_SKIP() << "bt2vrml (octomap-tools) is not installed";
    const test::TemporaryFolder folder;
    const TexturedOcTree map = carpetMap();
    saveBinaryOcTree(map, folder.file("map.bt"));
    const Execution run = otherProgram("bt2vrml " + folder.file("map.bt"));
    ASSERT_EQ(run.exitCode, 0) << run.output;
    const std::string vrml = test::contentOf(folder.file("map.bt.wrl"));
    const std::regex cube(R"(translation\s+(\S+)\s+(\S+)\s+(\S+))");
    std::size_t cubes = 0;
    for (auto i = std::sregex_iterator(vrml.begin(), vrml.end(), cube); i != std::sregex_iterator();
         ++i) {
        ++cubes;
        const auto* cell = map.search(std::stod((*i)[1]), std::stod((*i)[2]), std::stod((*i)[3]));
        ASSERT_TRUE(cell != nullptr && map.isNodeOccupied(cell)) << (*i)[0];
    }
    std::size_t occupied = 0;
    for (auto leaf = map.begin_leafs(); leaf != map.end_leafs(); ++leaf) {
        if (map.isNodeOccupied(*leaf)) ++occupied;
    }
    EXPECT_EQ(cubes, occupied);
}

/// An .ot and a .bt of convert_octree, which keeps the class of the colours in its .bt, too.
TEST(OctomapTools, WriteMapsThatAreRead) {
    if (!isInstalled("convert_octree")) {
        GTEST_SKIP() << "convert_octree (octomap-tools) is not installed";
    }
    const test::TemporaryFolder folder;
    const TexturedOcTree map = carpetMap();
    saveBinaryOcTree(map, folder.file("map.bt"));
    saveColorOcTree(map, folder.file("grey.ot"));
    for (const auto& [from, to] : {std::pair{"map.bt", "map.ot"}, {"grey.ot", "grey.bt"}}) {
        const Execution run =
            otherProgram("convert_octree " + folder.file(from) + " " + folder.file(to));
        ASSERT_EQ(run.exitCode, 0) << run.output;
        const auto read = loadTexturedOcTree(folder.file(to));
        for (auto leaf = map.begin_leafs(); leaf != map.end_leafs(); ++leaf) {
            const auto* node = read->search(leaf.getKey());
            ASSERT_NE(node, nullptr);
            ASSERT_EQ(read->isNodeOccupied(node), map.isNodeOccupied(*leaf)) << to;
        }
    }
}

/// A line of CloudCompare's text format.
struct CloudPoint {
    Eigen::Vector3d position, colour, normal;
};

std::vector<CloudPoint> cloudIn(const std::string& file) {
    std::vector<CloudPoint> cloud;
    std::ifstream text(file);
    for (CloudPoint point; text >> point.position.x() >> point.position.y() >> point.position.z() >>
                           point.colour.x() >> point.colour.y() >> point.colour.z() >>
                           point.normal.x() >> point.normal.y() >> point.normal.z();) {
        cloud.push_back(point);
    }
    return cloud;
}

TEST(CloudCompare, OpensTheSurfacesAndWritesScans) {
    if (!isInstalled("CloudCompare")) GTEST_SKIP() << "CloudCompare is not installed";
    const test::TemporaryFolder folder;
    saveSurfaceCloud(carpetMap(), folder.file("surfaces.ply"));
    const auto convert = [&](const std::string& format, const std::string& file) {
        const Execution run =
            otherProgram("CloudCompare -SILENT -O " + folder.file("surfaces.ply") +
                         " -C_EXPORT_FMT " + format + " -SAVE_CLOUDS FILE " + folder.file(file));
        ASSERT_EQ(run.exitCode, 0) << run.output;
    };
    convert("ASC", "points.asc");
    const std::vector<CloudPoint> cloud = cloudIn(folder.file("points.asc"));
    EXPECT_EQ(cloud.size(), PointCloudFile(folder.file("surfaces.ply")).size());
    for (const CloudPoint& point : cloud) {
        ASSERT_NEAR(point.position.z(), 0.02, 1e-3);
        ASSERT_NEAR(point.normal.z(), 1., 1e-3);
        ASSERT_EQ(point.colour, Eigen::Vector3d::Constant(point.colour.x()));
        ASSERT_GT(point.colour.x(), 40.);  // the carpet's grey values, 0.18 to 0.82
        ASSERT_LT(point.colour.x(), 215.);
    }
    for (const std::string encoding : {"ASCII", "BINARY_LE", "BINARY_BE"}) {
        convert("PLY -PLY_EXPORT_FMT " + encoding, encoding + ".ply");
        std::size_t i = 0;
        PointCloudFile(folder.file(encoding + ".ply")).read([&](const ScanPoint& point) {
            ASSERT_LT(i, cloud.size());
            ASSERT_TRUE(point.p_w.isApprox(cloud[i].position, 1e-5));
            ASSERT_NEAR(point.grey, cloud[i++].colour.x() / 255., 1e-5);
        });
        EXPECT_EQ(i, cloud.size()) << encoding;
    }
}

}  // namespace
}  // namespace photonav
