// SPDX-License-Identifier: BSD-3-Clause
#include "dataset/camera_file.hpp"

#include <fmt/format.h>

#include <cmath>

#include "dataset/intrinsics_bounds.hpp"
#include "io/yaml_reader.hpp"

namespace photonav {
namespace {

vpCameraParameters readIntrinsics(YamlMap& yaml, const Camera& camera) {
    const auto required = [&](const std::string& key, double least, double most) {
        if (!yaml.has(key)) yaml.fail(key, "missing");
        double value = 0.;
        yaml.readNumber(key, value, least, most);
        return value;
    };
    const IntrinsicsBounds u(camera.width), v(camera.height);
    constexpr double kMost = IntrinsicsBounds::kMostFocalLength;
    return {required("fx", u.leastFocalLength, kMost), required("fy", v.leastFocalLength, kMost),
            required("cx", -u.farthestPrincipalPoint, u.farthestPrincipalPoint),
            required("cy", -v.farthestPrincipalPoint, v.farthestPrincipalPoint)};
}

void readSize(YamlMap& yaml, Camera& camera) {
    const auto readPixels = [&](const std::string& key, unsigned& value) {
        constexpr unsigned kMost = 65535;  // more is a mistake, such as two numbers in one
        yaml.read(key, value);
        if (value == 0 || value > kMost) {
            yaml.fail(key, fmt::format("{} is not from 1 to {} pixels", value, kMost));
        }
    };
    readPixels("width", camera.width);
    readPixels("height", camera.height);
}

/// Of the size of the colour camera unless the file says otherwise.
DepthCamera readDepthCamera(YamlMap yaml, const Camera& colour) {
    DepthCamera depth;
    depth.camera = colour;
    readSize(yaml, depth.camera);
    depth.camera.intrinsics = readIntrinsics(yaml, depth.camera);
    Eigen::Matrix<double, 7, 1> T_c_d;  // position, quaternion
    T_c_d << 0., 0., 0., 0., 0., 0., 1.;
    yaml.readVector("T_colour_depth", T_c_d);
    if (!(std::abs(T_c_d.tail<4>().norm() - 1.) <= 0.01)) {
        yaml.fail("T_colour_depth", "is not x, y, z, qx, qy, qz, qw with a unit quaternion");
    }
    const Eigen::Quaterniond q(T_c_d[6], T_c_d[3], T_c_d[4], T_c_d[5]);
    depth.T_c_d.linear() = q.normalized().toRotationMatrix();
    depth.T_c_d.translation() = T_c_d.head<3>();
    std::string posesOf = "colour";
    yaml.readChoice("poses", posesOf, {"colour", "depth"});
    depth.hasPoses = posesOf == "depth";
    yaml.finish();
    return depth;
}

void writeIntrinsics(YAML::Emitter& yaml, const Camera& camera) {
    yaml << "width" << camera.width << "height" << camera.height << "fx" << numberText(camera.fx())
         << "fy" << numberText(camera.fy()) << "cx" << numberText(camera.cx()) << "cy"
         << numberText(camera.cy());
}

void writeDepthCamera(YAML::Emitter& yaml, const DepthCamera& depth) {
    yaml << "depth_camera" << YAML::BeginMap;
    writeIntrinsics(yaml, depth.camera);
    const Eigen::Vector3d p = depth.T_c_d.translation();
    const Eigen::Quaterniond q(depth.T_c_d.linear());
    yaml << "T_colour_depth" << YAML::Flow << YAML::BeginSeq;
    for (const double value : p) yaml << fmt::format("{:.6f}", value);
    for (const double value : q.coeffs()) yaml << fmt::format("{:.7f}", value);
    yaml << YAML::EndSeq << "poses" << (depth.hasPoses ? "depth" : "colour") << YAML::EndMap;
}

}  // namespace

void readCameraFile(const std::string& file, Sequence& sequence) {
    sequence.cameraFile = file;
    YamlMap yaml(file, loadYaml(file));
    for (const char* key : {"width", "height"}) {
        if (!yaml.has(key)) yaml.fail(key, "missing");
    }
    readSize(yaml, sequence.camera);
    sequence.camera.intrinsics = readIntrinsics(yaml, sequence.camera);
    yaml.readNumber("depth_scale", sequence.depthScale, 1e-6, 1e12);
    if (yaml.has("information_scale")) {
        yaml.readNumber("information_scale", sequence.informationScale.emplace(), 1e-6, 1e12);
    }
    if (yaml.has("blur")) yaml.readNumber("blur", sequence.blur.emplace(), 0., 10.);
    if (yaml.has("depth_error")) {
        yaml.readNumber("depth_error", sequence.depthError.emplace(), 0., 1.);
    }
    if (yaml.has("depth_camera")) {
        sequence.depthCamera = readDepthCamera(yaml.map("depth_camera"), sequence.camera);
    }
    yaml.finish();
}

std::string cameraYaml(const Sequence& sequence) {
    YAML::Emitter yaml;
    yaml << YAML::BeginMap;
    writeIntrinsics(yaml, sequence.camera);
    yaml << "depth_scale" << numberText(sequence.depthScale);
    const auto write = [&](const char* key, const std::optional<double>& value) {
        if (value) yaml << key << numberText(*value);
    };
    write("information_scale", sequence.informationScale);
    write("blur", sequence.blur);
    write("depth_error", sequence.depthError);
    if (sequence.depthCamera) writeDepthCamera(yaml, *sequence.depthCamera);
    yaml << YAML::EndMap;
    return std::string(yaml.c_str()) + "\n";
}

}  // namespace photonav
