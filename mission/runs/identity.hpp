// SPDX-License-Identifier: BSD-3-Clause
// What results depend on, to find out whether runs of different times and machines belong together.
#pragma once

#include <map>
#include <set>
#include <string>

#include "config/config.hpp"

namespace photonav {

/// Everything that results depend on, by dotted key.
using Identity = std::map<std::string, std::string>;

/// All keys of the config, the contents of the scene or map and of the textures, buffers and
/// materials it is made of (whose folder does not matter), the program's version.
Identity identityOf(const Config& config);

/// Leaves out keys, "seed", and whole sections, "fly.".
Identity without(const std::set<std::string>& keysOrSections, Identity identity);

/// The first key that differs, as "planner.vertices: 300 instead of 2500"; empty when none does.
std::string difference(const Identity& found, const Identity& expected);

}  // namespace photonav
