// SPDX-License-Identifier: BSD-3-Clause
#include "app/interchange/other_program.hpp"
#include "core/map/carpet_map.hpp"
#include "map/point_cloud.hpp"
#include "map/surface_cloud.hpp"
#include "render/mesh_renderer.hpp"
#include "scene/mesh_io.hpp"
#include "temporary_folder.hpp"

namespace photonav {
namespace {

/// What a camera sees that looks down on the room from (2, 2, 6).
class RoomFromAbove {
  public:
    explicit RoomFromAbove(const std::string& mesh) {
        MeshRenderer(loadMesh(mesh)).render(camera_, T_c_w_, view_);
    }
    void expect(const Eigen::Vector3d& point, double grey) const {
        const Eigen::Vector2d pixel = camera_.project(T_c_w_ * point);
        const auto column = unsigned(std::lround(pixel.x())),
                   row = unsigned(std::lround(pixel.y()));
        EXPECT_NEAR(view_.intensity[row][column], grey, 0.01) << point.transpose();
        EXPECT_NEAR(view_.depth[row][column], 6. - point.z(), 1e-3) << point.transpose();
    }

  private:
    Camera camera_ = makeCamera(200, 200, 1.);
    Pose T_c_w_ = test::lookDown(2., 2., 6., test::kDown, 0.);
    View view_;
};

class Blender : public testing::Test {
  protected:
    void SetUp() override {
        if (!isInstalled("blender")) GTEST_SKIP() << "blender is not installed";
        saveSurfaceCloud(test::carpetMap(), folder.file("surfaces.ply"));
        run = otherProgram(fmt::format(
            "blender -b --factory-startup --python-exit-code 1 --python {}/test/scripts/"
            "blender_room.py -- {}",
            PHOTONAV_SOURCE_DIR, folder.path().string()));
        ASSERT_EQ(run.exitCode, 0) << run.output;
    }

    test::TemporaryFolder folder;
    Execution run;
};

TEST_F(Blender, WritesRoomsThatLookAsTheyShould) {
    for (const char* mesh : {"room.glb", "room.gltf", "room.obj"}) {
        SCOPED_TRACE(mesh);
        const RoomFromAbove room(folder.file(mesh));
        room.expect({0.25, 0.25, 0.}, 0.);
        room.expect({0.75, 0.25, 0.}, 0.2);
        room.expect({0.75, 0.75, 0.}, 0.8);
        room.expect({3.25, 0.75, 0.}, 0.2);
        room.expect({3.2, 3.1, 1.5}, 0.5);
    }
    const RoomFromAbove room(folder.file("room.ply"));
    room.expect({0.25, 0.25, 0.}, 0.4);  // vertex colours: of PLY, Blender writes no texture
    room.expect({3.2, 3.1, 1.5}, 1.);    // and white for what has none
}

TEST_F(Blender, OpensTheSurfaces) {
    Eigen::AlignedBox3d box;
    std::size_t points = 0;
    PointCloudFile(folder.file("surfaces.ply")).read([&](const ScanPoint& point) {
        box.extend(point.p_w);
        ++points;
    });
    const std::size_t line = run.output.find("\ncloud ");
    ASSERT_NE(line, std::string::npos) << run.output;
    std::istringstream fields(run.output.substr(line + 7));
    std::size_t found = 0;
    Eigen::Vector3d least, most;
    fields >> found >> least.x() >> least.y() >> least.z() >> most.x() >> most.y() >> most.z();
    EXPECT_EQ(found, points);
    EXPECT_TRUE(least.isApprox(box.min(), 1e-5)) << run.output;
    EXPECT_TRUE(most.isApprox(box.max(), 1e-5)) << run.output;
}

}  // namespace
}  // namespace photonav
