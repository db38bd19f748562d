// SPDX-License-Identifier: BSD-3-Clause
#include "scene/mesh_io.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <cstring>
#include <opencv2/imgcodecs.hpp>

#include "io/error.hpp"
#include "temporary_folder.hpp"

namespace photonav {
namespace {

using test::messageOf;
using test::TemporaryFolder;

std::string complaint(const std::string& file) {
    return messageOf<InputError>([&] { loadMesh(file); });
}

std::string bytes(const std::vector<float>& values) {
    std::string result(values.size() * sizeof(float), '\0');
    std::memcpy(result.data(), values.data(), result.size());
    return result;
}

/// Left half dark, right half light.
std::string twoTexels() {
    const cv::Mat image = (cv::Mat_<std::uint8_t>(2, 2) << 51, 204, 102, 255);
    std::vector<std::uint8_t> png;
    cv::imencode(".png", image, png);
    return {png.begin(), png.end()};
}

/// One triangle (0,0,0) (1,0,0) (0,1,0) under a node that doubles it and shifts it by 10 along y.
/// @param image JSON of the image, material and texture properties
std::string gltf(const std::string& material, std::size_t extraBytes = 0) {
    return R"({"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}],
 "nodes": [{"mesh": 0, "scale": [2, 2, 2], "translation": [0, 10, 0]}],
 "meshes": [{"primitives": [{"attributes": {"POSITION": 0, "TEXCOORD_0": 1}, "material": 0}]}],
 "buffers": [{"uri": "mesh.bin", "byteLength": )" +
           std::to_string(60 + extraBytes) + R"(}],
 "bufferViews": [{"buffer": 0, "byteOffset": 0, "byteLength": 36},
                 {"buffer": 0, "byteOffset": 36, "byteLength": 24},
                 {"buffer": 0, "byteOffset": 60, "byteLength": )" +
           std::to_string(std::max<std::size_t>(extraBytes, 1)) + R"(}],
 "accessors": [
  {"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3", "min": [0,0,0], "max": [1,1,0]},
  {"bufferView": 1, "componentType": 5126, "count": 3, "type": "VEC2"}],
 )" + material +
           "}";
}

std::string triangleBytes() { return bytes({0, 0, 0, 1, 0, 0, 0, 1, 0, /*uv*/ 0, 0, 1, 0, 0, 1}); }

TEST(MeshIo, GltfIsTurnedUprightWithItsNodesApplied) {
    const TemporaryFolder folder;
    folder.write("mesh.bin", triangleBytes());
    const Scene scene = loadMesh(folder.write("mesh.gltf", gltf(R"("materials":
        [{"pbrMetallicRoughness": {"baseColorFactor": [0.5, 0.5, 0.5, 1]}}])")));
    ASSERT_EQ(scene.triangles.size(), 1U);
    const auto& corners = scene.triangles[0].corners;
    // File (x, y, z), y up, becomes world (x, -z, y).
    EXPECT_TRUE(corners[0].isApprox(Eigen::Vector3f(0.F, 0.F, 10.F)));
    EXPECT_TRUE(corners[1].isApprox(Eigen::Vector3f(2.F, 0.F, 10.F)));
    EXPECT_TRUE(corners[2].isApprox(Eigen::Vector3f(0.F, 0.F, 12.F)));
    // A linear factor of 0.5 is stored by a camera as 0.735.
    EXPECT_NEAR(scene.textures.at(scene.triangles[0].texture).image[0][0], 0.7354, 1e-3);

    const Scene asIs = loadMesh(folder.file("mesh.gltf"), {.up = UpAxis::z, .scale = 0.5});
    EXPECT_TRUE(asIs.triangles[0].corners[2].isApprox(Eigen::Vector3f(0.F, 6.F, 0.F)));
}

TEST(MeshIo, GltfTextureBesideAndInsideTheFile) {
    const TemporaryFolder folder;
    const std::string png = twoTexels();
    folder.write("a.png", png);
    const std::string material = R"("textures": [{"source": 0}], "materials":
        [{"pbrMetallicRoughness": {"baseColorTexture": {"index": 0}}}], "images": )";
    folder.write("mesh.bin", triangleBytes() + png);
    const auto outside = folder.write("outside.gltf", gltf(material + R"([{"uri": "a.png"}])"));
    const auto inside = folder.write(
        "inside.gltf",
        gltf(material + R"([{"bufferView": 2, "mimeType": "image/png"}])", png.size()));
    for (const auto& file : {outside, inside}) {
        const Scene scene = loadMesh(file);
        const ImageF& image = scene.textures.at(scene.triangles.at(0).texture).image;
        ASSERT_EQ(image.getWidth(), 2U);
        EXPECT_NEAR(image[0][0], 51. / 255., 1e-4);
        EXPECT_NEAR(image[1][0], 102. / 255., 1e-4);
        // glTF's (0, 0) is the image's upper left, as ours.
        EXPECT_TRUE(scene.triangles[0].uv[0].isZero(1e-6F));
        EXPECT_TRUE(scene.triangles[0].uv[2].isApprox(Eigen::Vector2f(0.F, 1.F)));
    }
}

TEST(MeshIo, ObjKeepsItsAxesAndCountsVUpward) {
    const TemporaryFolder folder;
    folder.write("a.png", twoTexels());
    folder.write("mesh.mtl", "newmtl skin\nKd 1 1 1\nmap_Kd a.png\n");
    const Scene scene = loadMesh(folder.write("mesh.obj",
                                              "mtllib mesh.mtl\nusemtl skin\n"
                                              "v 0 0 1\nv 1 0 1\nv 1 1 1\nv 0 1 1\n"
                                              "vt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\n"
                                              "f 1/1 2/2 3/3 4/4\n"));
    ASSERT_EQ(scene.triangles.size(), 2U);
    for (const Triangle& triangle : scene.triangles) {
        for (int i = 0; i < 3; ++i) {
            EXPECT_FLOAT_EQ(triangle.corners[i].z(), 1.F);
            EXPECT_NEAR(triangle.uv[i].x(), triangle.corners[i].x(), 1e-6);
            EXPECT_NEAR(triangle.uv[i].y(), 1.F - triangle.corners[i].y(), 1e-6);
        }
    }
    EXPECT_NEAR(scene.textures.at(scene.triangles[0].texture).image[0][1], 0.8, 1e-4);
}

TEST(MeshIo, PlyVertexColoursAreInterpolated) {
    const TemporaryFolder folder;
    const Scene scene = loadMesh(folder.write("mesh.ply", R"(ply
format ascii 1.0
element vertex 3
property float x
property float y
property float z
property uchar red
property uchar green
property uchar blue
element face 1
property list uchar int vertex_indices
end_header
0 0 2 51 51 51
1 0 2 204 204 204
0 1 2 255 255 255
3 0 1 2
)"));
    ASSERT_EQ(scene.triangles.size(), 1U);
    const Triangle& triangle = scene.triangles[0];
    const Texture& ramp = scene.textures.at(triangle.texture);
    const auto grey = [&](const Eigen::Vector2f& uv) { return ramp.at(uv.cast<double>()); };
    EXPECT_NEAR(grey(triangle.uv[0]), 0.2, 1e-4);
    EXPECT_NEAR(grey(triangle.uv[1]), 0.8, 1e-4);
    EXPECT_NEAR(grey(triangle.uv[2]), 1.0, 1e-4);
    EXPECT_NEAR(grey(0.5F * (triangle.uv[0] + triangle.uv[1])), 0.5, 1e-4);
}

TEST(MeshIo, ComplaintsNameFileAndReason) {
    const TemporaryFolder folder;
    const std::string missing = folder.file("missing.obj");
    EXPECT_EQ(complaint(missing), missing + ": no such file");
    const auto empty = folder.write("empty.ply", "");
    EXPECT_EQ(complaint(empty), empty + ": the file is empty");
    const auto unknown = folder.write("mesh.xyzabc", "hello");
    EXPECT_EQ(complaint(unknown).rfind(unknown + ": ", 0), 0U);
    const auto broken = folder.write("broken.glb", "glTF, but not really");
    EXPECT_EQ(complaint(broken).rfind(broken + ": ", 0), 0U);
    EXPECT_EQ(complaint(broken).find('\n'), std::string::npos);

    const auto flat = folder.write("flat.obj", "v 0 0 0\nv 1 0 0\nv 2 0 0\nf 1 2 3\n");
    EXPECT_EQ(complaint(flat), flat + ": all triangles are degenerate");
    const auto notFinite = folder.write("nan.obj", "v 0 0 0\nv 1 0 0\nv 0 nan 0\nf 1 2 3\n");
    EXPECT_NE(complaint(notFinite).find("vertex 2 of mesh"), std::string::npos)
        << complaint(notFinite);

    folder.write("mesh.mtl", "newmtl skin\nKd 1 1 1\nmap_Kd gone.png\n");
    const auto textured = folder.write("textured.obj",
                                       "mtllib mesh.mtl\nusemtl skin\nv 0 0 0\nv 1 0 0\nv 0 1 0\n"
                                       "vt 0 0\nvt 1 0\nvt 0 1\nf 1/1 2/2 3/3\n");
    EXPECT_EQ(complaint(textured),
              textured + ": texture: no such image '" + folder.file("gone.png") + "'");
}

/// assimp would reserve what the header says, and leave the colour of a missing library white.
TEST(MeshIo, HeadersAndLibrariesAreNotTrusted) {
    const TemporaryFolder folder;
    const std::string xyz = "property float x\nproperty float y\nproperty float z\n";
    const std::string faces = "property list uchar int vertex_indices\nend_header\n";
    for (const std::string format : {"ascii", "binary_little_endian"}) {
        const std::string head = "ply\nformat " + format + " 1.0\nelement vertex ";
        const auto vertices =
            folder.write("vertices.ply", head + "1000000000\n" + xyz + "element face 1\n" + faces);
        EXPECT_NE(complaint(vertices).find("element vertex: 1000000000"), std::string::npos);
        const auto many =
            folder.write("faces.ply", head + "3\n" + xyz + "element face 1000000000\n" + faces +
                                          "0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n");
        EXPECT_NE(complaint(many).find("element face: 1000000000"), std::string::npos);
    }
    const auto obj =
        folder.write("box.obj", "mtllib gone.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    EXPECT_EQ(complaint(obj), obj + ": mtllib: no such file 'gone.mtl'");
}

/// Assimp reads wild indices, and follows nodes by recursion.
TEST(MeshIo, IndicesAndNodesAreNotTrusted) {
    const TemporaryFolder folder;
    const std::string head =
        "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
        "property float z\nelement face 1\nproperty list uchar int vertex_indices\n";
    const std::string vertices = "0 0 0\n1 0 0\n0 1 0\n";
    for (const char* face : {"3 0 1 1000000\n", "3 0 1 -1\n", "4 0 1 2 77777777\n"}) {
        const auto wild = folder.write("wild.ply", head + "end_header\n" + vertices + face);
        EXPECT_EQ(complaint(wild).rfind(wild + ": ", 0), 0U) << complaint(wild);
    }
    const auto endless = folder.write("endless.ply", head);
    EXPECT_EQ(complaint(endless), endless + ": end_header: missing");
    const auto typed = folder.write("typed.ply",
                                    "ply\nformat ascii 1.0\nelement vertex 3\n"
                                    "property quaternion x\nend_header\n");
    EXPECT_NE(complaint(typed).find("unknown type 'quaternion'"), std::string::npos);

    const auto empty =
        folder.write("empty.ply", "ply\nformat ascii 1.0\nelement vertex 4000000000\nend_header\n");
    EXPECT_EQ(complaint(empty), empty + ": element vertex: has no properties");
    const auto unknown =
        folder.write("unknown.ply", "ply\nformat ascii 1.0\nwords x\nend_header\n");
    EXPECT_EQ(complaint(unknown), unknown + ": 'words' in the header is not known");

    std::string nodes = R"({"children": [1]})";
    for (int i = 1; i < 100000; ++i) nodes += fmt::format(", {{\"children\": [{}]}}", i + 1);
    const std::string scene = R"({"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes":
 [0]}], "nodes": [)";
    const auto deep = folder.write("deep.gltf", scene + nodes + ", {}]}");
    EXPECT_EQ(complaint(deep), deep + ": nodes: nested deeper than 500, or in a circle");
    const auto circle =
        folder.write("circle.gltf", scene + R"({"children": [1]}, {"children": [0]}]})");
    EXPECT_EQ(complaint(circle), circle + ": nodes: nested deeper than 500, or in a circle");
    const auto shared = folder.write(
        "shared.gltf", scene + R"({"children": [2]}, {"children": [2]}, {"children": []}]})");
    EXPECT_EQ(complaint(shared), shared + ": nodes[1].children: node 2 is listed twice");
    const auto twice = folder.write("twice.gltf", scene + R"({"children": [1, 1]}, {}]})");
    EXPECT_EQ(complaint(twice), twice + ": nodes[0].children: node 1 is listed twice");
    ASSERT_EQ(mkfifo(folder.file("pipe").c_str(), 0600), 0);
    const auto pipe = folder.write(
        "pipe.gltf",
        R"({"asset": {"version": "2.0"}, "buffers": [{"byteLength": 1, "uri": "pipe"}]})");
    EXPECT_EQ(complaint(pipe), pipe + ": buffers: 'pipe' is no file");
    const auto brackets = folder.write("brackets.gltf", std::string(200000, '['));
    EXPECT_EQ(complaint(brackets), brackets + ": JSON nested deeper than 200");
}

/// Assimp leaves out triangles that it cannot make, and knows no extension that it does not read.
TEST(MeshIo, GltfIsReadWholeOrNotAtAll) {
    const TemporaryFolder folder;
    folder.write("mesh.bin", triangleBytes() + std::string("\0\0\1\0\2\0\0\0\1\0\x9\0", 12));
    const auto with = [&](const std::string& place, const std::string& text) {
        std::string mesh = gltf(R"("materials": [{}])", 12);
        const auto at = mesh.find(place);
        EXPECT_NE(at, std::string::npos) << place;
        return folder.write("mesh.gltf", mesh.replace(at, place.size(), text));
    };
    const auto complaintOf = [&](const std::string& place, const std::string& text) {
        const std::string file = with(place, text);
        return complaint(file).substr(file.size() + 2);
    };
    std::string indexed = with(R"("material": 0)", R"("material": 0, "indices": 2)");
    std::string text = test::contentOf(indexed);
    const std::string last = R"("count": 3, "type": "VEC2"})";
    text.replace(
        text.find(last), last.size(),
        last + R"(, {"bufferView": 2, "componentType": 5123, "count": 6, "type": "SCALAR"})");
    indexed = folder.write("mesh.gltf", text);
    EXPECT_EQ(complaint(indexed), indexed + ": a triangle has a vertex that is not there");
    text.replace(text.find(R"("count": 6)"), 10, R"("count": 3)");
    EXPECT_EQ(loadMesh(folder.write("mesh.gltf", text)).triangles.size(), 1U);

    EXPECT_EQ(complaintOf(R"("scale": [2, 2, 2])", R"("rotation": [0, 0, 0, 0])"),
              "nodes: rotation [0,0,0,0] is no unit quaternion");
    EXPECT_EQ(complaintOf(R"("scene": 0)", R"("scene": 0, "extensionsRequired": ["KHR_draco"])"),
              R"(extensionsRequired: "KHR_draco" is not known)");
    EXPECT_EQ(complaintOf(R"("byteOffset": 36)", R"("byteOffset": -36)"),
              "bufferViews: byteOffset -36 is no whole number from 0 to 4e+09");
    EXPECT_EQ(complaintOf(R"("byteLength": 24)", R"("byteLength": 24, "byteStride": 2147483648)"),
              "bufferViews: byteStride 2147483648 is no whole number from 0 to 252");
}

/// What is checked must be what assimp reads: it takes text that is no UTF-8, the first of two
/// equal keys, and nodes by name in version 1.
TEST(MeshIo, GltfIsReadInOneWayOnly) {
    const TemporaryFolder folder;
    const std::string head =
        R"({"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}])";
    const std::string circle = R"("nodes": [{"children": [1]}, {"children": [0]}])";
    const auto complaintOf = [&](const std::string& text) {
        const auto file = folder.write("mesh.gltf", text);
        return complaint(file).substr(file.size() + 2);
    };
    EXPECT_EQ(complaintOf(head + ", " + circle + R"(, "nodes": [{}]})"),
              "nodes: is there twice in the same JSON object");
    EXPECT_EQ(complaintOf(head + R"(, "name": ")" + "\xff" + R"(", )" + circle + "}"),
              "is not JSON");
    EXPECT_EQ(complaintOf(R"({"asset": {"version": "1.0"}, "nodes": {"a": {"children": ["a"]}}})"),
              R"(asset.version: "1.0" is not "2.0")");
    EXPECT_EQ(complaintOf("[]"), R"(asset.version: null is not "2.0")");
    EXPECT_EQ(complaintOf(head + R"(, "nodes": {}})"), "nodes: expected a list");
}

