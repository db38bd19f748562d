// SPDX-License-Identifier: BSD-3-Clause
#include "mapping/map_config.hpp"

#include <fmt/format.h>

#include <filesystem>

#include "depth/depth_filter.hpp"
#include "map/textured_octree.hpp"
#include "recording/recording_config.hpp"

namespace photonav {
namespace {

constexpr double kFarthestRange = 1e5;  // of ranges [m]

bool hasKey(const std::string& file, const char* key) {
    const YAML::Node node = loadYaml(file);
    return node.IsMap() && node[key].IsDefined();
}

void addResolution(KeyTable& keys, double& resolution) {
    keys.number({"resolution", "m", "edge of a cell"}, resolution, {kFinestCell, kCoarsestCell});
}

}  // namespace

double defaultMinRange(const std::string& depth) {
    return depth == "monocular" ? DepthFilterOptions().minDepth : FusionOptions().minRange;
}

KeyTable keysOf(MapOptions& options) {
    KeyTable keys;
    addKeys(keys, static_cast<RecordingOptions&>(options));
    keys.choice({"depth", "",
                 "`recorded` (also from two cameras), or `monocular`: from the images "
                 "of one camera and their poses"},
                options.depth, {"recorded", "monocular"});
    addResolution(keys, options.resolution);
    keys.add({.words = {"min_range", "m", "nearest depth that is mapped; monocular: 0.5"},
              .allowed = fmt::format("0 to {}", kFarthestRange),
              .read =
                  [&options](YamlMap& map) {
                      double& range = options.fusion.minRange;
                      range = defaultMinRange(options.depth);
                      map.readNumber("min_range", range, 0., kFarthestRange);
                  },
              .value = [&options] { return yamlNumber(options.fusion.minRange); }});
    keys.number({"max_range", "m", "farthest surface that is mapped"}, options.fusion.maxRange,
                {0., kFarthestRange});
    keys.flag({"exposure", "", "estimate the gain of every image"}, options.exposure);
    keys.choice({"unknown_to_camera", "",
                 "how cells that no ray has visited appear in the views that evaluate "
                 "the map, as `map.unknown_to_camera` of a plan"},
                options.unknownToCamera, {"free", "occupied"});
    return keys;
}

KeyTable keysOf(ScanMapOptions& options) {
    KeyTable keys;
    keys.requiredFile({"scans", "", "point cloud (.ply), or a folder with one per station"},
                      options.scans);
    addResolution(keys, options.resolution);
    keys.number({"max_range", "m", "farthest point that is mapped"}, options.maxRange,
                {0., kFarthestRange});
    keys.add({.words = {"scanner", "m", "position of the scanner, where the file does not have it"},
              .allowed = "`[x, y, z]`",
              .read =
                  [&options](YamlMap& map) {
                      if (map.has("scanner")) {
                          map.readVector("scanner", options.scanner.emplace());
                          if (options.scanner->cwiseAbs().maxCoeff() > kFarthestRange) {
                              map.fail("scanner", "is too far from the origin");
                          }
                      }
                  },
              .value =
                  [&options] {
                      if (!options.scanner) return YAML::Node();
                      const Eigen::Vector3d& p = *options.scanner;
                      return yamlList(std::vector<double>(p.data(), p.data() + 3));
                  }});
    return keys;
}

std::string toYaml(const MapOptions& options, const Recording& recording) {
    MapOptions found = options;
    found.up = upText(recording.up);
    found.stereo = recording.stereo;
    if (recording.sequence.hasDepth()) found.depthScale = recording.sequence.depthScale;
    return keysOf(found).toYaml();
}

std::string toYaml(const ScanMapOptions& options) {
    ScanMapOptions copy = options;
    return keysOf(copy).toYaml();
}

bool isMapConfig(const std::string& file) { return hasKey(file, "dataset"); }

bool isScanConfig(const std::string& file) { return hasKey(file, "scans"); }

void readMapConfig(const std::string& file, MapOptions& options) { keysOf(options).read(file); }

std::optional<MapOptions> optionsOfMap(const std::string& mapFile) {
    namespace fs = std::filesystem;
    if (mapFile.empty()) return {};
    const fs::path config = fs::path(mapFile).parent_path() / "config.yaml";
    if (!fs::exists(config) || !isMapConfig(config.string())) return {};
    MapOptions options;
    readMapConfig(config.string(), options);
    return options;
}

}  // namespace photonav
