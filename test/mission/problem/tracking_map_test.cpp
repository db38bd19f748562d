// SPDX-License-Identifier: BSD-3-Clause
#include "problem/tracking_map.hpp"

#include <gtest/gtest.h>

#include "geometry/camera.hpp"
#include "io/error.hpp"
#include "map/map_fusion.hpp"
#include "map/octree_file.hpp"
#include "render/mesh_renderer.hpp"
#include "temporary_folder.hpp"

namespace photonav {
namespace {

TEST(TrackingMap, ErrorsGoByItsKind) {
    EXPECT_EQ(surfaceError(MapKind::mesh, 0.1), 0.);
    EXPECT_NEAR(surfaceError(MapKind::cells, 0.1), 0.058, 1e-9);
    EXPECT_NEAR(surfaceError(MapKind::surfaces, 0.1), 0.01, 1e-9);
}

/// A wall at 2 m.
class LoadedMap : public testing::Test {
  protected:
    LoadedMap() {
        addPlane(wall, {-2., -2., 2.}, {4., 0., 0.}, {0., 4., 0.},
                 addTexture(wall, valueNoise({})));
        MeshRenderer(wall).render(camera, Pose::Identity(), view);
    }
    TrackingMap saved(const TexturedOcTree& map) const {
        saveTexturedOcTree(map, folder.file("map.ot"));
        return loadTrackingMap(folder.file("map.ot"));
    }

    test::TemporaryFolder folder;
    Scene wall;
    Camera camera = makeCamera(48, 32, 1.);
    View view;
};

TEST_F(LoadedMap, OfCellsHasSurfacesOnlyWhereSomeWereFused) {
    TexturedOcTree map(0.1);
    map.updateNode(0.05, 0.05, 2.05, true);
    const TrackingMap cells = saved(map);
    EXPECT_EQ(cells.kind, MapKind::cells);
    EXPECT_NEAR(cells.surfaceError(), 0.058, 1e-9);
    fuse(map, view, camera, Pose::Identity());
    const TrackingMap surfaces = saved(map);
    EXPECT_EQ(surfaces.kind, MapKind::surfaces);
    EXPECT_NEAR(surfaces.surfaceError(), 0.01, 1e-9);
    ASSERT_NE(surfaces.octree, nullptr);
    EXPECT_EQ(surfaces.scene, nullptr);
    View shown;
    surfaces.views->render(camera, Pose::Identity(), shown);
    EXPECT_NEAR(shown.depth[16][24], 2., 0.02);
    Pose aside = Pose::Identity();
    aside.translation().x() = 1.2;
    surfaces.views->render(camera, aside, shown);  // through unknown cells
    EXPECT_NEAR(shown.depth[16][29], 2., 0.02);
}

TEST_F(LoadedMap, OfASceneIsAMesh) {
    folder.write("scene.yaml",
                 "textures:\n  - {name: grey, type: uniform, grey: 0.5}\n"
                 "planes:\n  - {corner: [-1, -1, 2], u: [2, 0, 0], v: [0, 2, 0], texture: grey}\n");
    const TrackingMap map = loadTrackingMap(folder.file("scene.yaml"));
    EXPECT_EQ(map.kind, MapKind::mesh);
    EXPECT_EQ(map.resolution(), 0.);
    EXPECT_EQ(map.octree, nullptr);
    ASSERT_NE(map.scene, nullptr);
    EXPECT_NEAR(map.scene->boundingBox().min().z(), 2., 1e-6);
    View shown;
    map.views->render(camera, Pose::Identity(), shown);
    EXPECT_NEAR(shown.depth[16][24], 2., 1e-4);
}

TEST_F(LoadedMap, ThatCannotBeReadIsNamed) {
    const std::string file = folder.write("map.ot", "nothing");
    const std::string message = test::messageOf<InputError>([&] { loadTrackingMap(file); });
    EXPECT_EQ(message.find(file), 0U) << message;
}

}  // namespace
}  // namespace photonav
