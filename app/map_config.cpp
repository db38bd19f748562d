// SPDX-License-Identifier: BSD-3-Clause
#include "map_config.hpp"

#include <fmt/format.h>

#include "constants.hpp"
#include "recording_config.hpp"

namespace photonav {
namespace {

bool hasKey(const std::string& file, const char* key) {
    const YAML::Node node = loadYaml(file);
    return node.IsMap() && node[key].IsDefined();
}

}  // namespace

std::string toYaml(const MapOptions& options, const Recording& recording) {
    const RecordingOptions& asked = options;
    RecordingOptions found = asked;
    found.up = upText(recording.up);
    found.stereo = recording.stereo;
    if (recording.sequence.hasDepth()) found.depthScale = recording.sequence.depthScale;
    return toYaml(found) + fmt::format("depth: {}\nresolution: {}\nmin_range: {}\nmax_range: {}\n",
                                       options.depth, options.resolution, options.fusion.minRange,
                                       options.fusion.maxRange);
}

std::string toYaml(const ScanMapOptions& options) {
    std::string text =
        fmt::format("scans: {}\nresolution: {}\nmax_range: {}\n", absolutePath(options.scans),
                    options.resolution, options.maxRange);
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
    readRecordingKeys(yaml, options);
    yaml.read("depth", options.depth);
    yaml.readNumber("resolution", options.resolution, 1e-6, kInfinity);
    options.fusion.minRange = defaultMinRange(options.depth);
    yaml.readNumber("min_range", options.fusion.minRange, 0., kInfinity);
    yaml.readNumber("max_range", options.fusion.maxRange, 0., kInfinity);
    yaml.finish();
}

void readScanConfig(const std::string& file, ScanMapOptions& options) {
    YamlMap yaml(file, loadYaml(file));
    if (!yaml.has("scans")) yaml.fail("scans", "missing");
    yaml.read("scans", options.scans);
    options.scans = resolvedPath(options.scans, file);
    yaml.readNumber("resolution", options.resolution, 1e-6, kInfinity);
    yaml.readNumber("max_range", options.maxRange, 0., kInfinity);
    if (yaml.has("scanner")) yaml.readVector("scanner", options.scanner.emplace());
    yaml.finish();
}

}  // namespace photonav
