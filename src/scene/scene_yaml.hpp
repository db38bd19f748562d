// SPDX-License-Identifier: BSD-3-Clause
// Procedural scenes from YAML.
#pragma once

#include "scene/scene.hpp"

namespace photonav {

class YamlMap;

/// Reads a procedural scene. Lengths in metres, grey values in [0, 1]; unknown keys are errors.
///
///     seed: 1                     # of all noise textures that do not bring their own
///     textures:                   # options as in texture.hpp, `texel` 0.01 unless given
///       - {name: white, type: uniform, grey: 0.9}
///       - {name: carpet, type: noise, size: [4, 3], cells: [0.6, 0.3], amplitudes: [0.2, 0.2],
///          mean: 0.5, seed: 7}
///       - {name: bars, type: stripes, width: 0.5, soft_edge: 0.05, offset: 0, direction: u,
///          dark: 0.1, light: 0.9}
///       - {name: tiles, type: checker, cell: 0.5, soft_edge: 0.02, dark: 0.1, light: 0.9}
///       - {name: poster, type: image, file: poster.png, width: 1.2}   # relative to this file
///       - {name: floor, type: patches, base: white, size: [10, 10], patches: [
///          {texture: carpet, min: [2, 2], max: [5, 4]}]}
///     planes:
///       - {corner: [0, 0, 0], u: [10, 0, 0], v: [0, 10, 0], texture: floor, offset: [0, 0]}
///     boxes:
///       - {min: [4, 4, 0], max: [5, 5, 1], texture: tiles, hollow: false}  # true: a room
///     walls:
///       - {footprint: [[0, 0], [10, 0], [10, 10]], height: 2.5, thickness: 0.1, bottom: 0,
///          closed: false, texture: bars}
///
/// @param mostTexels largest number of texels of all textures together, checked before textures are
///        made
/// @throws InputError naming file, key and reason
Scene loadSceneYaml(const std::string& file, double mostTexels = kMostTexels);

/// Reads a scene from a mapping of another file, which may contain the keys above and those that
/// the caller has read before.
/// @throws InputError naming file, key and reason
Scene readScene(YamlMap& map, double mostTexels = kMostTexels);

}  // namespace photonav
