// SPDX-License-Identifier: BSD-3-Clause
#include "scene/obj_text.hpp"

#include <gtest/gtest.h>

#include <opencv2/imgcodecs.hpp>

#include "scene/mesh_io.hpp"
#include "temporary_folder.hpp"

namespace photonav {
namespace {

using test::TemporaryFolder;

/// As Blender writes them; assimp has 0.6 where no colour is given.
TEST(ObjText, MaterialsOfObjAreWhiteUnlessTheySayOtherwise) {
    const TemporaryFolder folder;
    cv::imwrite(folder.file("a.png"), cv::Mat(2, 2, CV_8U, cv::Scalar(204)));
    folder.write("mesh.mtl",
                 "# two\r\nnewmtl skin\r\nmap_Kd a.png\r\n newmtl half\rKd 0.5 0.5 0.5");
    const Scene scene = loadMesh(folder.write("mesh.obj",
                                              "mtllib mesh.mtl\nv 0 0 1\nv 1 0 1\nv 1 1 1\n"
                                              "vt 0 0\nvt 1 0\nvt 1 1\nusemtl skin\n"
                                              "f 1/1 2/2 3/3\nusemtl half\nf 1/1 3/3 2/2\n"));
    ASSERT_EQ(scene.triangles.size(), 2U);
    EXPECT_NEAR(scene.textures.at(scene.triangles[0].texture).image[0][1], 0.8, 1e-4);
    EXPECT_NEAR(scene.textures.at(scene.triangles[1].texture).image[0][0], 0.7354, 1e-3);
}

/// With lines and faces of one vertex, assimp's importer writes beyond its arrays.
TEST(ObjText, LinesAndPointsOfObjAreNotRead) {
    const TemporaryFolder folder;
    const Scene scene = loadMesh(folder.write("mesh.obj",
                                              "v 0 0 1\nv 1 0 1\nv 1 1 1\nv 0 1 1\n"
                                              "p -2 4 2 -1\nl 4\nl 1 99\n \tp 99\n"
                                              "f 1 2 3\nl 2\nl 2 3 \\\n2 2\nf 1 3 4\n"));
    EXPECT_EQ(scene.triangles.size(), 2U);
}

}  // namespace
}  // namespace photonav
