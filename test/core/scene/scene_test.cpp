// SPDX-License-Identifier: BSD-3-Clause
#include "scene/scene.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <numbers>
#include <opencv2/imgcodecs.hpp>

#include "core/photometry/synthetic_floor.hpp"
#include "io/error.hpp"
#include "photometry/photometric.hpp"
#include "render/mesh_renderer.hpp"
#include "scene/scene_yaml.hpp"
#include "temporary_folder.hpp"

namespace photonav {
namespace {

using test::messageOf;
using test::TemporaryFolder;

double area(const Scene& scene) {
    double sum = 0.;
    for (const Triangle& t : scene.triangles) {
        sum += 0.5 * (t.corners[1] - t.corners[0]).cross(t.corners[2] - t.corners[0]).norm();
    }
    return sum;
}

/// Where the texture puts the point, in metres.
Eigen::Vector2f metres(const Scene& scene, const Triangle& triangle, int corner) {
    return triangle.uv[corner].cwiseProduct(scene.textures[triangle.texture].size.cast<float>());
}

TEST(Texture, NoiseIsReproducibleTilesAndStaysInRange) {
    const NoiseOptions options{.size = {2., 1.}, .cells = {0.3, 0.1}, .seed = 5};
    const Texture noise = valueNoise(options);
    EXPECT_EQ(noise.image.getWidth(), 200U);
    EXPECT_EQ(noise.image.getHeight(), 100U);
    EXPECT_EQ(test::pixels(noise.image), test::pixels(valueNoise(options).image));
    NoiseOptions other = options;
    other.seed = 6;
    EXPECT_NE(test::pixels(noise.image), test::pixels(valueNoise(other).image));

    float largestStep = 0.F;
    float largestStepAtSeam = 0.F;
    for (unsigned v = 0; v < 100; ++v) {
        for (unsigned u = 0; u < 200; ++u) {
            EXPECT_GE(noise.image[v][u], 0.1F);
            EXPECT_LE(noise.image[v][u], 0.9F);
            const float step = std::abs(noise.image[v][(u + 1) % 200] - noise.image[v][u]);
            (u == 199 ? largestStepAtSeam : largestStep) =
                std::max(u == 199 ? largestStepAtSeam : largestStep, step);
        }
    }
    EXPECT_GT(largestStep, 0.01F);
    EXPECT_LE(largestStepAtSeam, largestStep);
}

TEST(Texture, StripesBeginAtTheOffsetAndHaveSoftEdges) {
    const Texture bars = stripes({.width = 0.5, .softEdge = 0.1, .offset = 0.2});
    EXPECT_NEAR(bars.at({0.45, 0.}), 0.1, 1e-6);  // dark from 0.2 to 0.7
    EXPECT_NEAR(bars.at({0.95, 3.}), 0.9, 1e-6);
    EXPECT_NEAR(bars.at({0.2, 0.}), 0.5, 1e-6);    // in the middle of the ramp
    EXPECT_NEAR(bars.at({0.225, 0.}), 0.3, 1e-6);  // 0.8 of grey over 0.1 m
    EXPECT_NEAR(bars.at({0.145, 0.}), 0.9, 1e-6);  // before it begins
    EXPECT_NEAR(bars.at({10.45, 0.}), 0.1, 1e-5);  // repeats every metre
    const Texture across = stripes({.width = 0.5, .softEdge = 0.1, .offset = 0.2, .alongV = true});
    EXPECT_NEAR(across.at({3., 0.225}), 0.3, 1e-6);
}

TEST(Texture, PatchBordersAreFilteredToTheTexel) {
    const Texture white = uniformTexture(0.9);
    const Texture black = uniformTexture(0.1);
    const Texture floor = patchedTexture(white, {{{0.303, 0.}, {1., 1.}, &black}}, {1., 1.}, 0.01);
    EXPECT_FLOAT_EQ(floor.image[50][29], 0.9F);
    EXPECT_NEAR(floor.image[50][30], 0.9 - 0.7 * 0.8, 1e-6);  // 70 % of the texel is covered
    EXPECT_FLOAT_EQ(floor.image[50][31], 0.1F);
}

TEST(Texture, ColourFilesBecomeGreyByLumaInLinearLight) {
    const TemporaryFolder folder;
    cv::Mat image(1, 3, CV_8UC3);
    image.at<cv::Vec3b>(0, 0) = {255, 255, 255};
    image.at<cv::Vec3b>(0, 1) = {0, 255, 0};
    image.at<cv::Vec3b>(0, 2) = {100, 100, 100};
    cv::imwrite(folder.file("a.png"), image);
    const ImageF grey = readGrey(folder.file("a.png"));
    EXPECT_NEAR(grey[0][0], 1., 1e-6);
    EXPECT_NEAR(grey[0][1], 1.055 * std::pow(0.7152, 1. / 2.4) - 0.055, 1e-5);
    EXPECT_NEAR(grey[0][2], 100. / 255., 1e-5);  // grey stays what the file stores
}

TEST(Scene, PlanesAreMappedInMetres) {
    Scene scene;
    const auto texture = addTexture(scene, valueNoise({.size = {2., 4.}}));
    addPlane(scene, {1., 2., 3.}, {6., 0., 0.}, {0., 5., 0.}, texture, {0.5, 0.25});
    ASSERT_EQ(scene.triangles.size(), 2U);
    EXPECT_NEAR(area(scene), 30., 1e-5);
    EXPECT_TRUE(scene.triangles[0].corners[2].isApprox(Eigen::Vector3f(7.F, 7.F, 3.F)));
    EXPECT_TRUE(metres(scene, scene.triangles[0], 2).isApprox(Eigen::Vector2f(6.5F, 5.25F)));
    EXPECT_THROW(addPlane(scene, {0., 0., 0.}, {1., 0., 0.}, {2., 0., 0.}, texture),
                 std::invalid_argument);
    EXPECT_THROW(addPlane(scene, {0., 0., 0.}, {1., 0., 0.}, {0., 1., 0.}, 7),
                 std::invalid_argument);
}

TEST(Scene, BoxesAreClosed) {
    Scene scene;
    addBox(scene, {1., 2., 0.}, {2., 4., 3.}, addTexture(scene, uniformTexture(0.5)));
    EXPECT_EQ(scene.triangles.size(), 12U);
    EXPECT_NEAR(area(scene), 2. * (1. * 2. + 2. * 3. + 1. * 3.), 1e-5);
    EXPECT_TRUE(scene.boundingBox().min().isApprox(Eigen::Vector3d(1., 2., 0.)));
    EXPECT_TRUE(scene.boundingBox().max().isApprox(Eigen::Vector3d(2., 4., 3.)));
}

TEST(Scene, WallsAreMitredAtTheirJoints) {
    Scene scene;
    const auto texture = addTexture(scene, uniformTexture(0.5));
    addWall(scene, {.footprint = {{0., 0.}, {4., 0.}, {4., 3.}}, .height = 2., .thickness = 0.2},
            texture);
    // Two segments of four sides, and two ends.
    EXPECT_EQ(scene.triangles.size(), 20U);
    const double outer = 4.1 + 3.1;
    const double inner = 3.9 + 2.9;
    const double top = 4. * 0.2 + 3. * 0.2;
    EXPECT_NEAR(area(scene), 2. * (outer + inner) + 2. * top + 2. * 0.2 * 2., 1e-4);

    Scene ring;
    addTexture(ring, uniformTexture(0.5));
    addWall(
        ring,
        {.footprint = {{0., 0.}, {4., 0.}, {4., 3.}, {0., 3.}}, .thickness = 0.2, .closed = true},
        0);
    EXPECT_EQ(ring.triangles.size(), 32U);
    EXPECT_TRUE(ring.boundingBox().max().isApprox(Eigen::Vector3d(4.1, 3.1, 2.5), 1e-6));
    EXPECT_THROW(addWall(ring, {.footprint = {{0., 0.}}}, 0), std::invalid_argument);
    EXPECT_THROW(addWall(ring, {.footprint = {{0., 0.}, {1., 0.}, {0., 0.}}}, 0),
                 std::invalid_argument);
}

// --- YAML ---------------------------------------------------------------------------------------

TEST(SceneYaml, ComplaintsNameFileKeyAndReason) {
    const TemporaryFolder folder;
    const auto complaint = [&](const std::string& text) {
        const std::string file = folder.write("scene.yaml", text);
        return messageOf<InputError>([&] { loadScene(file); });
    };
    const std::string white = "textures: [{name: white, type: uniform, grey: 0.9}]\n";
    const std::string file = folder.file("scene.yaml");
    EXPECT_EQ(complaint(white + "plains: []\n"),
              file + ": plains: unknown key, did you mean 'planes'?");
    EXPECT_EQ(complaint("texture: [{name: a}]\n"
                        "boxes: [{min: [0, 0, 0], max: [1, 1, 1], texture: a}]"),
              file + ": texture: unknown key, did you mean 'textures'?");
    EXPECT_EQ(complaint("textures: [{name: a, type: noise, cels: [1]}]"),
              file + ": textures[0].cels: unknown key, did you mean 'textures[0].cells'?");
    EXPECT_EQ(complaint(white + "boxes: [{min: [0, 0, 0], max: [1, 1, 1], texture: wite}]"),
              file + ": boxes[0].texture: no texture 'wite' above, did you mean 'white'?");
    EXPECT_EQ(complaint("textures: [{name: a, type: image, file: no.png}]"),
              file + ": textures[0].file: no such image '" + folder.file("no.png") + "'");
    EXPECT_EQ(complaint(white + "boxes: [{min: [0, 0, 0], max: [1, 0, 1], texture: white}]"),
              file + ": boxes[0].max: box: max must be beyond min");
    const std::string square = "u: [1, 0, 0], v: [0, 1, 0], texture: white";
    EXPECT_EQ(complaint(white + "planes: [{corner: [0, 0, 1e39], " + square + "}]"),
              file + ": planes[0].u: scene: surface farther than 100000 m from the origin");
    EXPECT_EQ(
        complaint(white + "planes: [{corner: [0, 0, 0], offset: [1e308, 0], " + square + "}]"),
        file + ": planes[0].u: scene: texture offset beyond 100000 m");
    EXPECT_EQ(
        complaint(white + "walls: [{footprint: [[0, 0], [1, 0]], height: 1e39, texture: white}]"),
        file + ": walls[0].footprint: scene: surface farther than 100000 m from the origin");
    EXPECT_EQ(complaint(white + "planes: [{corner: [0, 0, 0], u: [1, 0, 0], texture: white}]"),
              file + ": planes[0].v: missing");
    EXPECT_EQ(complaint(white), file + ": the scene has no surfaces");
    EXPECT_NE(complaint("textures: [{name: a, type: noise, mean: 0.9}]").find("leaves [0, 1]"),
              std::string::npos);
    EXPECT_NE(complaint("textures: [{name: a, type: uniform, grey: .nan}]").find("grey"),
              std::string::npos);
}

TEST(SceneYaml, TexturesOfAllTheMemoryAreRefusedBeforeTheyAreMade) {
    const TemporaryFolder folder;
    const auto complaint = [&](const std::string& texture) {
        const std::string file = folder.write(
            "scene.yaml",
            "textures: [{name: a, " + texture + "}]\n" +
                "planes: [{corner: [0, 0, 0], u: [1, 0, 0], v: [0, 1, 0], texture: a}]");
        const std::string message = messageOf<InputError>([&] { loadSceneYaml(file, 1e4); });
        return message.empty() ? message : message.substr(file.size() + 2);
    };
    EXPECT_EQ(complaint("type: noise, size: [1, 0.9]"), "");
    for (const char* large : {"type: noise, size: [1, 1.1]", "type: checker, cell: 0.6",
                              "type: stripes, width: 60", "type: noise, size: [1e308, 1e308]"}) {
        EXPECT_TRUE(
            complaint(large).starts_with("textures[0].texel: with this the scene's textures"))
            << complaint(large);
    }
    EXPECT_TRUE(complaint("type: noise, size: [1, 1], texel: 1, cells: [0.001]")
                    .starts_with("textures[0].cells: "));
}

TEST(SceneYaml, ImagesAreFoundBesideTheFile) {
    const TemporaryFolder folder;
    cv::imwrite(folder.file("poster.png"), cv::Mat(20, 40, CV_8U, cv::Scalar(51)));
    const Scene scene = loadScene(folder.write("scene.yaml", R"(
textures: [{name: poster, type: image, file: poster.png, width: 2}]
planes: [{corner: [0, 0, 0], u: [2, 0, 0], v: [0, 1, 0], texture: poster}]
)"));
    EXPECT_NEAR(scene.textures[0].image[3][4], 0.2, 1e-5);
    EXPECT_TRUE(scene.textures[0].size.isApprox(Eigen::Vector2d(2., 1.)));
    EXPECT_TRUE(scene.triangles[0].uv[2].isApprox(Eigen::Vector2f(1.F, 1.F)));
}

/// Information of a downward view in a scene that comes with photonav.
Matrix6 informationAt(const MeshRenderer& renderer, double x, double y) {
    const Camera camera = makeCamera(188, 120, 70. * std::numbers::pi / 180.);
    const Pose T_w_b(Eigen::Translation3d(x, y, 2.));
    View view;
    renderer.render(camera, (T_w_b * cameraMount(std::numbers::pi / 2.)).inverse(), view);
    return photometricInformation(view, camera);
}

MeshRenderer shipped(const std::string& name) {
    return MeshRenderer(
        loadScene(fmt::format("{}/config/scenes/{}.yaml", PHOTONAV_SOURCE_DIR, name)));
}

TEST(ShippedScenes, TwoTexturesInformOverTheTextureOnly) {
    const MeshRenderer renderer = shipped("two_textures");
    EXPECT_EQ(informationAt(renderer, -1., -0.5), Matrix6::Zero());
    EXPECT_EQ(informationAt(renderer, 3.5, 9.5), Matrix6::Zero());
    const Matrix6 texture = informationAt(renderer, 8., 4.);
    EXPECT_GT(texture.selfadjointView<Eigen::Lower>().eigenvalues().minCoeff(), 1e3);
    EXPECT_GT(informationAt(renderer, 4.5, 4.).trace(), 0.);  // the border is a real edge
    const Eigen::AlignedBox3d box = renderer.scene().boundingBox();
    EXPECT_LT(box.min().x(), -1. - 1.7);
    EXPECT_GT(box.max().y(), 9.5 + 1.7);
}

TEST(ShippedScenes, EachStripedAreaInformsOneDirectionOnly) {
    const MeshRenderer renderer = shipped("stripes");
    // Looking down, the camera's x axis is the world's -y, its y axis the world's -x.
    constexpr int kAlongWorldY = 0;
    constexpr int kAlongWorldX = 1;
    const Matrix6 a = informationAt(renderer, 10.5, 10.);
    EXPECT_GT(a(kAlongWorldX, kAlongWorldX), 1e5);
    EXPECT_LT(a(kAlongWorldY, kAlongWorldY), 1e-6 * a(kAlongWorldX, kAlongWorldX));
    const Matrix6 b = informationAt(renderer, 21.5, -0.25);
    EXPECT_GT(b(kAlongWorldY, kAlongWorldY), 1e5);
    EXPECT_LT(b(kAlongWorldX, kAlongWorldX), 1e-6 * b(kAlongWorldY, kAlongWorldY));
    // Only the ends of its bars show both.
    EXPECT_GT(informationAt(renderer, 18.5, 0.)(kAlongWorldX, kAlongWorldX), 1e5);
    EXPECT_EQ(informationAt(renderer, 0., 0.), Matrix6::Zero());
    EXPECT_EQ(informationAt(renderer, 5., 19.), Matrix6::Zero());
    EXPECT_EQ(informationAt(renderer, 18.5, 10.), Matrix6::Zero());
}

TEST(ShippedScenes, TheFlatIsClosedAroundTheCamera) {
    const MeshRenderer renderer = shipped("room");
    const Camera camera = makeCamera(188, 120, 70. * std::numbers::pi / 180.);
    View view;
    for (const double yaw : {0., 1.5, 3., 4.5}) {
        renderer.render(camera, lookFrom({4.6, 1., 1.5}, 0.4, yaw), view);
        float least = 0.F;
        float most = 0.F;
        view.depth.getMinMaxValue(least, most);
        EXPECT_GT(least, 0.F);
        EXPECT_LT(most, 13.F);
    }
}

}  // namespace
}  // namespace photonav
