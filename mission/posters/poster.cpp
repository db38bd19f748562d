// SPDX-License-Identifier: BSD-3-Clause
#include "posters/poster.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "io/reading.hpp"
#include "io/yaml_reader.hpp"
#include "scene/scene_yaml.hpp"

namespace photonav {
namespace {

Poster readPoster(YamlMap& map, const std::vector<Poster>& before) {
    Poster poster;
    map.read("name", poster.name);
    if (poster.name.empty()) map.fail("name", "missing");
    if (poster.name == kNoPoster) map.fail("name", "'none' stands for the scene as it is");
    if (std::ranges::find(before, poster.name, &Poster::name) != before.end()) {
        map.fail("name", fmt::format("'{}' is there twice", poster.name));
    }
    poster.surfaces = readScene(map);
    return poster;
}

}  // namespace

std::vector<Poster> readPosters(const std::string& file) {
    return reading(file, [&] {
        YamlMap root(file, loadYaml(file));
        std::vector<Poster> posters;
        for (YamlMap& map : root.list("candidates")) posters.push_back(readPoster(map, posters));
        root.finish();
        if (posters.empty()) root.fail("candidates", "there are none");
        return posters;
    });
}

std::string keyOf(std::size_t poster) { return fmt::format("candidates[{}]", poster); }

}  // namespace photonav
