// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include "core/photometry/synthetic_floor.hpp"
#include "map/map_fusion.hpp"

namespace photonav {
namespace {

constexpr double kWall = 0.202;  // y of a wall that is higher and longer than the view [m]

/// Grey views of the wall and of the floor z = 0 before it.
View viewAlongWall(const Camera& camera, const Pose& T_c_w) {
    View view = test::floorView(camera, T_c_w, [](double, double) { return 0.5; });
    const Pose T_w_c = T_c_w.inverse();
    for (unsigned v = 0; v < camera.height; ++v) {
        for (unsigned u = 0; u < camera.width; ++u) {
            const Eigen::Vector3d d = T_w_c.linear() * camera.unproject(u, v, 1.);
            const double z = (kWall - T_w_c.translation().y()) / d.y();
            float& depth = view.depth[v][u];
            if (z > 0. && (depth == 0.F || z < depth)) depth = static_cast<float>(z);
            view.intensity[v][u] = 0.5F;
        }
    }
    return view;
}

/// The map shows the wall a few millimetres inside a row of cells, as far as the pose is wrong, and
/// rays close to it cross these cells. Where the image shows the wall no more, above the view, they
/// are not free: a robot would take them for the end of the wall.
TEST(FreeSpace, IsNotWhereRaysOnlyGrazeACell) {
    constexpr double kWrong = 0.008;
    const Camera camera = makeCamera(94, 60, 1.2);
    TexturedOcTree map(0.05);
    for (const double x : {0., 0.1, 0.2, 0.3}) {
        const View view = viewAlongWall(camera, test::lookDown(x, 0.32, 1., 0.7, 0.1));
        fuse(map, view, camera, test::lookDown(x, 0.32 - kWrong, 1., 0.7, 0.1));
    }
    int occupied = 0, free = 0, freeBeside = 0;
    for (double x = 0.225; x < 1.5; x += 0.05) {
        for (double z = 0.075; z < 1.; z += 0.05) {
            const auto* inWall = map.search(x, 0.175, z);
            const auto* beside = map.search(x, 0.225, z);
            if (inWall != nullptr) (map.isNodeOccupied(inWall) ? occupied : free) += 1;
            freeBeside += beside != nullptr && !map.isNodeOccupied(beside) ? 1 : 0;
        }
    }
    EXPECT_GT(occupied, 100);
    EXPECT_EQ(free, 0);
    EXPECT_GT(freeBeside, 100);
}

}  // namespace
}  // namespace photonav