/// Assimp would read each of these as what its first bytes look like.
TEST(MeshIo, FilesAreReadAsTheirNameSays) {
    const TemporaryFolder folder;
    const auto stl = folder.write("mesh.stl", "solid a\nendsolid a\n");
    EXPECT_EQ(complaint(stl),
              stl + ": '.stl' is no mesh that can be read; known: .gltf, .glb, .obj, .ply");
    const auto ply = folder.write("ply.obj",
                                  "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\n"
                                  "property float y\nproperty float z\nelement face 1\n"
                                  "property list uchar int vertex_indices\nend_header\n"
                                  "0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n");
    EXPECT_NE(complaint(ply), "");
    EXPECT_THROW(loadMesh("/dev/null"), InputError);
}

/// Debian's assimp asserts that every face has a corner.
TEST(MeshIo, AFaceWithoutCornersDoesNotEndTheProgram) {
    const TemporaryFolder folder;
    const std::string head =
        "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
        "property float z\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n"
        "0 0 0\n1 0 0\n0 1 0\n";
    const auto file = folder.write("face.ply", head + "0\n");
    EXPECT_TRUE(complaint(file).starts_with(file + ": the file breaks a rule of its format"))
        << complaint(file);
    const auto word = folder.write("word.ply", head + "x\n");
    EXPECT_EQ(complaint(word), word + ": element face: number 0: a list has no length");
}

