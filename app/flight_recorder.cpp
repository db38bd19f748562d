// SPDX-License-Identifier: BSD-3-Clause
#include "flight_recorder.hpp"

#include <fmt/format.h>

#include <cmath>
#include <opencv2/imgcodecs.hpp>

#include "atomic_file.hpp"
#include "command_io.hpp"
#include "pictures.hpp"

namespace photonav {
namespace {

constexpr double kDepthScale = 5000.;  // the benchmark's

Png depthPng(const ImageF& depth) {
    cv::Mat values(static_cast<int>(depth.getHeight()), static_cast<int>(depth.getWidth()),
                   CV_16UC1);
    for (unsigned i = 0; i < depth.getSize(); ++i) {
        const double value = std::round(kDepthScale * static_cast<double>(depth.bitmap[i]));
        values.at<std::uint16_t>(static_cast<int>(i)) =
            static_cast<std::uint16_t>(value < 65536. ? value : 0.);
    }
    std::vector<unsigned char> bytes;
    cv::imencode(".png", values, bytes, {cv::IMWRITE_PNG_COMPRESSION, 9});
    return {bytes.begin(), bytes.end()};
}

}  // namespace

FlightRecorder::FlightRecorder(const std::filesystem::path& folder, const Camera& camera,
                               double informationScale)
    : folder_(folder),
      pairs_("# timestamp colour timestamp depth\n"),
      poses_("# timestamp tx ty tz qx qy qz qw (true, camera to world)\n") {
    for (const char* name : {"rgb", "depth"}) prepareFolder(folder_ / name);
    writeFileAtomically(
        folder_ / "camera.yaml",
        fmt::format("width: {}\nheight: {}\nfx: {}\nfy: {}\ncx: {}\ncy: {}\ndepth_scale: {}\n"
                    "information_scale: {}\n",
                    camera.width, camera.height, camera.fx(), camera.fy(), camera.cx(), camera.cy(),
                    kDepthScale, informationScale));
}

void FlightRecorder::add(double time, const Pose& T_c_w, const ImageF& image, const ImageF& depth) {
    const std::string stamp = fmt::format("{:.6f}", time);
    const std::string colourFile = "rgb/" + stamp + ".png";
    const std::string depthFile = "depth/" + stamp + ".png";
    writeFileAtomically(folder_ / colourFile, greyPng(image));
    writeFileAtomically(folder_ / depthFile, depthPng(depth));
    colour_ += stamp + " " + colourFile + "\n";
    depth_ += stamp + " " + depthFile + "\n";
    pairs_ += stamp + " " + colourFile + " " + stamp + " " + depthFile + "\n";
    const Pose T_w_c = T_c_w.inverse();
    const Eigen::Quaterniond q(T_w_c.linear());
    const Eigen::Vector3d& p = T_w_c.translation();
    poses_ += fmt::format("{} {:.9g} {:.9g} {:.9g} {:.9g} {:.9g} {:.9g} {:.9g}\n", stamp, p.x(),
                          p.y(), p.z(), q.x(), q.y(), q.z(), q.w());
    ++frames_;
}

void FlightRecorder::finish() const {
    writeFileAtomically(folder_ / "rgb.txt", colour_);
    writeFileAtomically(folder_ / "depth.txt", depth_);
    writeFileAtomically(folder_ / "assoc.txt", pairs_);
    writeFileAtomically(folder_ / "groundtruth.txt", poses_);
}

}  // namespace photonav
