// SPDX-License-Identifier: BSD-3-Clause
#include "map/textured_octree.hpp"

#include <gtest/gtest.h>
#include <octomap/ColorOcTree.h>
#include <octomap/OcTree.h>

#include <cstring>
#include <filesystem>
#include <fstream>
#include <numbers>

#include "core/photometry/synthetic_floor.hpp"
#include "io/error.hpp"
#include "map/map_fusion.hpp"
#include "map/octree_file.hpp"
#include "map/point_cloud.hpp"
#include "map/surface_cloud.hpp"
#include "temporary_folder.hpp"

namespace photonav {
namespace {

using test::contentOf;
using test::floorView;
using test::kDown;
using test::lookDown;

constexpr unsigned kTop = 5;  // face +z

const TexturedOcTreeNode* at(const TexturedOcTree& map, double x, double y, double z) {
    return map.search(x, y, z);
}

struct Look {
    Camera camera;
    Pose T_c_w;
    View view;
};

/// Straight down on the carpet, which lies in the cells from z = 0 to 0.05.
Look overCarpet(double x, double height) {
    const Camera camera = makeCamera(160, 120, 1.2);
    const Pose T_c_w = lookDown(x, 0.01, height, kDown);
    return {camera, T_c_w, floorView(camera, T_c_w, test::carpet, 0.02)};
}

/// A few views of a carpet from above.
TexturedOcTree carpetMap(double resolution = 0.05) {
    TexturedOcTree map(resolution);
    const Camera camera = makeCamera(160, 120, 1.2);
    for (const double x : {-0.3, 0., 0.3}) {
        const Pose T_c_w = lookDown(x, 0.1, 1.5, kDown, x);
        fuse(map, floorView(camera, T_c_w, test::carpet, 0.02), camera, T_c_w);
    }
    return map;
}

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
    EXPECT_NEAR(node->getColor().g, 255. * *at(map, 0.125, 0.125, 0.025)->meanGrey(), 0.51);

