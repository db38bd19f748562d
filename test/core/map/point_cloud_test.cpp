// SPDX-License-Identifier: BSD-3-Clause
#include "map/point_cloud.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "io/error.hpp"
#include "map/map_fusion.hpp"
#include "scene/texture.hpp"
#include "temporary_folder.hpp"

namespace photonav {
namespace {

using test::messageOf;
using test::TemporaryFolder;

const std::string kXyz = "property float x\nproperty float y\nproperty float z\n";
const std::string kRgb = "property uchar red\nproperty uchar green\nproperty uchar blue\n";
const std::string kCamera =
    "element camera 1\nproperty float view_px\nproperty float view_py\nproperty float view_pz\n";

std::string header(const std::string& format, int count, const std::string& rest) {
    return "ply\nformat " + format + " 1.0\ncomment a scan\nelement vertex " +
           std::to_string(count) + "\n" + rest + "end_header\n";
}

template <class T>
std::string bytes(T value, bool swapped) {
    std::string result(sizeof(T), '\0');
    std::memcpy(result.data(), &value, sizeof(T));
    if (swapped) std::reverse(result.begin(), result.end());
    return result;
}

std::vector<ScanPoint> pointsOf(const std::string& file) {
    std::vector<ScanPoint> points;
    PointCloudFile(file).read([&](const ScanPoint& p) { points.push_back(p); });
    return points;
}

std::string readingError(const std::string& file) {
    return messageOf<InputError>([&] { pointsOf(file); });
}

TEST(PointCloud, ReadsTheSamePointsInEveryEncoding) {
    const TemporaryFolder folder;
    const std::string ascii = folder.write("a.ply", header("ascii", 2, kXyz + kRgb + kCamera) +
                                                        "1 2 3 255 255 255\n-4 .5 0 255 0 0\n"
                                                        "7 8 9\n");
    for (const bool big : {false, true}) {
        std::string body;
        for (const float x : {1.F, 2.F, 3.F}) body += bytes(x, big);
        body += "\xff\xff\xff";
        for (const float x : {-4.F, .5F, 0.F}) body += bytes(x, big);
        body += std::string("\xff\0\0", 3);
        for (const float x : {7.F, 8.F, 9.F}) body += bytes(x, big);
        const auto file = folder.write(
            "b.ply",
            header(big ? "binary_big_endian" : "binary_little_endian", 2, kXyz + kRgb + kCamera) +
                body);
        const auto expected = pointsOf(ascii), points = pointsOf(file);
        ASSERT_EQ(points.size(), 2U);
        for (int i : {0, 1}) {
            EXPECT_EQ(points[i].p_w, expected[i].p_w);
            EXPECT_EQ(points[i].grey, expected[i].grey);
        }
        EXPECT_EQ(points[1].p_w, Eigen::Vector3d(-4., .5, 0.));
        EXPECT_NEAR(points[0].grey, 1., 1e-6);
        EXPECT_NEAR(points[1].grey, greyOfLinear({1., 0., 0.}), 1e-6) << "red, as in textures";
        EXPECT_EQ(PointCloudFile(file).scanner(), Eigen::Vector3d(7., 8., 9.));
        EXPECT_EQ(PointCloudFile(ascii).scanner(), Eigen::Vector3d(7., 8., 9.));
    }
}

TEST(PointCloud, IntensityIsAColourToo) {
    const TemporaryFolder folder;
    const auto real = folder.write(
        "r.ply", header("ascii", 1, kXyz + "property float intensity\n") + "0 0 0 0.25\n");
    EXPECT_EQ(pointsOf(real)[0].grey, 0.25F);
    const auto sixteen = folder.write(
        "s.ply", header("ascii", 1, kXyz + "property ushort intensity\n") + "0 0 0 65535\n");
    EXPECT_EQ(pointsOf(sixteen)[0].grey, 1.F);
    EXPECT_FALSE(PointCloudFile(real).scanner());
    const auto percent = folder.write(
        "p.ply", header("ascii", 1, kXyz + "property float intensity\n") + "0 0 0 25\n");
    EXPECT_NE(readingError(percent).find("not in [0, 1]"), std::string::npos);
}

TEST(PointCloud, LeavesOutWhatHasNoEcho) {
    const TemporaryFolder folder;
    const auto file = folder.write(
        "n.ply", header("ascii", 3, kXyz + kRgb) + "nan 0 0 1 1 1\n0 0 inf 1 1 1\n1 1 1 1 1 1\n");
    EXPECT_EQ(pointsOf(file).size(), 1U);
    EXPECT_EQ(PointCloudFile(file).size(), 3U);
    const auto far =
        folder.write("f.ply", header("ascii", 2, kXyz + kRgb) + "1e38 0 0 1 1 1\n1 1 1 1 1 1\n");
    EXPECT_EQ(pointsOf(far).size(), 1U);
}

TEST(PointCloud, SaysWhatIsWrongWithAFile) {
    const TemporaryFolder folder;
    const auto rejects = [&](const std::string& content, const std::string& reason) {
        const std::string file = folder.write("bad.ply", content);
        const std::string message = readingError(file);
        EXPECT_NE(message.find(file), std::string::npos) << message;
        EXPECT_NE(message.find(reason), std::string::npos) << message;
        EXPECT_EQ(message.find('\n'), std::string::npos) << message;
    };
    rejects("", "not a PLY file");
    rejects("solid\n", "not a PLY file");
    rejects("ply\nformat ascii 1.0\n", "does not end");
    rejects(header("ascii", 1, kXyz) + "0 0 0\n", "no colour");
    rejects(header("ascii", 1, "property float x\n" + kRgb), "no property 'y'");
    rejects(header("ascii", 0, kXyz + kRgb), "no points");
    rejects(header("ascii", 2, kXyz + kRgb) + "0 0 0 1 1 1\n", "cut short: 1 of 2");
    rejects(header("ascii", 1, kXyz + kRgb) + "0 0 zero 1 1 1\n", "not a point");
    rejects(header("binary_little_endian", 1000000000, kXyz + kRgb) + "12345", "cut short: 0 of");
    rejects("ply\nformat ascii 1.0\nelement vertex 1000000000000000000\n" + kXyz + kRgb +
                "element camera 1\nproperty float view_px\nend_header\n0 0 0 1 1 1\n",
            "cut short: 1 of 1000000000000000000 points");
    rejects(header("middle_endian", 1, kXyz + kRgb), "middle_endian");
    rejects(header("ascii", 1, "property quad x\n"), "unknown type 'quad'");
    EXPECT_NE(readingError(folder.file("none.ply")).find("no such file"), std::string::npos);
}

const TexturedOcTreeNode* cellAt(const TexturedOcTree& map, double x, double y, double z) {
    return map.search(octomap::point3d(float(x), float(y), float(z)));
}

/// A floor of two greys at z = 0.02, seen from 1.5 m above.
void twoGreys(const std::function<void(const ScanPoint&)>& visit) {
    for (double x = -1.; x < 1.; x += 0.01) {
        for (double y = -1.; y < 1.; y += 0.01) visit({{x, y, 0.02}, x < 0. ? 0.2F : 0.8F});
    }
}

TEST(FuseScan, FloorIsOccupiedAndTheWayToItFree) {
    TexturedOcTree map(0.05);
    fuseScan(map, twoGreys, Eigen::Vector3d(0., 0., 1.5), 40.);
    const auto* left = cellAt(map, -0.52, 0.52, 0.02);
    ASSERT_NE(left, nullptr);
    EXPECT_TRUE(map.isNodeOccupied(left));
    EXPECT_NEAR(left->faces[5].mean, 0.2, 1e-6);
    EXPECT_FALSE(left->faces[4].observed()) << "nothing was seen from below";
    EXPECT_NEAR(*cellAt(map, 0.52, 0.52, 0.02)->meanGrey(), 0.8, 1e-6);
    EXPECT_FALSE(map.isNodeOccupied(cellAt(map, -0.02, 0.02, 0.7)));
    EXPECT_EQ(cellAt(map, 0.52, 0.52, -0.07), nullptr) << "below the floor nothing is known";
}

TEST(FuseScan, WithoutAScannerNothingIsFree) {
    TexturedOcTree map(0.05);
    fuseScan(map, twoGreys, std::nullopt, 40.);
    EXPECT_EQ(cellAt(map, -0.02, 0.02, 0.7), nullptr);
    const auto* cell = cellAt(map, -0.52, 0.52, 0.02);
    ASSERT_NE(cell, nullptr);
    EXPECT_NEAR(cell->faces[5].mean, 0.2, 1e-6);
    EXPECT_NEAR(cell->faces[4].mean, 0.2, 1e-6) << "seen from all sides";
    EXPECT_FALSE(cell->faces[0].observed()) << "covered by its neighbour";
}

TEST(FuseScan, FartherThanTheRangeThereIsOnlyFreeSpace) {
    TexturedOcTree map(0.05);
    fuseScan(map, twoGreys, Eigen::Vector3d(0., 0., 1.5), 1.);
    EXPECT_EQ(cellAt(map, 0.02, 0.02, 0.02), nullptr);
    EXPECT_FALSE(map.isNodeOccupied(cellAt(map, 0.02, 0.02, 0.7)));
    const auto far = [](const std::function<void(const ScanPoint&)>& visit) {
        visit({{1e6, 0., 0.}, 0.F});
    };
    EXPECT_THROW(fuseScan(map, far, Eigen::Vector3d::Zero().eval(), 1e9), std::invalid_argument);
    const auto farther = [](const std::function<void(const ScanPoint&)>& visit) {
        visit({{1e308, 0., 0.}, 0.F});  // the length of the ray overflows
    };
    EXPECT_THROW(fuseScan(map, farther, Eigen::Vector3d(-1e308, 0., 0.), 1.),
                 std::invalid_argument);
}

}  // namespace
}  // namespace photonav
