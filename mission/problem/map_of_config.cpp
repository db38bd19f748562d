// SPDX-License-Identifier: BSD-3-Clause
#include "problem/map_of_config.hpp"

#include <filesystem>

#include "io/error.hpp"
#include "map/octree_file.hpp"

namespace photonav {

std::shared_ptr<TexturedOcTree> loadMapOf(const Config& config) {
    if (!config.mapMadeBy.empty() && !std::filesystem::exists(config.mapFile)) {
        throw config.invalid(
            "map.file",
            config.mapFile + ": not there; this config's map is made by " + config.mapMadeBy);
    }
    try {
        return loadTexturedOcTree(config.mapFile);
    } catch (const InputError& error) {
        throw config.invalid("map.file", error.what());
    }
}

}  // namespace photonav
