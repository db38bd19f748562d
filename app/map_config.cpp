// SPDX-License-Identifier: BSD-3-Clause
#include "map_config.hpp"

#include <fmt/format.h>

#include <limits>

#include "yaml_reader.hpp"

namespace photonav {
namespace fs = std::filesystem;
namespace {

std::string absolute(const std::string& path) {
    return fs::absolute(path).lexically_normal().string();
}

}  // namespace

std::string toYaml(const MapOptions& options, const Recording& recording) {
    const auto quoted = [](const std::string& text) { return YAML::Dump(YAML::Node(text)); };
    std::string text = fmt::format("dataset: {}\n", quoted(absolute(options.dataset)));
    if (!options.cameraFile.empty()) {
        text += fmt::format("camera: {}\n", quoted(absolute(options.cameraFile)));
    }
    text += fmt::format("up: {}\n", quoted(upText(recording.up)));
    text += fmt::format("every: {}\ntolerance: {}\ndepth_scale: {}\n", options.every,
                        options.tolerance, recording.sequence.depthScale);
    return text + fmt::format("resolution: {}\nmin_range: {}\nmax_range: {}\n", options.resolution,
                              options.fusion.minRange, options.fusion.maxRange);
}

bool isMapConfig(const std::string& file) {
    const YAML::Node node = loadYaml(file);
    return node.IsMap() && node["dataset"].IsDefined();
}

void readMapConfig(const std::string& file, MapOptions& options) {
    constexpr double kInfinity = std::numeric_limits<double>::infinity();
    YamlMap yaml(file, loadYaml(file));
    const auto resolved = [&](const std::string& path) {
        return path.empty() ? path : (fs::absolute(file).parent_path() / path).string();
    };
    if (!yaml.has("dataset")) yaml.fail("dataset", "missing");
    yaml.read("dataset", options.dataset);
    yaml.read("camera", options.cameraFile);
    options.dataset = resolved(options.dataset);
    options.cameraFile = resolved(options.cameraFile);
    yaml.read("up", options.up);
    yaml.read("every", options.every);
    if (options.every < 1) yaml.fail("every", "must be at least 1");
    yaml.readNumber("tolerance", options.tolerance, 1e-9, kInfinity);
    if (yaml.has("depth_scale")) {
        double scale = 0.;
        yaml.readNumber("depth_scale", scale, 1e-6, kInfinity);
        options.depthScale = scale;
    }
    yaml.readNumber("resolution", options.resolution, 1e-6, kInfinity);
    yaml.readNumber("min_range", options.fusion.minRange, 0., kInfinity);
    yaml.readNumber("max_range", options.fusion.maxRange, 0., kInfinity);
    yaml.finish();
}

}  // namespace photonav