    // And back: occupancy as it was, all faces the same grey.
    const auto back = loadTexturedOcTree(file("grey.ot"));
    EXPECT_EQ(back->size(), map.size());
    const auto* cell = at(*back, 0.125, 0.125, 0.025);
    EXPECT_NEAR(cell->faces[0].mean, node->getColor().g / 255., 1e-6);
    EXPECT_EQ(cell->faces[0], cell->faces[kTop]);
    EXPECT_FALSE(at(*back, 0.125, 0.125, 0.525)->meanGrey());
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
    withLine(now, "# photonav map, version 3\n");
    EXPECT_NE(complaint("changed.ot").find("version: unknown"), std::string::npos);
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
    EXPECT_NE(complaint("none.ot").find("cannot be opened"), std::string::npos);
    EXPECT_NE(complaint("").find("cannot be opened"), std::string::npos);
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
    EXPECT_NE(complaint("count.ot").find("promises 12 nodes"), std::string::npos);
    std::ofstream(file("deep.ot"), std::ios::binary)
        << "# Octomap OcTree file\nid OcTree\nsize 99\nres 0.1\ndata\n"
        << std::string(100000, '\x01');
    EXPECT_NE(complaint("deep.ot").find("below the cells"), std::string::npos);
}

TEST_F(MapFile, HeadersThatCannotBeAreRefusedBeforeTheirNodesAreRead) {
    const auto ofHeader = [&](const std::string& size, const std::string& resolution) {
        std::ofstream(file("map.ot"), std::ios::binary)
            << "# Octomap OcTree file\nid OcTree\nsize " << size << "\nres " << resolution
            << "\ndata\n"
            << std::string(5, '\xFF');
        return complaint("map.ot");
    };
    for (const char* resolution : {"1e-300", "1e300", "1e-5", "1000", "nan", "-1", "0", "x"}) {
        EXPECT_NE(ofHeader("1", resolution).find("map.ot: res: "), std::string::npos) << resolution;
    }
    // The children of a node that the header does not have are not made.
    std::ofstream(file("more.ot"), std::ios::binary)
        << "# Octomap OcTree file\nid OcTree\nsize 1\nres 0.1\ndata\n"
        << std::string("\0\0\0\0\xFF", 5);
    EXPECT_NE(complaint("more.ot").find("promises 1 nodes (after 1 nodes)"), std::string::npos)
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

TEST(TexturedOcTree, CopiesAreDeep) {
    const TexturedOcTree map = carpetMap();
    TexturedOcTree copy(map);
    EXPECT_TRUE(copy == map);
    copy.search(0.125, 0.125, 0.025)->faces[kTop].mean = 0.F;
    EXPECT_FALSE(copy == map);
}

TEST(TexturedOcTree, PruningKeepsFaces) {
    TexturedOcTree map(0.1);
    for (int i = 0; i < 8; ++i) {
        map.setNodeValue(octomap::OcTreeKey(32768 + i % 2, 32768 + i / 2 % 2, 32768 + i / 4), 1.F,
                         true);
    }
    map.search(0.05, 0.05, 0.05)->faces[kTop].observe(0.25F, 1.F);
    map.updateInnerOccupancy();
    map.prune();
    EXPECT_EQ(map.getNumLeafNodes(), 8U);
    EXPECT_EQ(at(map, 0.05, 0.05, 0.05)->faces[kTop].mean, 0.25F);
    EXPECT_FALSE(at(map, 0.15, 0.05, 0.05)->faces[kTop].observed());

    for (auto leaf = map.begin_leafs(); leaf != map.end_leafs(); ++leaf) {
        leaf->faces = {};
        leaf->faces[kTop].observe(0.25F, 1.F);
    }
    map.prune();
    EXPECT_EQ(map.getNumLeafNodes(), 1U);
    EXPECT_EQ(at(map, 0.15, 0.15, 0.05)->faces[kTop].mean, 0.25F);
    map.updateNode(octomap::OcTreeKey(32768, 32768, 32768), false);  // splits the node again
    EXPECT_EQ(map.getNumLeafNodes(), 8U);
    EXPECT_EQ(at(map, 0.15, 0.15, 0.05)->faces[kTop].mean, 0.25F);
}

TEST(TexturedOcTree, BrickUpdateEqualsSingleUpdates) {
    TexturedOcTree bricks(0.1), singles(0.1);
    std::mt19937_64 random(3);
    const auto ignore = [](TexturedOcTreeNode&, unsigned) {};
    for (int i = 0; i < 200; ++i) {
        const octomap::OcTreeKey corner(32764 + 4 * (random() % 3), 32764 + 4 * (random() % 3),
                                        32768);
        const std::uint64_t hit = i % 3 == 0 ? random() & random() : 0;
        const std::uint64_t missed = i % 2 == 0 ? ~0ULL : random();
        bricks.updateBrick(corner, missed, hit, ignore);
        for (unsigned cell = 0; cell < 64; ++cell) {
            const unsigned x = cell & 3U, y = cell >> 2U & 3U, z = cell >> 4U;
            const unsigned bit = brickBit(x, y, z);
            if (((hit | missed) >> bit & 1U) == 0) continue;
            singles.updateNode(octomap::OcTreeKey(corner[0] + x, corner[1] + y, corner[2] + z),
                               (hit >> bit & 1U) != 0);
        }
    }
    EXPECT_TRUE(bricks == singles);
}

TEST(Fuse, SeparatesFreeOccupiedAndUnknownCells) {
    const auto [camera, T_c_w, view] = overCarpet(0.01, 1.52);
    TexturedOcTree map(0.05);
    fuse(map, view, camera, T_c_w);
    for (double z = 0.075; z < 1.5; z += 0.05) {
        const auto* free = at(map, 0.01, 0.01, z);
        ASSERT_NE(free, nullptr) << z;
        EXPECT_FALSE(map.isNodeOccupied(free)) << z;
    }
    const auto* surface = at(map, 0.01, 0.01, 0.025);
    ASSERT_NE(surface, nullptr);
    EXPECT_TRUE(map.isNodeOccupied(surface));
    EXPECT_EQ(at(map, 0.01, 0.01, -0.025), nullptr) << "behind the surface";
    EXPECT_EQ(at(map, 2.01, 0.01, 0.025), nullptr) << "outside the image";
    EXPECT_EQ(at(map, 0.01, 0.01, 1.60), nullptr) << "behind the camera";
}

TEST(Fuse, CarvesUpToTheRangeAndLearnsNothingFromMissingDepth) {
    auto [camera, T_c_w, view] = overCarpet(0.01, 3.02);
    TexturedOcTree map(0.05);
    fuse(map, view, camera, T_c_w, {.maxRange = 2.});
    EXPECT_FALSE(map.isNodeOccupied(at(map, 0.01, 0.01, 1.1)));
    EXPECT_EQ(at(map, 0.01, 0.01, 0.9), nullptr);
    EXPECT_EQ(at(map, 0.01, 0.01, 0.025), nullptr);

    for (const float depth : {0.F, -1.F, std::nanf(""), 0.1F}) {
        view.depth = depth;
        TexturedOcTree untouched(0.05);
        fuse(untouched, view, camera, T_c_w);
        EXPECT_EQ(untouched.size(), 0U) << depth;
    }
}

TEST(Fuse, FacesTowardTheCameraTakeTheMeanGrey) {
    const Camera camera = makeCamera(160, 120, 1.2);
    TexturedOcTree map(0.05);
    for (const auto& [grey, height] : {std::pair{0.3, 1.52}, {0.5, 1.52}}) {
        const Pose T_c_w = lookDown(0.31, 0.01, height, kDown);
        fuse(map,
             floorView(
                 camera, T_c_w, [g = grey](double, double) { return g; }, 0.02),
             camera, T_c_w);
    }
    const auto* cell = at(map, 0.01, 0.01, 0.025);
    EXPECT_NEAR(cell->faces[kTop].mean, 0.4, 1e-6);
    // The camera stands toward +x, but the next floor cell covers that face; below is never seen.
    for (unsigned f = 0; f < 5; ++f) EXPECT_FALSE(cell->faces[f].observed()) << f;

    // A cell on its own shows its side as well, with the smaller weight of a slanted look.
    auto [sameCamera, T_c_w, view] = overCarpet(0.31, 1.52);
    TexturedOcTree lone(0.05);
    for (unsigned v = 0; v < camera.height; ++v) {
        for (unsigned u = 0; u < camera.width; ++u) {
            const Eigen::Vector3d p = test::pointOf(view, camera, T_c_w, u, v);
            if (p.x() < 0. || p.x() >= 0.05 || p.y() < 0. || p.y() >= 0.05) view.depth[v][u] = 0.F;
        }
    }
    fuse(lone, view, camera, T_c_w);
    const auto* slanted = at(lone, 0.01, 0.01, 0.025);
    ASSERT_NE(slanted, nullptr);
    EXPECT_NEAR(slanted->faces[1].weight / slanted->faces[kTop].weight, 0.285 / 1.495, 1e-3);
    EXPECT_NEAR(slanted->faces[1].mean, slanted->faces[kTop].mean, 1e-6);
    EXPECT_FALSE(slanted->faces[0].observed());
    EXPECT_FALSE(slanted->faces[2].observed() || slanted->faces[3].observed());
}

TEST(Fuse, ConstantFloorsStayConstantToTheBit) {
    const Camera camera = makeCamera(160, 120, 1.2);
    TexturedOcTree map(0.05);
    for (const double yaw : {0., 0.4, 0.8}) {
        const Pose T_c_w = lookDown(0.2 * yaw, 0.01, 1.52, 1.1, yaw);
        View view = floorView(
            camera, T_c_w, [](double, double) { return 0.; }, 0.02);
        view.intensity = 0.7F;
        fuse(map, view, camera, T_c_w);
    }
    for (auto leaf = map.begin_leafs(); leaf != map.end_leafs(); ++leaf) {
        for (const FaceTexture& face : leaf->faces) {
            ASSERT_TRUE(!face.observed() || face.mean == 0.7F) << face.mean;
        }
    }
}

TEST(Fuse, DropsPixelsAtDepthEdges) {
    const Look look = overCarpet(0.01, 1.52);
    View view = look.view;
    for (unsigned v = 0; v < look.camera.height; ++v) {
        for (unsigned u = 0; u < 80; ++u) view.depth[v][u] = 1.F;
        view.depth[v][80] = 1.17F;  // smeared between the box at 1 m and the floor
    }
    const auto smeared = [&](double depthJump) {
        TexturedOcTree map(0.05);
        fuse(map, view, look.camera, look.T_c_w, {.depthJump = depthJump});
        int count = 0;
        for (auto leaf = map.begin_leafs(); leaf != map.end_leafs(); ++leaf) {
            const bool between = leaf.getZ() > 0.1 && leaf.getZ() < 0.45;
            count += static_cast<int>(between && map.isNodeOccupied(*leaf));
        }
        return count;
    };
    EXPECT_GT(smeared(1e9), 0);
    EXPECT_EQ(smeared(0.05), 0);
}

TEST(Fuse, RefusesInputThatDoesNotFit) {
    const Camera camera = makeCamera(16, 12, 1.2);
    TexturedOcTree map(0.05);
    View view = floorView(camera, lookDown(0., 0., 1., kDown), test::carpet);
    EXPECT_THROW(fuse(map, view, makeCamera(17, 12, 1.2), Pose::Identity()), std::invalid_argument);
    Pose broken = Pose::Identity();
    broken.translation().x() = std::nan("");
    EXPECT_THROW(fuse(map, view, camera, broken), std::invalid_argument);
    Pose far = Pose::Identity();
    far.translation().x() = 1e5;
    EXPECT_THROW(fuse(map, view, camera, far), std::invalid_argument);
    view.depth = 1e9F;
    EXPECT_THROW(fuse(map, view, camera, Pose::Identity(), {.maxRange = 1e9}),
                 std::invalid_argument);
    EXPECT_EQ(map.size(), 0U);
}

}  // namespace
}  // namespace photonav
