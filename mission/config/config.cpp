// SPDX-License-Identifier: BSD-3-Clause
#include "config/config.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

#include "config/config_keys.hpp"
#include "geometry/constants.hpp"
#include "io/reading.hpp"
#include "map/octree_file.hpp"
#include "scene/mesh_check.hpp"

namespace photonav {
namespace fs = std::filesystem;
namespace {

/// The value of an override. A path is made absolute. Unless it is quoted it is taken as typed,
/// although ' #' and ': ' have a meaning in YAML.
YAML::Node overrideValue(const KeyTable& keys, const std::string& path, const std::string& text) {
    if (text.empty()) return YAML::Node("");
    try {
        const bool isQuoted = text.front() == '"' || text.front() == '\'';
        const ConfigKey* key = keys.find(path);
        if (key == nullptr || !key->isFile) return parseYaml(text, "--set");
        const auto file = isQuoted ? parseYaml(text, "--set").as<std::string>() : text;
        return YAML::Node(file.empty() ? file : fs::absolute(file).string());
    } catch (const std::bad_alloc&) {
        throw;
    } catch (const std::exception&) {
        throw InputError("--set", path, "cannot read the value '" + text + "'");
    }
}

/// Sets node[a][b] = value for the override "a.b=value".
void applyOverride(const KeyTable& keys, const YAML::Node& root, const std::string& text) {
    const auto equals = text.find('=');
    if (equals == std::string::npos || equals == 0) {
        throw InputError("--set", text, "expected key.path=value");
    }
    const std::string path = text.substr(0, equals);
    const YAML::Node value = overrideValue(keys, path, text.substr(equals + 1));
    YAML::Node node = root;
    for (std::size_t begin = 0; begin <= path.size();) {
        const std::size_t end = std::min(path.find('.', begin), path.size());
        const std::string key = path.substr(begin, end - begin);
        if (!node.IsMap() && !node.IsNull()) throw InputError("--set", path, "no such key");
        if (end == path.size()) {
            node[key] = value;
        } else if (!node[key].IsDefined()) {
            node[key] = YAML::Node(YAML::NodeType::Map);
        }
        node.reset(YAML::Node(node[key]));
        begin = end + 1;
    }
}

/// Whether the value of a key, or of a part of it, is not the file's.
bool isOverridden(const std::string& key, const std::vector<std::string>& overrides) {
    return std::ranges::any_of(overrides, [&](const std::string& text) {
        const std::string path = text.substr(0, text.find('='));
        return path == key || path.starts_with(key + ".") || key.starts_with(path + ".");
    });
}

/// Throws for maps and meshes, which are often given in place of a planning problem.
void checkIsPlanningProblem(const std::string& file) {
    if (isOcTreeFile(file)) {
        throw InputError(file, "",
                         "is a map, not a planning problem: name it as map.file in a config "
                         "(photonav info shows what it holds)");
    }
    if (isMeshFile(file)) {
        throw InputError(file, "",
                         "is a mesh, not a planning problem: name it as scene.file in a config");
    }
}

void checkSource(YamlMap& root) {
    for (const char* key : {"dataset", "scans"}) {
        if (!root.has(key)) continue;
        root.fail(key, "this is the config of a map or a replay, not of a planning problem");
    }
}

/// Figures cannot draw every shape.
void checkShape(const YamlMap& root, const CameraConfig& camera) {
    constexpr unsigned kLongestShape = 16;
    if (camera.height <= kLongestShape * camera.width &&
        camera.width <= kLongestShape * camera.height) {
        return;
    }
    root.fail("camera.height", fmt::format("views of {} x {} pixels: one side is more than {} "
                                           "times as long as the other",
                                           camera.width, camera.height, kLongestShape));
}

/// A path has as many points, if its cost is an integral. To draw more takes seconds, which nothing
/// interrupts.
void checkStep(const YamlMap& root, const Config& config) {
    constexpr double kMostSteps = 2e4;
    const double steps = (config.goal.position - config.start.position).norm() / config.belief.ds;
    if (steps <= kMostSteps || config.belief.cost == CostRule::perVertex) return;
    root.fail("planner.ds", fmt::format("{} m: {:.3g} steps from start to goal; at most {}",
                                        config.belief.ds, steps, kMostSteps));
}

Config configOf(const YAML::Node& node, const std::string& file,
                const std::vector<std::string>& overrides) {
    Config config;
    config.file = file;
    config.overrides = overrides;
    const KeyTable keys = keysOf(config);
    const YamlMap unchanged(file, node);  // reports what is wrong with the file itself
    for (const auto& text : overrides) applyOverride(keys, node, text);
    try {
        YamlMap root(file, node);
        checkSource(root);
        keys.read(root);
        checkShape(root, config.camera);
        checkStep(root, config);
    } catch (const InputError& error) {
        const std::string key = error.reason().substr(0, error.reason().find(": "));
        if (!isOverridden(key, overrides)) throw;
        throw InputError("command line", "", error.reason());
    }
    return config;
}

}  // namespace

InputError Config::invalid(const std::string& key, const std::string& reason) const {
    const bool isChanged = isOverridden(key, overrides);
    return {isChanged ? file + ", changed on the command line" : file, key, reason};
}

Camera CameraConfig::camera() const { return makeCamera(width, height, hfov * kDegree); }

Pose CameraConfig::T_b_c() const { return cameraMount(mountDegrees(mount).value() * kDegree); }

BeliefOptions defaultBelief() {
    BeliefOptions belief;
    belief.kappa = kAutomaticKappa;
    belief.initialCovariance.diagonal() << 1e-2, 1e-2, 1e-2, 1e-5, 1e-5, 1e-4;
    belief.motionNoise.diagonal() << 1e-4, 1e-4, 1e-4, 4.5e-6, 4.5e-6, 1.35e-4;
    return belief;
}

Config loadConfig(const std::string& file, const std::vector<std::string>& overrides) {
    return reading(file, [&] {
        checkIsPlanningProblem(file);
        return configOf(loadYaml(file), file, overrides);
    });
}

Config parseConfig(const std::string& text, const std::string& name,
                   const std::vector<std::string>& overrides) {
    return reading(name, [&] { return configOf(parseYaml(text, name), name, overrides); });
}

std::vector<std::string> inputFiles(const Config& config) {
    return {config.file,     config.sceneFile, config.mapFile,
            config.fly.plan, config.fly.map,   config.sweep.reference};
}

std::string toYaml(const Config& config) {
    Config copy = config;
    return keysOf(copy).toYaml();
}

}  // namespace photonav
