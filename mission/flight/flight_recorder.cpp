// SPDX-License-Identifier: BSD-3-Clause
#include "flight/flight_recorder.hpp"

#include <fmt/format.h>

#include <cmath>
#include <opencv2/imgcodecs.hpp>
#include <system_error>
#include <vector>

#include "dataset/camera_file.hpp"
#include "dataset/image_file.hpp"
#include "dataset/trajectory.hpp"
#include "io/atomic_file.hpp"
#include "io/error.hpp"
#include "photometry/opencv_image.hpp"

namespace photonav {
namespace {

constexpr double kDepthScale = 5000.;  // the benchmark's

std::string pngOf(const cv::Mat& pixels) {
    std::vector<unsigned char> bytes;
    cv::imencode(".png", pixels, bytes, {cv::IMWRITE_PNG_COMPRESSION, 9});
    return {bytes.begin(), bytes.end()};
}

std::string depthPng(const ImageF& depth) {
    cv::Mat pixels = asMat(depth) * kDepthScale;
    pixels.setTo(0., pixels >= 65535.5);  // more than 16 bits hold
    pixels.convertTo(pixels, CV_16U);
    return pngOf(pixels);
}

void makeFolder(const std::filesystem::path& folder) {
    std::error_code error;
    std::filesystem::create_directories(folder, error);
    if (error) throw InputError(folder.string(), "", "cannot be made: " + error.message());
}

}  // namespace

FlightRecorder::FlightRecorder(const std::filesystem::path& folder, const Camera& camera,
                               double informationScale, double blur)
    : folder_(folder),
      pairs_("# timestamp colour timestamp depth\n"),
      poses_("# timestamp tx ty tz qx qy qz qw (true, camera to world)\n") {
    for (const char* name : {"rgb", "depth"}) makeFolder(folder_ / name);
    Sequence sequence;
    sequence.camera = camera;
    sequence.depthScale = kDepthScale;
    sequence.informationScale = informationScale;
    sequence.blur = blur;
    sequence.depthError = 0.;
    writeFileAtomically(folder_ / "camera.yaml", cameraYaml(sequence));
}

void FlightRecorder::add(const Exposed& exposed) {
    const std::string stamp = fmt::format("{:.6f}", exposed.time);
    const std::string colourFile = "rgb/" + stamp + ".png";
    const std::string depthFile = "depth/" + stamp + ".png";
    writeFileAtomically(folder_ / colourFile, greyPng(exposed.image));
    writeFileAtomically(folder_ / depthFile, depthPng(exposed.depth));
    colour_ += stamp + " " + colourFile + "\n";
    depth_ += stamp + " " + depthFile + "\n";
    pairs_ += stamp + " " + colourFile + " " + stamp + " " + depthFile + "\n";
    poses_ += toLine({exposed.time, exposed.T_c_w.inverse()});
    ++frames_;
}

void FlightRecorder::finish() const {
    writeFileAtomically(folder_ / "rgb.txt", colour_);
    writeFileAtomically(folder_ / "depth.txt", depth_);
    writeFileAtomically(folder_ / "assoc.txt", pairs_);
    writeFileAtomically(folder_ / "groundtruth.txt", poses_);
}

}  // namespace photonav