/// Assimp makes room for whatever a list claims, and goes on where a file ends.
TEST(MeshIo, TheBodyOfAPlyFileHoldsWhatItsHeaderSays) {
    const TemporaryFolder folder;
    const auto plyOf = [](const std::string& format, const std::string& lengthType) {
        return "ply\nformat " + format +
               " 1.0\nelement vertex 3\nproperty uchar x\nproperty uchar y\nproperty uchar z\n"
               "element face 1\nproperty list " +
               lengthType + " uchar vertex_indices\nend_header\n";
    };
    const auto complaintOf = [&](const std::string& text) {
        const auto file = folder.write("mesh.ply", text);
        const std::string reason = complaint(file);
        return reason.empty() ? reason : reason.substr(file.size() + 2);
    };
    const std::string text = plyOf("ascii", "uint") + "0 0 0\n1 0 0\n0 1 0\n";
    EXPECT_EQ(complaintOf(text + "3 0 1 2"), "");
    EXPECT_EQ(complaintOf(text + "3 0 1\n"), "element face: number 0: the file ends here");
    EXPECT_EQ(complaintOf(text + "3 0 1,5 2\n"), "element face: number 0: '1,5' is not a number");
    EXPECT_EQ(complaintOf(text + "3 0 1.5 2\n"), "element face: number 0: '1.5' is not an integer");
    EXPECT_EQ(complaintOf(text.substr(0, text.size() - 4)),
              "element vertex: number 2: the file ends here");
    const std::string vertices("\0\0\0\1\0\0\0\1\0", 9), corners("\0\1\2", 3);
    for (const auto& [format, three, many] :
         {std::tuple("binary_little_endian", std::string("\3\0\0\0", 4), "\xf0\xff\xff\xff"),
          std::tuple("binary_big_endian", std::string("\0\0\0\3", 4), "\xff\xff\xff\xf0")}) {
        const std::string binary = plyOf(format, "uint") + vertices;
        EXPECT_EQ(complaintOf(binary + three + corners), "") << format;
        EXPECT_EQ(complaintOf(binary + many + corners),
                  "element face: number 0: 4294967280 values do not fit into the rest of the file");
        EXPECT_EQ(complaintOf(binary + three.substr(0, 2)),
                  "element face: number 0: the file ends here");
    }
    EXPECT_EQ(complaintOf(plyOf("ascii", "float")),
              "element face: a list cannot have a length of type 'float'");
}

