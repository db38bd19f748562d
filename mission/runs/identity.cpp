// SPDX-License-Identifier: BSD-3-Clause
#include "runs/identity.hpp"

#include <fmt/format.h>

#include <filesystem>
#include <fstream>
#include <iterator>

#include "io/reading.hpp"
#include "io/yaml_reader.hpp"
#include "scene/scene.hpp"

namespace photonav {
namespace {

/// FNV-1a of a file's bytes, to find out whether it was changed.
std::string digest(const std::string& file) {
    std::ifstream stream = openToRead(file);
    std::uint64_t hash = 0xCBF29CE484222325ULL;
    for (auto byte = std::istreambuf_iterator<char>(stream);
         byte != std::istreambuf_iterator<char>(); ++byte) {
        hash = (hash ^ static_cast<unsigned char>(*byte)) * 0x100000001B3ULL;
    }
    return fmt::format("{:016x}", hash);
}

void flatten(const YAML::Node& node, const std::string& prefix, Identity& values) {
    for (const auto& entry : node) {
        const auto key = prefix + entry.first.as<std::string>();
        if (entry.second.IsMap())
            flatten(entry.second, key + ".", values);
        else
            values[key] = YAML::Dump(entry.second);
    }
}

/// The contents of the other files that a scene was read from: textures, buffers, materials.
void addParts(const std::string& sceneFile, Identity& identity) {
    const auto folder = std::filesystem::path(sceneFile).parent_path();
    for (const std::string& file : loadScene(sceneFile).files) {
        if (file == sceneFile) continue;
        const auto name = std::filesystem::path(file).lexically_relative(folder).string();
        identity[fmt::format("scene.file (content of {})", name)] = digest(file);
    }
}

}  // namespace

Identity identityOf(const Config& config) {
    Identity identity;
    flatten(YAML::Load(toYaml(config)), "", identity);
    for (const auto& [key, file] :
         {std::pair{"scene.file", config.sceneFile}, std::pair{"map.file", config.mapFile}}) {
        if (file.empty()) continue;
        identity[key] = std::filesystem::path(file).filename().string();
        identity[std::string(key) + " (content)"] = digest(file);
    }
    if (!config.sceneFile.empty()) addParts(config.sceneFile, identity);
    identity["version"] = PHOTONAV_VERSION;
    return identity;
}

Identity without(const std::set<std::string>& keysOrSections, Identity identity) {
    std::erase_if(identity, [&](const auto& entry) {
        const std::string& key = entry.first;
        return keysOrSections.contains(key) ||
               keysOrSections.contains(key.substr(0, key.find('.') + 1));
    });
    return identity;
}

std::string difference(const Identity& found, const Identity& expected) {
    std::set<std::string> keys;
    for (const auto* identity : {&found, &expected}) {
        for (const auto& entry : *identity) keys.insert(entry.first);
    }
    const auto value = [](const Identity& identity, const std::string& key) {
        const auto it = identity.find(key);
        return it == identity.end() ? std::string("nothing") : it->second;
    };
    for (const std::string& key : keys) {
        const std::string a = value(found, key);
        const std::string b = value(expected, key);
        if (a != b) return fmt::format("{}: {} instead of {}", key, a, b);
    }
    return "";
}

}  // namespace photonav
