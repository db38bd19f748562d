// SPDX-License-Identifier: BSD-3-Clause
#include "recording_config.hpp"

#include <fmt/format.h>

#include "constants.hpp"

namespace photonav {
namespace fs = std::filesystem;

std::string absolutePath(const std::string& path) {
    return YAML::Dump(YAML::Node(fs::absolute(path).lexically_normal().string()));
}

std::string resolvedPath(const std::string& path, const std::string& config) {
    return path.empty() ? path : (fs::absolute(config).parent_path() / path).string();
}

std::string toYaml(const RecordingOptions& options) {
    std::string text = fmt::format("dataset: {}\n", absolutePath(options.dataset));
    if (!options.cameraFile.empty()) {
        text += fmt::format("camera: {}\n", absolutePath(options.cameraFile));
    }
    text += fmt::format("up: {}\nevery: {}\ntolerance: {}\n", YAML::Dump(YAML::Node(options.up)),
                        options.every, options.tolerance);
    if (options.depthScale) text += fmt::format("depth_scale: {}\n", *options.depthScale);
    if (!options.frames.empty()) {
        text += fmt::format("frames: {}\n", YAML::Dump(YAML::Node(options.frames)));
    }
    if (!options.stereo.empty()) text += fmt::format("stereo: {}\n", options.stereo);
    return text;
}

void readRecordingKeys(YamlMap& yaml, RecordingOptions& options) {
    if (!yaml.has("dataset")) yaml.fail("dataset", "missing");
    yaml.read("dataset", options.dataset);
    yaml.read("camera", options.cameraFile);
    options.dataset = resolvedPath(options.dataset, yaml.file());
    options.cameraFile = resolvedPath(options.cameraFile, yaml.file());
    yaml.read("up", options.up);
    yaml.read("every", options.every);
    if (options.every < 1) yaml.fail("every", "must be at least 1");
    yaml.read("frames", options.frames);
    if (yaml.has("stereo")) yaml.readChoice("stereo", options.stereo, {"bm", "sgbm"});
    yaml.readNumber("tolerance", options.tolerance, 1e-9, kInfinity);
    if (yaml.has("depth_scale")) {
        yaml.readNumber("depth_scale", options.depthScale.emplace(), 1e-6, kInfinity);
    }
}

}  // namespace photonav
