// SPDX-License-Identifier: BSD-3-Clause
// A small recording for tests: a camera that looks down on a textured floor, in the TUM layout.
#pragma once

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <numbers>
#include <opencv2/imgcodecs.hpp>

#include "geometry/camera.hpp"
#include "io/error.hpp"
#include "temporary_folder.hpp"

namespace photonav::test {

namespace fs = std::filesystem;

inline void writeText(const fs::path& file, const std::string& text) {
    std::ofstream(file) << text;
}

/// Grey value of the floor.
inline double floorTexture(double x, double y) {
    return 0.5 + 0.2 * std::sin(5. * x) + 0.2 * std::cos(4. * y);
}

struct FloorDataset {
    unsigned width = 80;
    unsigned height = 60;
    double focal = 60.;
    double floorHeight = 0.02;  ///< [m], not where cells of round sizes meet
    double cameraHeight = 1.5;  ///< above the floor [m]
    int frames = 6;             ///< one every 0.1 s and 0.1 m along x
    Eigen::AngleAxisd tilt{0., Eigen::Vector3d::UnitX()};  ///< of the world that is written
    double pitch = std::numbers::pi / 2.;  ///< of the camera below the horizon [rad]

    Pose T_w_c(int i) const {
        Pose pose = cameraMount(pitch);
        pose.translation() = Eigen::Vector3d(0.1 * i, 0., floorHeight + cameraHeight);
        return pose;
    }

    void write(const fs::path& folder) const {
        fs::create_directories(folder / "rgb");
        fs::create_directories(folder / "depth");
        std::string rgb = "# timestamp filename\n";
        std::string depth = rgb;
        std::string poses = "# timestamp tx ty tz qx qy qz qw\n";
        for (int i = 0; i < frames; ++i) {
            const double time = 100. + 0.1 * i;
            rgb += fmt::format("{:.6f} rgb/{}.png\n", time, i);
            depth += fmt::format("{:.6f} depth/{}.png\n", time + 0.005, i);
            const Pose pose = tilt * T_w_c(i);
            const Eigen::Quaterniond q(pose.linear());
            poses += fmt::format("{:.6f} {} {} {} {} {} {} {}\n", time, pose.translation().x(),
                                 pose.translation().y(), pose.translation().z(), q.x(), q.y(),
                                 q.z(), q.w());
            writeImages(folder, i);
        }
        writeText(folder / "rgb.txt", rgb);
        writeText(folder / "depth.txt", depth);
        writeText(folder / "groundtruth.txt", poses);
        writeText(folder / "camera.yaml",
                  fmt::format("width: {}\nheight: {}\nfx: {}\nfy: {}\ncx: {}\ncy: {}\n", width,
                              height, focal, focal, 0.5 * (width - 1), 0.5 * (height - 1)));
    }

    void writeImages(const fs::path& folder, int i) const {
        cv::Mat grey(int(height), int(width), CV_8UC1);
        cv::Mat depth(int(height), int(width), CV_16UC1);
        const Pose pose = T_w_c(i);
        for (int v = 0; v < grey.rows; ++v) {
            for (int u = 0; u < grey.cols; ++u) {
                const Eigen::Vector3d ray((u - 0.5 * (width - 1)) / focal,
                                          (v - 0.5 * (height - 1)) / focal, 1.);
                const double z = cameraHeight / -(pose.linear() * ray).z();
                const Eigen::Vector3d p_w = pose * (z * ray);
                depth.at<std::uint16_t>(v, u) = static_cast<std::uint16_t>(std::lround(5000. * z));
                grey.at<std::uint8_t>(v, u) =
                    static_cast<std::uint8_t>(std::lround(255. * floorTexture(p_w.x(), p_w.y())));
            }
        }
        cv::imwrite((folder / fmt::format("rgb/{}.png", i)).string(), grey);
        cv::imwrite((folder / fmt::format("depth/{}.png", i)).string(), depth);
    }
};

/// Runs `action` and checks that it throws an InputError whose message has all `parts`.
template <typename Action>
void expectInputError(Action action, const std::vector<std::string>& parts) {
    try {
        action();
        ADD_FAILURE() << "no error; expected one about "
                      << fmt::format("{}", fmt::join(parts, ", "));
    } catch (const InputError& error) {
        const std::string message = error.what();
        for (const auto& part : parts) {
            EXPECT_NE(message.find(part), std::string::npos) << message << "\nlacks: " << part;
        }
        EXPECT_EQ(message.find('\n'), std::string::npos) << message;
    }
}

}  // namespace photonav::test
