// SPDX-License-Identifier: BSD-3-Clause
#include "dataset/sequence_bag.hpp"

#include <bzlib.h>
#include <gtest/gtest.h>

#include <random>

#include "bag_of_recording.hpp"
#include "reason_of.hpp"
#include "tum_dataset.hpp"

namespace photonav {
namespace {

class BagRecordingFile : public testing::Test {
  protected:
    void SetUp() override { flight_.write(folder_.path() / "tum"); }

    BagSequence read(const test::BagWords& words, BagOptions options = {}) const {
        test::writeBag(file_, folder_.path() / "tum", words);
        if (words.depthEncoding != "32FC1" && !options.depthScale) options.depthScale = 5000.;
        return readBagSequence(file_, options);
    }
    std::string reason(const test::BagWords& words, const BagOptions& options = {}) const {
        return test::reasonOf([&] { read(words, options).view(0); });
    }
    Sequence tum() const { return readTumSequence((folder_.path() / "tum").string()); }

    /// Largest differences of grey values and depths to the folder's.
    std::pair<float, float> differenceToFolder(const BagSequence& bag) const {
        const Sequence folder = tum();
        std::pair<float, float> most{0.F, 0.F};
        EXPECT_EQ(bag.sequence.frames.size(), folder.frames.size());
        for (std::size_t i = 0; i < folder.frames.size(); ++i) {
            EXPECT_TRUE(bag.sequence.frames[i].T_c_w.isApprox(folder.frames[i].T_c_w, 1e-9));
            EXPECT_NEAR(bag.sequence.frames[i].timestamp, folder.frames[i].timestamp, 1e-8);
            const View expected = loadFrame(folder, i).view, view = bag.view(i);
            for (unsigned k = 0; k < expected.intensity.getSize(); ++k) {
                const auto off = [k](const ImageF& a, const ImageF& b) {
                    return std::abs(a.bitmap[k] - b.bitmap[k]);
                };
                most.first = std::max(most.first, off(expected.intensity, view.intensity));
                most.second = std::max(most.second, off(expected.depth, view.depth));
            }
        }
        return most;
    }