/// A few bytes can ask for more than any memory holds.
TEST(MeshIo, InstancesOfGltfHaveALimit) {
    const TemporaryFolder folder;
    const auto complaintOf = [&](const std::string& count, const std::string& primitives,
                                 const std::string& nodes) {
        const auto file = folder.write(
            "mesh.gltf",
            R"({"asset": {"version": "2.0"}, "accessors": [{"componentType": 5126, "type": "VEC3",)"
            R"( "count": )" +
                count + R"(}], "meshes": [{"primitives": [)" + primitives + R"(]}], "nodes": [)" +
                nodes + "]}");
        return complaint(file).substr(file.size() + 2);
    };
    const auto repeated = [](const std::string& entry, int times) {
        std::string list = entry;
        for (int i = 1; i < times; ++i) list += "," + entry;
        return list;
    };
    const std::string primitive = R"({"attributes": {"POSITION": 0}})", node = R"({"mesh": 0})";
    const std::string reason = "meshes: more than 3e+07 corners of triangles in all instances";
    EXPECT_EQ(complaintOf("40000000", "", "{}"), reason);
    EXPECT_EQ(complaintOf("1000000", repeated(primitive, 40), node), reason);
    EXPECT_EQ(complaintOf("1000000", primitive, repeated(node, 40)), reason);
    EXPECT_EQ(complaintOf("3", repeated("{}", 100001), node), "primitives: more than 100000");
    EXPECT_EQ(complaintOf("3", primitive, repeated(node, 100001)), "nodes: more than 100000");
}

TEST(MeshIo, SomeDegenerateTrianglesAreDropped) {
    const TemporaryFolder folder;
    const auto file =
        folder.write("mesh.obj", "v 0 0 0\nv 1 0 0\nv 2 0 0\nv 0 1 0\nf 1 2 3\nf 1 2 4\nf 1 1 2\n");
    EXPECT_EQ(loadMesh(file).triangles.size(), 1U);
}

}  // namespace
}  // namespace photonav
