// SPDX-License-Identifier: BSD-3-Clause
// Files are read and written in the same way whatever the locale of the program is.
#include <gtest/gtest.h>

#include <locale>

#include "check/given_trajectory.hpp"
#include "config/config.hpp"
#include "dataset/trajectory.hpp"
#include "io/folder_transaction.hpp"
#include "map/octree_file.hpp"
#include "map/point_cloud.hpp"
#include "result/json_values.hpp"
#include "scene/scene.hpp"
#include "temporary_folder.hpp"

namespace photonav {
namespace {

using test::contentOf;
using test::TemporaryFolder;

/// Numbers as in "1.234,5".
struct German : std::numpunct<char> {
    char do_decimal_point() const override { return ','; }
    char do_thousands_sep() const override { return '.'; }
    std::string do_grouping() const override { return "\3"; }
};

/// The program's locale as long as it is there.
class GermanLocale {
  public:
    GermanLocale()
        : before_(std::locale::global(std::locale(std::locale::classic(), new German))) {}
    GermanLocale(const GermanLocale&) = delete;
    GermanLocale& operator=(const GermanLocale&) = delete;
    ~GermanLocale() { std::locale::global(before_); }

  private:
    std::locale before_;
};

TEST(Locale, ConfigsAndScenes) {
    const std::string file = PHOTONAV_SOURCE_DIR "/config/stripes.yaml";
    const std::string config = toYaml(loadConfig(file, {"noise.motion=[0.5, 1, 1.5, 0, 0, 0]"}));
    const auto box = loadScene(loadConfig(file, {}).sceneFile).boundingBox();
    const GermanLocale german;
    EXPECT_EQ(toYaml(loadConfig(file, {"noise.motion=[0.5, 1, 1.5, 0, 0, 0]"})), config);
    EXPECT_TRUE(loadScene(loadConfig(file, {}).sceneFile).boundingBox().isApprox(box, 0.));
}

TEST(Locale, MapsCloudsAndManifests) {
    const TemporaryFolder folder;
    TexturedOcTree map(0.05);
    for (int i = 0; i < 1500; ++i) map.updateNode(octomap::point3d(0.05F * i, 0.F, 0.F), true);
    const GermanLocale german;
    const std::string file = folder.file("map.ot");
    saveTexturedOcTree(map, file);
    EXPECT_NE(contentOf(file).find("\nres 0.05"), std::string::npos);
    EXPECT_EQ(loadTexturedOcTree(file)->size(), map.size());

    std::string points;
    for (int i = 0; i < 1000; ++i) points += "1.5 2.5 3.5 0.5\n";
    const auto cloud =
        folder.write("cloud.ply",
                     "ply\nformat ascii 1.0\nelement vertex 1000\nproperty float x\n"
                     "property float y\nproperty float z\nproperty float intensity\nend_header\n" +
                         points);
    std::vector<double> lengths;
    PointCloudFile(cloud).read(
        [&](const ScanPoint& point) { lengths.push_back(point.p_w.norm()); });
    EXPECT_EQ(lengths, std::vector<double>(1000, Eigen::Vector3d(1.5, 2.5, 3.5).norm()));

    const auto target = folder.path() / "result";
    for (int i = 0; i < 2; ++i) {
        FolderTransaction transaction(target);
        std::ofstream(transaction.path() / "large") << std::string(5000, ' ');
        transaction.commit();
    }
    EXPECT_NE(contentOf(target / ".photonav").find("\n5000 "), std::string::npos);
}

TEST(Locale, TrajectoriesAndResults) {
    const TemporaryFolder folder;
    const Trajectory trajectory{{1305031102.5, Pose::Identity()},
                                {1305031103.5, Pose(Eigen::Translation3d(1234.5, 0.25, -0.125))}};
    const nlohmann::json result{{"length", 1234.5}, {"vertices", 12345}};
    const std::string text = jsonText(result), file = folder.file("path.tum");
    writeTrajectory(file, trajectory);
    const std::string written = contentOf(file);
    const GermanLocale german;
    EXPECT_EQ(jsonText(result), text);
    writeTrajectory(file, trajectory);
    EXPECT_EQ(contentOf(file), written);
    const Trajectory read = readTrajectory(file);
    ASSERT_EQ(read.size(), 2U);
    EXPECT_EQ(read[1].T_w_c.translation(), Eigen::Vector3d(1234.5, 0.25, -0.125));
    const auto table = folder.write("given.csv", "x,y,z\n1234.5,2,3\n2,2.25,3\n");
    EXPECT_EQ(readGivenTrajectory(table, Pose::Identity()).poses[0].T_w_b.translation().x(),
              1234.5);
}

}  // namespace
}  // namespace photonav