    test::TemporaryFolder folder_;
    test::FloorDataset flight_;
    std::string file_ = folder_.file("flight.bag");
};

TEST_F(BagRecordingFile, IsTheFolderItWasMadeOf) {
    for (const char* compression : {"none", "bz2", "lz4"}) {
        const BagSequence bag = read({.compression = compression});
        EXPECT_EQ(differenceToFolder(bag), std::pair(0.F, 0.F)) << compression;
        EXPECT_EQ(bag.sequence.recorded, 6U);
        EXPECT_EQ(bag.sequence.camera.project({1., 2., 3.}), tum().camera.project({1., 2., 3.}));
        EXPECT_EQ(bag.topics.pose, "/pose");
        EXPECT_EQ(bag.topics.camera, "/camera/rgb/camera_info");
    }
}

TEST_F(BagRecordingFile, HasImagesOfEveryEncoding) {
    constexpr float kLevel = 1.01F / 255.F;
    for (const char* encoding : {"rgb8", "bgr8", "png"}) {
        const auto [grey, depth] = differenceToFolder(read({.imageEncoding = encoding}));
        EXPECT_LE(grey, kLevel) << encoding;
    }
    EXPECT_LE(differenceToFolder(read({.imageEncoding = "jpeg"})).first, 0.05F);
    EXPECT_LE(differenceToFolder(read({.depthEncoding = "32FC1"})).second, 1e-6F);
    EXPECT_EQ(differenceToFolder(read({.depthEncoding = "png"})).second, 0.F);
    EXPECT_NE(reason({.imageEncoding = "bayer_rggb8"}).find("no grey or colour images"),
              std::string::npos);
}

TEST_F(BagRecordingFile, HasPosesOfEveryType) {
    for (const char* type : {"PoseWithCovarianceStamped", "TransformStamped", "Odometry"}) {
        EXPECT_EQ(differenceToFolder(read({.poseType = type})), std::pair(0.F, 0.F)) << type;
    }
    BagOptions options;
    options.T_s_c.translation() << 0.1, 0., 0.2;
    const BagSequence mounted = read({}, options);
    const Pose T_w_s = tum().frames[2].T_c_w.inverse();
    EXPECT_TRUE(mounted.sequence.frames[2].T_c_w.isApprox((T_w_s * options.T_s_c).inverse(), 1e-9));
}

TEST_F(BagRecordingFile, WithoutStampsTakesTheTimeOfRecording) {
    EXPECT_EQ(differenceToFolder(read({.stampsInHeader = false})), std::pair(0.F, 0.F));
}

TEST_F(BagRecordingFile, CorrectsALens) {
    const BagSequence bag = read({.distortion = {-0.2, 0.05, 0., 0., 0.}});
    ASSERT_TRUE(bag.isUndistorted);
    // A pixel has the grey value of where the lens puts its ray.
    const View view = bag.view(1);
    const Camera &camera = bag.sequence.camera, raw = tum().camera;
    const View distorted = loadFrame(tum(), 1).view;
    double corrected = 0., uncorrected = 0., depth = 0.;
    for (unsigned v = 5; v < 55; v += 5) {
        for (unsigned u = 5; u < 75; u += 5) {
            const Eigen::Vector3d ray = camera.unproject(u, v);
            const double r2 = ray.head<2>().squaredNorm(), factor = 1. - 0.2 * r2 + 0.05 * r2 * r2;
            const Eigen::Vector2d from = raw.project({factor * ray.x(), factor * ray.y(), 1.});
            const auto x = static_cast<unsigned>(std::lround(from.x()));
            const auto y = static_cast<unsigned>(std::lround(from.y()));
            corrected += std::abs(view.intensity[v][u] - distorted.intensity[y][x]);
            uncorrected += std::abs(distorted.intensity[v][u] - distorted.intensity[y][x]);
            depth += std::abs(view.depth[v][u] - distorted.depth[y][x]);
        }
    }
    EXPECT_LT(corrected, 0.5 * uncorrected);
    EXPECT_LT(depth, 1e-3);
    EXPECT_NE(reason({.distortionModel = "equidistant", .distortion = {0.1, 0., 0., 0.}})
                  .find("'equidistant' with 4 coefficients is not one of plumb_bob"),
              std::string::npos);
    EXPECT_NE(reason({.distortionModel = "equidistant", .distortion = {0., 0., 0., 0.}})
                  .find("'equidistant' with 4 coefficients is not one of plumb_bob"),
              std::string::npos);  // a fisheye lens all the same
}

TEST_F(BagRecordingFile, NeedsItsTopics) {
    const auto expectReason = [&](const test::BagWords& words, const std::string& expected,
                                  const BagOptions& options = {}) {
        const std::string found = reason(words, options);
        EXPECT_NE(found.find(expected), std::string::npos) << found;
        EXPECT_TRUE(found.starts_with(file_)) << found;
    };
    expectReason({.depthTopic = ""}, "no depth images (16UC1, 32FC1, compressedDepth)");
    expectReason({.cameraTopic = ""}, "no sensor_msgs/CameraInfo: give --camera FILE");
    expectReason({.poseType = ""}, "no poses (PoseStamped");
    const test::BagWords two{.imageTopics = {"/left/image_raw", "/right/image_raw"}};
    expectReason(two, "--topics: choose one with image=TOPIC: /left/image_raw, /right/image_raw");
    BagOptions options;
    options.topics.image = "/middle";
    expectReason(two, "image=/middle is none that can serve as image", options);
    options.topics.image = "/right/image_raw";
    EXPECT_EQ(reason(two, options), "nothing was thrown");
    expectReason({.depthFocal = 1.2}, "depth images are of another camera");
    BagOptions forgiving;
    forgiving.forgiving = true;
    EXPECT_FALSE(read({.poseType = ""}, forgiving).sequence.hasPoses());
    BagOptions withoutDepth;
    withoutDepth.needsDepth = false;
    EXPECT_FALSE(read({.depthTopic = ""}, withoutDepth).sequence.hasDepth());
}

TEST_F(BagRecordingFile, CutShortIsRefused) {
    read({});
    const auto size = test::fs::file_size(file_);
    test::fs::resize_file(file_, size * 2 / 3);
    EXPECT_NE(test::reasonOf([&] { readBagSequence(file_); }).find("is cut short"),
              std::string::npos);
    folder_.write("flight.bag", "#ROSBAG V1.2\n");
    EXPECT_NE(test::reasonOf([&] { readBagSequence(file_); }).find("not a bag of format 2.0"),
              std::string::npos);
    folder_.write("flight.bag", "rosbag");
    EXPECT_NE(test::reasonOf([&] { readBagSequence(file_); }).find("not a ROS bag"),
              std::string::npos);
}

std::string afterItsLength(const std::string& text) {
    const auto size = static_cast<std::uint32_t>(text.size());
    return std::string(reinterpret_cast<const char*>(&size), sizeof(size)) + text;
}

std::string bagField(const std::string& name, const std::string& value) {
    return afterItsLength(name + "=" + value);
}

std::string bagRecord(const std::string& header, const std::string& data) {
    return afterItsLength(header) + afterItsLength(data);
}

/// 300 bytes of bz2 that are 200 MB of a message's zeros.
TEST_F(BagRecordingFile, ThatUnpacksToMuchMoreIsRefused) {
    const auto bytes = [](const auto& value) {
        return std::string(reinterpret_cast<const char*>(&value), sizeof(value));
    };
    const std::string conn = bagField("conn", bytes(std::uint32_t{0}));
    const std::string chunk =
        bagRecord(conn + bagField("op", "\x07") + bagField("topic", "/zeros"),
                  bagField("type", "std_msgs/Empty")) +
        bagRecord(conn + bagField("op", "\x02") + bagField("time", std::string(8, '\0')),
                  std::string(200'000'000, '\0'));
    std::string packed(chunk.size() / 100 + 600, '\0');
    auto size = static_cast<unsigned>(packed.size());
    ASSERT_EQ(BZ2_bzBuffToBuffCompress(packed.data(), &size, const_cast<char*>(chunk.data()),
                                       static_cast<unsigned>(chunk.size()), 9, 0, 0),
              BZ_OK);
    packed.resize(size);
    const std::string record =
        bagRecord(bagField("op", "\x05") + bagField("compression", "bz2") +
                      bagField("size", bytes(static_cast<std::uint32_t>(chunk.size()))),
                  packed);
    folder_.write("flight.bag",
                  "#ROSBAG V2.0\n" + bagRecord(bagField("op", "\x03"), "") + record + record);
    EXPECT_NE(
        test::reasonOf([&] { readBagSequence(file_); }).find("unpack to more than 1000 times"),
        std::string::npos)
        << test::reasonOf([&] { readBagSequence(file_); });
}

TEST_F(BagRecordingFile, DamagedIsReadOrRefused) {
    std::mt19937 random(3);
    int refused = 0;
    for (const char* compression : {"none", "lz4"}) {
        read({.compression = compression});
        const std::string good = test::contentOf(file_);
        for (int i = 0; i < 60; ++i) {
            std::string bad = good;
            const std::size_t at = i < 20 ? std::size_t(13 + 3 * i) : random() % good.size();
            for (std::size_t k = at; k < std::min(at + 4, bad.size()); ++k) {
                bad[k] = static_cast<char>(random() % 4 == 0 ? random() : 0xff);
            }
            folder_.write("flight.bag", bad);
            try {
                const BagSequence bag = readBagSequence(file_);
                for (std::size_t f = 0; f < bag.sequence.frames.size(); ++f) bag.view(f);
            } catch (const InputError&) {
                ++refused;
            }
        }
    }
    EXPECT_GT(refused, 10);
}

}  // namespace
}  // namespace photonav
