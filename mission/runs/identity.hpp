// SPDX-License-Identifier: BSD-3-Clause
// The identity of results: everything on which they depend. Runs with the same identity can be
// merged, also if they were made at other times or on other machines.
#pragma once

#include <map>
#include <set>
#include <string>

#include "config/config.hpp"

namespace photonav {

/// Values on which results depend, by dotted key ("planner.vertices").
using Identity = std::map<std::string, std::string>;

/// The identity of all results of a config: all its keys, checksums of the scene or map file and of
/// the textures, buffers and materials that it uses, and the program's version. Folders of files do
/// not matter.
Identity identityOf(const Config& config);

/// An identity without some keys ("seed") and whole sections ("fly.").
Identity without(const std::set<std::string>& keysOrSections, Identity identity);

/// The first key whose values differ, as "planner.vertices: 300 instead of 2500"; empty if there is
/// none.
std::string difference(const Identity& found, const Identity& expected);

}  // namespace photonav
