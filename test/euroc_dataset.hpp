// SPDX-License-Identifier: BSD-3-Clause
// A small stereo recording for tests: a camera pair with distortion before a slanted, textured
// wall, in the EuRoC layout.
#pragma once

#include "dataset/sequence_euroc.hpp"
#include "tum_dataset.hpp"

namespace photonav::test {

/// Something to match everywhere, at several sizes; never black or white.
inline double wallTexture(double y, double z) {
    double value = 0.5;
    for (const double k : {7., 13., 23., 41.}) {
        value += 0.09 * std::sin(k * y + 0.6 * k * z + k) + 0.09 * std::cos(0.5 * k * y - k * z);
    }
    return std::clamp(value, 0.02, 0.98);
}

struct WallDataset {
    unsigned width = 160;
    unsigned height = 120;
    int frames = 5;        ///< one every 0.05 s and 1 cm along y
    double distance = 2.;  ///< of the wall x = distance + slope y [m]
    double slope = 0.2;
    double baseline = 0.2;  ///< [m]
    std::string groundtruthSensor =
        "sensor_type: vicon\nT_BS:\n  cols: 4\n  rows: 4\n  data: [1, 0, "
        "0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1]\n";

    static constexpr long kStart = 1403715276812143104;  ///< [ns]
    static long nanoseconds(int i) { return kStart + 50000000L * i; }
    static double time(int i) { return 1e-9 * static_cast<double>(nanoseconds(i)); }

    /// Cameras that look ahead, the right one turned a little.
    DistortedCamera camera(int side) const {
        DistortedCamera c;
        c.camera.width = width;
        c.camera.height = height;
        const double f = width / 160.;
        c.camera.intrinsics = side == 0 ? vpCameraParameters(110. * f, 109. * f, 81. * f, 58. * f)
                                        : vpCameraParameters(111. * f, 111. * f, 78.5 * f, 61. * f);
        c.distortion = side == 0 ? Eigen::Vector4d(-0.28, 0.07, 2e-4, 2e-5)
                                 : Eigen::Vector4d(-0.27, 0.06, -1e-4, -3e-5);
        c.T_b_c = cameraMount(0.);
        c.T_b_c.translation() = Eigen::Vector3d(0.05, 0.5 * baseline - side * baseline, 0.02);
        if (side == 1)
            c.T_b_c.rotate(Eigen::AngleAxisd(0.02, Eigen::Vector3d(0.3, 0.5, 1.).normalized()));
        return c;
    }

    Pose T_w_b(int i) const {
        Pose pose = Pose::Identity();
        pose.translation() = Eigen::Vector3d(0.1, 0.01 * i, 1.);
        pose.rotate(Eigen::AngleAxisd(0.05, Eigen::Vector3d(1., 2., 3.).normalized()));
        return pose;
    }

    /// The ray of a distorted pixel, z = 1.
    static Eigen::Vector3d ray(const DistortedCamera& c, double u, double v) {
        const Eigen::Vector2d seen((u - c.camera.cx()) / c.camera.fx(),
                                   (v - c.camera.cy()) / c.camera.fy());
        const auto& d = c.distortion;
        Eigen::Vector2d p = seen;
        for (int i = 0; i < 30; ++i) {
            const double r2 = p.squaredNorm();
            const Eigen::Vector2d tangential(
                2. * d[2] * p.x() * p.y() + d[3] * (r2 + 2. * p.x() * p.x()),
                d[2] * (r2 + 2. * p.y() * p.y()) + 2. * d[3] * p.x() * p.y());
            p = (seen - tangential) / (1. + d[0] * r2 + d[1] * r2 * r2);
        }
        return {p.x(), p.y(), 1.};
    }

    /// How far along its ray (z = 1) a camera sees the wall.
    double depth(const Pose& T_w_c, const Eigen::Vector3d& ray) const {
        const Eigen::Vector3d normal(1., -slope, 0.);
        return (distance - normal.dot(T_w_c.translation())) / normal.dot(T_w_c.linear() * ray);
    }

    cv::Mat image(int side, int i) const {
        const DistortedCamera c = camera(side);
        const Pose T_w_c = T_w_b(i) * c.T_b_c;
        cv::Mat grey(int(height), int(width), CV_8UC1);
        for (int v = 0; v < grey.rows; ++v) {
            for (int u = 0; u < grey.cols; ++u) {
                const Eigen::Vector3d r = ray(c, u, v);
                const Eigen::Vector3d p_w = T_w_c * (depth(T_w_c, r) * r);
                grey.at<std::uint8_t>(v, u) =
                    static_cast<std::uint8_t>(std::lround(255. * wallTexture(p_w.y(), p_w.z())));
            }
        }
        return grey;
    }

    std::string sensor(int side) const {
        const DistortedCamera c = camera(side);
        std::string rows;
        for (int i = 0; i < 16; ++i) {
            rows += fmt::format("{}{:.12g}", i == 0 ? "" : ", ", c.T_b_c.matrix()(i / 4, i % 4));
        }
        return fmt::format(
            "%YAML:1.0\n# written by a test\nsensor_type: camera\ncomment: cam{}\nT_BS:\n  cols: "
            "4\n  rows: 4\n"
            "  data: [{}]\nrate_hz: 20\nresolution: [{}, {}]\ncamera_model: pinhole\n"
            "intrinsics: [{}, {}, {}, {}] #fu, fv, cu, cv\ndistortion_model: radial-tangential\n"
            "distortion_coefficients: [{}, {}, {}, {}]\n",
            side, rows, width, height, c.camera.fx(), c.camera.fy(), c.camera.cx(), c.camera.cy(),
            c.distortion[0], c.distortion[1], c.distortion[2], c.distortion[3]);
    }

    void write(const fs::path& folder) const {
        for (int side = 0; side < 2; ++side) {
            const fs::path cam = folder / "mav0" / fmt::format("cam{}", side);
            fs::create_directories(cam / "data");
            std::string list = "#timestamp [ns],filename\r\n";
            for (int i = 0; i < frames; ++i) {
                list += fmt::format("{0},{0}.png\r\n", nanoseconds(i));
                cv::imwrite((cam / "data" / fmt::format("{}.png", nanoseconds(i))).string(),
                            image(side, i));
            }
            writeText(cam / "data.csv", list);
            writeText(cam / "sensor.yaml", sensor(side));
        }
        const fs::path truth = folder / "mav0" / "state_groundtruth_estimate0";
        fs::create_directories(truth);
        std::string poses =
            "#timestamp, p_RS_R_x [m], p_RS_R_y [m], p_RS_R_z [m], q_RS_w [], ...\n";
        for (int i = 0; i < frames; ++i) {
            const Pose pose = T_w_b(i);
            const Eigen::Quaterniond q(pose.linear());
            poses += fmt::format("{},{:.9g},{:.9g},{:.9g},{:.12g},{:.12g},{:.12g},{:.12g},0,0,0\n",
                                 nanoseconds(i), pose.translation().x(), pose.translation().y(),
                                 pose.translation().z(), q.w(), q.x(), q.y(), q.z());
        }
        writeText(truth / "data.csv", poses);
        writeText(truth / "sensor.yaml", groundtruthSensor);
    }
};

}  // namespace photonav::test
