// SPDX-License-Identifier: BSD-3-Clause
// Procedural scenes.
#include "finite_scene.hpp"
#include "scene/scene_yaml.hpp"

void photonav::fuzz::run(std::string_view input) {
    check([&] { requireFinite(loadSceneYaml(write("scene.yaml", input), 1e5)); });
}
