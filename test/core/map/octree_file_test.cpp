// SPDX-License-Identifier: BSD-3-Clause
#include "map/octree_file.hpp"

#include <gtest/gtest.h>
#include <octomap/ColorOcTree.h>
#include <octomap/OcTree.h>

#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>

#include "core/map/carpet_map.hpp"
#include "io/error.hpp"
#include "map/point_cloud.hpp"
#include "map/surface_cloud.hpp"
#include "temporary_folder.hpp"

namespace photonav {
namespace {

using test::carpetMap;
using test::contentOf;
using test::kTop;

class MapFile : public ::testing::Test {
  protected:
    MapFile() {
        folder_ =
            std::filesystem::temp_directory_path() / ("photonav_map_" + std::to_string(::getpid()));
        std::filesystem::create_directories(folder_);
    }
    ~MapFile() override {
        std::error_code ignored;
        std::filesystem::remove_all(folder_, ignored);
    }
    std::string file(const std::string& name) const { return (folder_ / name).string(); }
    std::string complaint(const std::string& name) const {
        try {
            loadTexturedOcTree(file(name));
        } catch (const InputError& error) {
            return error.what();
        }
        return "";
    }

    std::filesystem::path folder_;
};

TEST_F(MapFile, KeepsTheWholeMap) {
    const TexturedOcTree map = carpetMap();
    saveTexturedOcTree(map, file("map.ot"));
    const auto read = loadTexturedOcTree(file("map.ot"));
    EXPECT_TRUE(map == *read);
    EXPECT_EQ(map.getResolution(), read->getResolution());
    using Files = std::filesystem::directory_iterator;
    EXPECT_EQ(std::distance(Files(folder_), Files()), 1) << "no temporary file is left";
}

TEST_F(MapFile, IsKnownToOctomapsFactory) {
    const TexturedOcTree map = carpetMap();
    saveTexturedOcTree(map, file("map.ot"));
    const std::unique_ptr<octomap::AbstractOcTree> read(
        octomap::AbstractOcTree::read(file("map.ot")));
    const auto* textured = dynamic_cast<TexturedOcTree*>(read.get());
    ASSERT_NE(textured, nullptr);
    EXPECT_TRUE(map == *textured);
}

TEST_F(MapFile, ExportsGreyForOctovis) {
    const TexturedOcTree map = carpetMap();
    saveColorOcTree(map, file("grey.ot"));
    const std::unique_ptr<octomap::AbstractOcTree> read(
        octomap::AbstractOcTree::read(file("grey.ot")));
    const auto* color = dynamic_cast<octomap::ColorOcTree*>(read.get());
    ASSERT_NE(color, nullptr);
    EXPECT_EQ(color->size(), map.size());
    const auto* node = color->search(0.125, 0.125, 0.025);
    ASSERT_NE(node, nullptr);
    EXPECT_TRUE(color->isNodeOccupied(node));
    EXPECT_NEAR(node->getColor().g, 255. * *map.search(0.125, 0.125, 0.025)->meanGrey(), 0.51);

    // And back: occupancy as it was, all faces the same grey.
    const auto back = loadTexturedOcTree(file("grey.ot"));
    EXPECT_EQ(back->size(), map.size());
    const auto* cell = back->search(0.125, 0.125, 0.025);
    EXPECT_NEAR(cell->faces[0].mean, node->getColor().g / 255., 1e-6);
    EXPECT_EQ(cell->faces[0], cell->faces[kTop]);
    EXPECT_FALSE(back->search(0.125, 0.125, 0.525)->meanGrey());
}

TEST_F(MapFile, ExportsAndReadsBinaryOccupancy) {
    const TexturedOcTree map = carpetMap();
    saveBinaryOcTree(map, file("map.bt"));
    octomap::OcTree octomapRead(0.1);
    ASSERT_TRUE(octomapRead.readBinary(file("map.bt")));
    const auto ours = loadTexturedOcTree(file("map.bt"));
    EXPECT_EQ(octomapRead.size(), map.size());
    EXPECT_EQ(ours->size(), map.size());
    for (auto leaf = map.begin_leafs(); leaf != map.end_leafs(); ++leaf) {
        const auto* there = octomapRead.search(leaf.getKey());
        const auto* here = ours->search(leaf.getKey());
        ASSERT_TRUE(there != nullptr && here != nullptr);
        ASSERT_EQ(map.isNodeOccupied(*leaf), octomapRead.isNodeOccupied(there));
        ASSERT_EQ(map.isNodeOccupied(*leaf), ours->isNodeOccupied(here));
        ASSERT_FALSE(here->meanGrey());
    }
}

TEST_F(MapFile, CutShortAnywhereOrTooLongIsAnError) {
    const TexturedOcTree map = carpetMap();
    for (const std::string name : {"map.ot", "grey.ot", "map.bt"}) {
        if (name == "map.ot") saveTexturedOcTree(map, file(name));
        if (name == "grey.ot") saveColorOcTree(map, file(name));
        if (name == "map.bt") saveBinaryOcTree(map, file(name));
        std::ifstream stream(file(name), std::ios::binary);
        const std::string all{std::istreambuf_iterator<char>(stream), {}};
        for (const double part : {0.0, 0.001, 0.3, 0.5, 0.999}) {
            std::ofstream(file("cut"), std::ios::binary)
                << all.substr(0, static_cast<std::size_t>(part * static_cast<double>(all.size())));
            EXPECT_NE(complaint("cut"), "") << name << ' ' << part;
        }
        std::ofstream(file("cut"), std::ios::binary) << all.substr(0, all.size() - 1);
        EXPECT_NE(complaint("cut").find("cut short"), std::string::npos) << complaint("cut");
        std::ofstream(file("long"), std::ios::binary) << all << '\n';
        EXPECT_NE(complaint("long").find("after its last node"), std::string::npos);
    }
}

TEST_F(MapFile, HasAVersionAndOldFilesLoad) {
    saveTexturedOcTree(carpetMap(), file("map.ot"));
    const std::string now = contentOf(file("map.ot"));
    const std::string line = "# photonav map, version 2\n";
    ASSERT_NE(now.find(line), std::string::npos);
    const auto withLine = [&](std::string content, const std::string& other) {
        std::ofstream(file("changed.ot"), std::ios::binary)
            << content.replace(content.find(line), line.size(), other);
    };
    for (const char* version : {"3", "0", "2x", ""}) {
        withLine(now, "# photonav map, version " + std::string(version) + "\n");
        EXPECT_NE(complaint("changed.ot").find("version: unknown"), std::string::npos) << version;
    }
    withLine(now, "");
    EXPECT_NE(complaint("changed.ot").find("unknown contents"), std::string::npos);

    TexturedOcTree old = carpetMap();
    for (auto leaf = old.begin_leafs(); leaf != old.end_leafs(); ++leaf) leaf->surfaces.clear();
    saveTexturedOcTree(old, file("old.ot"));
    withLine(contentOf(file("old.ot")), "");
    EXPECT_TRUE(*loadTexturedOcTree(file("changed.ot")) == old);
}

TEST_F(MapFile, ExportsSurfacesAsPoints) {
    const TexturedOcTree map = carpetMap();
    saveSurfaceCloud(map, file("surfaces.ply"));
    const PointCloudFile cloud(file("surfaces.ply"));
    EXPECT_GT(cloud.size(), 100U);
    cloud.read([](const ScanPoint& point) { ASSERT_NEAR(point.p_w.z(), 0.02, 1e-3); });
    const std::string content = contentOf(file("surfaces.ply"));
    const std::size_t first = content.find("end_header\n") + 11;
    ASSERT_EQ(content.size(), first + 27 * cloud.size());
    std::array<float, 3> normal{};
    std::memcpy(normal.data(), content.data() + first + 12, 12);
    EXPECT_NEAR(normal[2], 1.F, 1e-3);
}

TEST_F(MapFile, DamagedOrForeignFilesAreNamed) {
    std::ofstream(file("text.ot")) << "a letter\n";
    EXPECT_NE(complaint("text.ot").find("not an OctoMap file"), std::string::npos);
    EXPECT_NE(complaint("none.ot").find("no such file"), std::string::npos);
    EXPECT_NE(complaint("").find("not a file"), std::string::npos);
    std::ofstream(file("stamped.ot"))
        << "# Octomap OcTree file\nid OcTreeStamped\nsize 1\nres 0.1\ndata\n";
    EXPECT_NE(complaint("stamped.ot").find("id: a map of class \"OcTreeStamped\""),
              std::string::npos);

    saveTexturedOcTree(carpetMap(), file("map.ot"));
    std::ifstream stream(file("map.ot"), std::ios::binary);
    std::string all{std::istreambuf_iterator<char>(stream), {}};
    const std::size_t size = all.find("size ") + 5;
    all.replace(size, all.find('\n', size) - size, "12");
    std::ofstream(file("count.ot"), std::ios::binary) << all;
    EXPECT_NE(complaint("count.ot").find("in its header 12"), std::string::npos);
    std::ofstream(file("deep.ot"), std::ios::binary)
        << "# Octomap OcTree file\nid OcTree\nsize 99\nres 0.1\ndata\n"
        << std::string(100000, '\x01');
    EXPECT_NE(complaint("deep.ot").find("below the cells"), std::string::npos);
}

TEST_F(MapFile, WeightsOfFacesAreNumbers) {
    TexturedOcTree map(0.1);
    map.updateNode(octomap::point3d(0.F, 0.F, 0.F), true)->faces[kTop] = {
        0.5F, std::numeric_limits<float>::infinity()};
    saveTexturedOcTree(map, file("heavy.ot"));
    EXPECT_NE(complaint("heavy.ot").find("the weight of a face is not a positive number"),
              std::string::npos)
        << complaint("heavy.ot");
}

TEST_F(MapFile, HeadersThatCannotBeAreRefusedBeforeTheirNodesAreRead) {
    const auto ofHeader = [&](const std::string& size, const std::string& resolution) {
        std::ofstream(file("map.ot"), std::ios::binary)
            << "# Octomap OcTree file\nid OcTree\nsize " << size << "\nres " << resolution
            << "\ndata\n"
            << std::string(5, '\xFF');
        return complaint("map.ot");
    };
    for (const char* resolution : {"1e-300", "1e300", "1e-5", "1000", "nan", "-1", "0", "x",
                                   "0.05x", "0.05 x", "0,05", ""}) {
        EXPECT_NE(ofHeader("1", resolution).find("map.ot: res: "), std::string::npos) << resolution;
    }
    for (const char* size : {"1e9", "1.0", "-1", "1x", "1 1", "18446744073709551616", ""}) {
        EXPECT_NE(ofHeader(size, "0.1").find("map.ot: size: "), std::string::npos) << size;
    }
    // The children of a node that the header does not have are not made.
    std::ofstream(file("more.ot"), std::ios::binary)
        << "# Octomap OcTree file\nid OcTree\nsize 1\nres 0.1\ndata\n"
        << std::string("\0\0\0\0\xFF", 5);
    EXPECT_NE(complaint("more.ot").find("it has more than 1 nodes, in its header 1"),
              std::string::npos)
        << complaint("more.ot");
}

TEST_F(MapFile, EmptyMapsAreMaps) {
    const TexturedOcTree map(0.1);
    saveTexturedOcTree(map, file("map.ot"));
    saveColorOcTree(map, file("grey.ot"));
    saveBinaryOcTree(map, file("map.bt"));
    for (const char* name : {"map.ot", "grey.ot", "map.bt"}) {
        EXPECT_EQ(loadTexturedOcTree(file(name))->size(), 0U) << name;
    }
}

TEST_F(MapFile, UnwritableFoldersAreErrors) {
    EXPECT_THROW(saveTexturedOcTree(TexturedOcTree(0.1), file("no/such/folder/map.ot")),
                 InputError);
}

}  // namespace
}  // namespace photonav
