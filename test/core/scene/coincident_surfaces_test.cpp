// SPDX-License-Identifier: BSD-3-Clause
#include "scene/coincident_surfaces.hpp"

#include <gtest/gtest.h>

namespace photonav {
namespace {

Scene planeAt(const Eigen::Vector3d& corner, double width) {
    Scene scene;
    addPlane(scene, corner, {width, 0., 0.}, {0., width, 0.},
             addTexture(scene, uniformTexture(1.)));
    return scene;
}

TEST(CoincidentSurfaces, AreInOnePlaneAndOverlap) {
    const Scene floor = planeAt({0., 0., 0.}, 10.);
    EXPECT_TRUE(haveCoincidentSurfaces(planeAt({4., 4., 0.0005}, 0.1), floor));
    EXPECT_TRUE(haveCoincidentSurfaces(floor, planeAt({4., 4., 0.}, 0.1)));
    EXPECT_TRUE(haveCoincidentSurfaces(planeAt({8., 8., 0.}, 4.), floor));
    EXPECT_FALSE(haveCoincidentSurfaces(planeAt({4., 4., 0.01}, 0.1), floor));
    EXPECT_FALSE(haveCoincidentSurfaces(planeAt({10., 0., 0.}, 1.), floor));  // beside it
    Scene upright;
    addPlane(upright, {4., 4., -1.}, {2., 0., 0.}, {0., 0., 2.},
             addTexture(upright, uniformTexture(1.)));
    EXPECT_FALSE(haveCoincidentSurfaces(upright, floor));  // through it
}

TEST(CoincidentSurfaces, OfABoxOnTheFloorAreNotSeen) {
    const Scene floor = planeAt({0., 0., 0.}, 10.);
    Scene box = planeAt({7., 7., 1.}, 1.);
    addBox(box, {1., 1., 0.}, {2., 2., 1.}, 0);
    EXPECT_TRUE(haveCoincidentSurfaces(box, floor));
    const Scene sheets = withoutSolids(box);
    EXPECT_EQ(sheets.triangles.size(), 2U);
    EXPECT_FALSE(haveCoincidentSurfaces(sheets, floor));
}

TEST(Scene, AppendedSurfacesKeepTheirTextures) {
    Scene scene = planeAt({0., 0., 0.}, 1.);
    Scene other = planeAt({0., 0., 1.}, 1.);
    other.files = {"other.yaml"};
    scene.append(other);
    ASSERT_EQ(scene.triangles.size(), 4U);
    EXPECT_EQ(scene.textures.size(), 2U);
    EXPECT_EQ(scene.triangles[0].texture, 0U);
    EXPECT_EQ(scene.triangles[2].texture, 1U);
    EXPECT_EQ(scene.files, std::vector<std::string>{"other.yaml"});
}

}  // namespace
}  // namespace photonav
