// SPDX-License-Identifier: BSD-3-Clause
// A flight over textured ground, recorded in the TUM layout, and the scene it was flown in.
#pragma once

#include "geometry/se3.hpp"
#include "render/mesh_renderer.hpp"
#include "scene/scene.hpp"
#include "tum_dataset.hpp"

namespace photonav::test {

/// A floor and boxes on it, as YAML that --map reads.
inline constexpr const char* kScene = R"(textures:
  - {name: floor, type: noise, size: [6, 6], seed: 4}
  - {name: crate, type: noise, size: [1, 1], seed: 5}
planes:
  - {corner: [-3, -3, 0.01], u: [6, 0, 0], v: [0, 6, 0], texture: floor}
boxes:
  - {min: [0.5, -0.4, 0], max: [0.8, 0, 0.3], texture: crate}
)";

/// A flight over textured ground as a TUM RGB-D folder: pictures of a scene of this test's own.
struct FlightDataset {
    int frames = 12;
    double speed = 0.03;  ///< metres a frame

    Camera camera = makeCamera(160, 120, 1.1);

    static const MeshRenderer& world() {
        static const MeshRenderer renderer = [] {
            Scene scene;
            const auto floor = addTexture(scene, valueNoise({.size = {6., 6.}, .seed = 4}));
            const auto crate = addTexture(scene, valueNoise({.size = {1., 1.}, .seed = 5}));
            addPlane(scene, {-3., -3., 0.01}, {6., 0., 0.}, {0., 6., 0.}, floor);
            addBox(scene, {0.5, -0.4, 0.}, {0.8, 0., 0.3}, crate);
            return MeshRenderer(std::move(scene));
        }();
        return renderer;
    }

    Pose T_w_c(int i) const {
        return levelPose({-0.5 + speed * i, 0.005 * i, 1.4}, 0.01 * i) * cameraMount(0.9);
    }

    static double time(int i) { return 50. + 0.1 * i; }

    void write(const fs::path& folder) const {
        fs::create_directories(folder / "rgb");
        fs::create_directories(folder / "depth");
        std::string rgb, depth, poses;
        for (int i = 0; i < frames; ++i) {
            rgb += fmt::format("{:.6f} rgb/{}.png\n", time(i), i);
            depth += fmt::format("{:.6f} depth/{}.png\n", time(i), i);
            const Pose pose = T_w_c(i);
            const Eigen::Quaterniond q(pose.linear());
            poses += fmt::format("{:.6f} {} {} {} {} {} {} {}\n", time(i), pose.translation().x(),
                                 pose.translation().y(), pose.translation().z(), q.x(), q.y(),
                                 q.z(), q.w());
            View view;
            world().render(camera, pose.inverse(), view);
            writeImages(folder, i, view);
        }
        writeText(folder / "rgb.txt", rgb);
        writeText(folder / "depth.txt", depth);
        writeText(folder / "groundtruth.txt", poses);
        writeText(folder / "camera.yaml",
                  fmt::format("width: 160\nheight: 120\nfx: {0}\nfy: {0}\ncx: 79.5\ncy: 59.5\n",
                              camera.fx()));
    }

    /// Overwrites an image.
    void blacken(const fs::path& folder, int i) const {
        cv::imwrite((folder / fmt::format("rgb/{}.png", i)).string(),
                    cv::Mat(int(camera.height), int(camera.width), CV_8UC1, cv::Scalar(0)));
    }

    static void writeImages(const fs::path& folder, int i, const View& view) {
        const int rows = int(view.depth.getHeight());
        const int columns = int(view.depth.getWidth());
        cv::Mat grey, depth;
        cv::Mat(rows, columns, CV_32FC1, view.intensity.bitmap).convertTo(grey, CV_8U, 255.);
        cv::Mat(rows, columns, CV_32FC1, view.depth.bitmap).convertTo(depth, CV_16U, 5000.);
        cv::imwrite((folder / fmt::format("rgb/{}.png", i)).string(), grey);
        cv::imwrite((folder / fmt::format("depth/{}.png", i)).string(), depth);
    }
};

}  // namespace photonav::test
