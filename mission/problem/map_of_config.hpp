// SPDX-License-Identifier: BSD-3-Clause
// Loads the map of a config.
#pragma once

#include <memory>

#include "config/config.hpp"
#include "map/textured_octree.hpp"

namespace photonav {

/// Loads map.file of a config.
/// @throws InputError, as of Config::invalid(); where the file is missing, it names the command
///         that makes it
std::shared_ptr<TexturedOcTree> loadMapOf(const Config& config);

}  // namespace photonav
