// SPDX-License-Identifier: BSD-3-Clause
// Candidate posters, carpets and boxes that could be added to a scene.
#pragma once

#include <string>
#include <vector>

#include "scene/scene.hpp"

namespace photonav {

/// A named candidate: textured surfaces at their position in the scene.
struct Poster {
    std::string name;
    Scene surfaces;
};

/// The name of the scene without posters.
inline constexpr const char* kNoPoster = "none";

/// Reads a file of candidates, each with a name and the keys of a scene file (scene_yaml.hpp):
///
///     candidates:
///       - name: carpet
///         textures: [{name: wool, type: noise}]
///         planes: [{corner: [1, 8, 0.01], u: [2, 0, 0], v: [0, 2, 0], texture: wool}]
///
/// @throws InputError naming file, key and reason; also for a file without candidates, and for two
///         candidates of the same name
std::vector<Poster> readPosters(const std::string& file);

/// The key of a candidate in its file: "candidates[i]".
std::string keyOf(std::size_t poster);

}  // namespace photonav
