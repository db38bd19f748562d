// SPDX-License-Identifier: BSD-3-Clause
#include "sweep/sweep_plan.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <limits>
#include <set>

#include "io/number.hpp"
#include "io/yaml_reader.hpp"
#include "scene/scene.hpp"

namespace photonav {
namespace {

/// FNV-1a of a file's bytes, to find out whether it was changed.
std::string digest(const std::string& file) {
    std::ifstream stream(file, std::ios::binary);
    if (!stream) throw InputError(file, "", "cannot be read");
    std::uint64_t hash = 0xCBF29CE484222325ULL;
    for (auto byte = std::istreambuf_iterator<char>(stream);
         byte != std::istreambuf_iterator<char>(); ++byte) {
        hash = (hash ^ static_cast<unsigned char>(*byte)) * 0x100000001B3ULL;
    }
    return fmt::format("{:016x}", hash);
}

void flatten(const YAML::Node& node, const std::string& prefix, SweepIdentity& values) {
    for (const auto& entry : node) {
        const auto key = prefix + entry.first.as<std::string>();
        if (entry.second.IsMap())
            flatten(entry.second, key + ".", values);
        else
            values[key] = YAML::Dump(entry.second);
    }
}

/// The contents of the other files that a scene was read from: textures, buffers, materials.
void addParts(const std::string& sceneFile, SweepIdentity& identity) {
    const auto folder = std::filesystem::path(sceneFile).parent_path();
    for (const std::string& file : loadScene(sceneFile).files) {
        if (file == sceneFile) continue;
        const auto name = std::filesystem::path(file).lexically_relative(folder).string();
        identity[fmt::format("scene.file (content of {})", name)] = digest(file);
    }
}

/// Keys that the sweep sets itself, run by run, or that change no run.
const std::set<std::string> kIrrelevant{
    "planner.name", "planner.alpha",          "planner.compare_with_rrt_star",
    "sweep.paper",  "sweep.paper_trace_unit", "sweep.reference",
    "map.made_by"};

}  // namespace

void checkSeeds(const Config& config, unsigned runs) {
    constexpr std::uint64_t kLast = std::numeric_limits<std::uint32_t>::max();
    if (std::uint64_t{config.seed} + runs - 1 <= kLast) return;
    throw InputError(
        config.file, "seed",
        fmt::format("{} runs from {} on go beyond the last seed, {}", runs, config.seed, kLast));
}

std::vector<SweepItem> sweepItems(const Config& config) {
    std::vector<SweepItem> items;
    for (const std::string& planner : config.sweep.planners) {
        for (const double alpha : config.sweep.alphas) {
            for (unsigned run = 0; run < config.sweep.runs; ++run) {
                items.push_back({planner, alpha, config.seed + run});
            }
        }
    }
    return items;
}

SweepShard parseShard(const std::string& text) {
    const std::size_t slash = std::min(text.find('/'), text.size());
    const auto k = numberIn<unsigned>(std::string_view(text).substr(0, slash));
    const auto n =
        numberIn<unsigned>(std::string_view(text).substr(std::min(slash + 1, text.size())));
    if (k && n && *k >= 1 && *k <= *n) return {*k, *n};
    throw InputError("--shard", "",
                     "'" + text + "' is not k/n with k from 1 to n, for example 2/4");
}

std::string toString(const SweepShard& shard) {
    return fmt::format("{}/{}", shard.index, shard.count);
}

std::vector<SweepItem> itemsOf(const SweepShard& shard, const std::vector<SweepItem>& items) {
    std::vector<SweepItem> chosen;
    for (std::size_t i = shard.index - 1; i < items.size(); i += shard.count) {
        chosen.push_back(items[i]);
    }
    return chosen;
}

SweepIdentity sweepIdentity(const Config& config) {
    SweepIdentity identity;
    flatten(YAML::Load(toYaml(config)), "", identity);
    std::erase_if(identity, [](const auto& entry) {
        return kIrrelevant.contains(entry.first) || entry.first.starts_with("fly.");
    });
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

SweepIdentity runIdentity(SweepIdentity identity) {
    std::erase_if(identity, [](const auto& entry) {
        return entry.first == "seed" || entry.first.starts_with("sweep.");
    });
    return identity;
}

std::string difference(const SweepIdentity& found, const SweepIdentity& expected) {
    std::set<std::string> keys;
    for (const auto* identity : {&found, &expected}) {
        for (const auto& entry : *identity) keys.insert(entry.first);
    }
    const auto value = [](const SweepIdentity& identity, const std::string& key) {
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
