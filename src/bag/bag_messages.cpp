// SPDX-License-Identifier: BSD-3-Clause
#include "bag/bag_messages.hpp"

#include <algorithm>
#include <stdexcept>

#include "bag/byte_reader.hpp"

namespace photonav {
namespace {

/// std_msgs/Header. @returns its stamp [s]
double parseHeader(ByteReader& reader) {
    reader.number<std::uint32_t>();  // a count
    const auto seconds = reader.number<std::uint32_t>();
    const auto nanoseconds = reader.number<std::uint32_t>();
    reader.block();  // the name of its frame
    return seconds + 1e-9 * nanoseconds;
}

template <std::size_t count>
void parseNumbers(ByteReader& reader, std::array<double, count>& numbers) {
    for (double& number : numbers) number = reader.number<double>();
}

}  // namespace

ImageMessage parseImage(ByteSpan message) {
    ByteReader reader(message);
    ImageMessage image;
    image.stamp = parseHeader(reader);
    image.height = reader.number<std::uint32_t>();
    image.width = reader.number<std::uint32_t>();
    image.encoding = reader.text();
    image.isBigEndian = reader.number<std::uint8_t>() != 0;
    image.step = reader.number<std::uint32_t>();
    image.data = reader.block();
    if (image.data.size() != std::uint64_t(image.step) * image.height) {
        throw std::runtime_error("damaged: an image is not as large as it says");
    }
    return image;
}

CompressedImageMessage parseCompressedImage(ByteSpan message) {
    ByteReader reader(message);
    CompressedImageMessage image;
    image.stamp = parseHeader(reader);
    image.format = reader.text();
    image.data = reader.block();
    return image;
}

CameraInfoMessage parseCameraInfo(ByteSpan message) {
    constexpr std::uint32_t kMostCoefficients = 100;
    ByteReader reader(message);
    CameraInfoMessage camera;
    parseHeader(reader);
    camera.height = reader.number<std::uint32_t>();
    camera.width = reader.number<std::uint32_t>();
    camera.distortionModel = reader.text();
    const auto count = reader.number<std::uint32_t>();
    if (count > kMostCoefficients) throw std::runtime_error("damaged: a camera's distortion");
    camera.D.resize(count);
    for (double& coefficient : camera.D) coefficient = reader.number<double>();
    parseNumbers(reader, camera.K);
    std::array<double, 9> R{};  // the rotation that rectifies for stereo
    parseNumbers(reader, R);
    parseNumbers(reader, camera.P);
    std::array<std::uint32_t, 6> part{};  // binning in x and y; offset, height and width of a crop
    for (std::uint32_t& number : part) number = reader.number<std::uint32_t>();
    const bool isWhole =
        (part[4] == 0 || part[4] == camera.height) && (part[5] == 0 || part[5] == camera.width);
    camera.isPart = part[0] > 1 || part[1] > 1 || part[2] > 0 || part[3] > 0 || !isWhole;
    return camera;
}

bool isPoseType(const std::string& type) {
    return type == "geometry_msgs/PoseStamped" || type == "geometry_msgs/TransformStamped" ||
           type == "geometry_msgs/PoseWithCovarianceStamped" || type == "nav_msgs/Odometry";
}

PoseMessage parsePoseMessage(const std::string& type, ByteSpan message) {
    ByteReader reader(message);
    PoseMessage pose;
    pose.stamp = parseHeader(reader);
    if (type == "geometry_msgs/TransformStamped" || type == "nav_msgs/Odometry") {
        reader.block();  // the name of the frame that moves
    }
    std::array<double, 7> v{};
    parseNumbers(reader, v);
    pose.position = {v[0], v[1], v[2]};
    pose.rotation = Eigen::Quaterniond(v[6], v[3], v[4], v[5]);
    return pose;
}

}  // namespace photonav
