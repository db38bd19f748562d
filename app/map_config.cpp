// SPDX-License-Identifier: BSD-3-Clause
#include "map_config.hpp"

#include <fmt/format.h>

#include <limits>

#include "yaml_reader.hpp"

namespace photonav {
namespace fs = std::filesystem;
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// A path as YAML that means the same from everywhere.
std::string absolute(const std::string& path) {
    return YAML::Dump(YAML::Node(fs::absolute(path).lexically_normal().string()));
}

/// A path in a config is relative to the config.
std::string resolved(const std::string& path, const std::string& config) {
    return path.empty() ? path : (fs::absolute(config).parent_path() / path).string();
}

bool hasKey(const std::string& file, const char* key) {
    const YAML::Node node = loadYaml(file);
    return node.IsMap() && node[key].IsDefined();
}

}  // namespace

std::string toYaml(const MapOptions& options, const Recording& recording) {
    std::string text = fmt::format("dataset: {}\n", absolute(options.dataset));
    if (!options.cameraFile.empty()) {
        text += fmt::format("camera: {}\n", absolute(options.cameraFile));
    }
    text += fmt::format("up: {}\n", YAML::Dump(YAML::Node(upText(recording.up))));
    text += fmt::format("every: {}\ntolerance: {}\ndepth_scale: {}\n", options.every,
                        options.tolerance, recording.sequence.depthScale);
    if (!options.frames.empty()) {
        text += fmt::format("frames: {}\n", YAML::Dump(YAML::Node(options.frames)));
    }
    return text + fmt::format("depth: {}\nresolution: {}\nmin_range: {}\nmax_range: {}\n",
                              options.depth, options.resolution, options.fusion.minRange,
                              options.fusion.maxRange);
}

std::string toYaml(const ScanMapOptions& options) {
    std::string text = fmt::format("scans: {}\nresolution: {}\nmax_range: {}\n",
                                   absolute(options.scans), options.resolution, options.maxRange);
    if (options.scanner) {
        const Eigen::Vector3d& p = *options.scanner;
        text += fmt::format("scanner: [{}, {}, {}]\n", p.x(), p.y(), p.z());
    }
    return text;
}

bool isMapConfig(const std::string& file) { return hasKey(file, "dataset"); }

bool isScanConfig(const std::string& file) { return hasKey(file, "scans"); }

void readMapConfig(const std::string& file, MapOptions& options) {
    YamlMap yaml(file, loadYaml(file));
    if (!yaml.has("dataset")) yaml.fail("dataset", "missing");
    yaml.read("dataset", options.dataset);
    yaml.read("camera", options.cameraFile);
    options.dataset = resolved(options.dataset, file);
    options.cameraFile = resolved(options.cameraFile, file);
    yaml.read("up", options.up);
    yaml.read("every", options.every);
    if (options.every < 1) yaml.fail("every", "must be at least 1");
    yaml.read("frames", options.frames);
    yaml.read("depth", options.depth);
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

void readScanConfig(const std::string& file, ScanMapOptions& options) {
    YamlMap yaml(file, loadYaml(file));
    if (!yaml.has("scans")) yaml.fail("scans", "missing");
    yaml.read("scans", options.scans);
    options.scans = resolved(options.scans, file);
    yaml.readNumber("resolution", options.resolution, 1e-6, kInfinity);
    yaml.readNumber("max_range", options.maxRange, 0., kInfinity);
    if (yaml.has("scanner")) yaml.readVector("scanner", options.scanner.emplace());
    yaml.finish();
}

}  // namespace photonav
