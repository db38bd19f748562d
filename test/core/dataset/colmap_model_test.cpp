// SPDX-License-Identifier: BSD-3-Clause
#include "dataset/colmap_model.hpp"

#include <gtest/gtest.h>

#include "reason_of.hpp"
#include "temporary_folder.hpp"

namespace photonav {
namespace {

namespace fs = std::filesystem;

class ColmapModel : public testing::Test {
  protected:
    /// A model that looks as COLMAP writes it: an image without points has a blank line.
    void write(const std::string& camera = "7 SIMPLE_PINHOLE 640 480 500 320 240",
               const std::string& images =
                   "1 1 0 0 0 0.5 0 2 7 b 2.png\n10 20 -1 30 40 3\n"
                   "2 0.5 0.5 0.5 0.5 1 2 3 7 a.png\n\n") const {
        fs::create_directories(folder_.path() / "sparse/0");
        folder_.write("sparse/0/cameras.txt", "# cameras\n" + camera + "\n");
        folder_.write("sparse/0/images.txt", "# images\n" + images);
    }
    Sequence read() const { return readColmapSequence(folder_.path().string()); }
    std::string reason() const {
        return test::reasonOf([&] { read(); });
    }

    test::TemporaryFolder folder_;
};

TEST_F(ColmapModel, HasACameraAndThePosesOfImagesInTheOrderOfTheirNames) {
    EXPECT_FALSE(isColmapFolder(folder_.path().string()));
    write();
    EXPECT_TRUE(isColmapFolder(folder_.path().string()));
    const Sequence sequence = read();
    EXPECT_EQ(sequence.camera.width, 640U);
    // The middle of the image is the corner between four pixels.
    EXPECT_EQ(sequence.camera.project({0., 0., 1.}), Eigen::Vector2d(319.5, 239.5));
    EXPECT_EQ(sequence.camera.fy(), 500.);
    ASSERT_EQ(sequence.frames.size(), 2U);
    EXPECT_EQ(sequence.frames[0].colourFile, (folder_.path() / "a.png").string());
    EXPECT_EQ(sequence.frames[1].colourFile, (folder_.path() / "b 2.png").string());
    EXPECT_EQ(sequence.frames[1].timestamp, 1.);
    const Eigen::Vector3d point = sequence.frames[0].T_c_w * Eigen::Vector3d(1., 0., 0.);
    EXPECT_TRUE(point.isApprox(Eigen::Vector3d(1., 3., 3.), 1e-12));  // x turns to y
    EXPECT_FALSE(sequence.hasDepth());
    write("7 SIMPLE_PINHOLE 640 480 500 320 240",
          "1 1 0 0 0 0 0 0 7 10.png\n\n2 1 0 0 0 0 0 0 7 9.png\n\n");
    EXPECT_EQ(read().frames[0].colourFile, (folder_.path() / "9.png").string());
    write();
    fs::create_directories(folder_.path() / "images");
    EXPECT_EQ(read().frames[0].colourFile, (folder_.path() / "images/a.png").string());
}

TEST_F(ColmapModel, SurvivesItsFiles) {
    const Camera camera{188, 120, {134.2, 135.1, 93.25, 59.75}};
    Pose T_c_w(Eigen::AngleAxisd(0.3, Eigen::Vector3d(1., 2., 3.).normalized()));
    T_c_w.translation() << 0.1, -2., 1. / 3.;
    const std::string folder = folder_.path().string();
    writeColmapModel(folder, camera, {{"rgb/2.png", T_c_w}, {"rgb/10.png", Pose::Identity()}});
    const std::string images = test::contentOf(folder_.path() / "images.txt");
    EXPECT_NE(images.find("\n1 1 0 0 0 0 0 0 1 rgb/10.png\n\n2 "), std::string::npos) << images;
    const Sequence sequence = read();
    EXPECT_TRUE(fs::exists(folder_.path() / "points3D.txt"));
    EXPECT_EQ(sequence.camera.project({1., 2., 3.}), camera.project({1., 2., 3.}));
    ASSERT_EQ(sequence.frames.size(), 2U);
    EXPECT_TRUE(sequence.frames[0].T_c_w.isApprox(T_c_w, 1e-8));
}

TEST_F(ColmapModel, OfAnotherKindIsRefused) {
    const auto expectReason = [&](const std::string& words) {
        EXPECT_NE(reason().find(words), std::string::npos) << reason();
    };
    write("7 SIMPLE_RADIAL 640 480 500 320 240 0.1");
    expectReason("cameras.txt: line 2: camera model 'SIMPLE_RADIAL': images must be without");
    write("7 PINHOLE 640 480 500 320 240");
    expectReason("7 fields of a PINHOLE");
    write("7 PINHOLE 640 480 1 500 320 240");
    expectReason("implausible focal length");
    write("8 PINHOLE 640 480 500 500 320 240");
    expectReason("no camera 7");
    write("7 PINHOLE 640.5 480 500 500 320 240");
    expectReason("'640.5' is no number of pixels");
    write();
    folder_.write("sparse/0/images.txt", "");
    expectReason("no images");
    folder_.write("sparse/0/images.txt", "1 1 0 0 0 0 0 0 7 a\n\n2 1 0 0 0 0 0 0 8 b\n\n");
    expectReason("line 3: another camera");
    folder_.write("sparse/0/images.txt", "1 1 0 0 0 0 0 0 7 a\n\n2 1 0 0 0 0 0 0 7 a\n\n");
    expectReason("listed twice");
    folder_.write("sparse/0/images.txt", "1 1 1 0 0 0 0 0 7 a\n\n");
    expectReason("line 1: quaternion");
    folder_.write("sparse/0/images.txt", "1 1 0 0 0 0 0 0 7\n\n");
    expectReason("9 fields of an image");
    std::filesystem::remove(folder_.path() / "sparse/0/images.txt");
    EXPECT_TRUE(isColmapFolder(folder_.path().string()));
    expectReason("images.txt: no such file");
    std::filesystem::rename(folder_.path() / "sparse/0/cameras.txt",
                            folder_.path() / "sparse/0/cameras.bin");
    EXPECT_TRUE(isColmapFolder(folder_.path().string()));
    expectReason("cameras.bin: a binary model; `colmap model_converter --output_type TXT`");
}

}  // namespace
}  // namespace photonav
