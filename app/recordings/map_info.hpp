// SPDX-License-Identifier: BSD-3-Clause
// `photonav info MAP`: describes a map file.
#pragma once

#include <atomic>

#include "recordings/map_command.hpp"
#include "shared/command_io.hpp"

namespace photonav {

/// Describes the map in the file options.config: its size, its numbers of cells, and the share of
/// cells with grey values. Writes result.json, overview.png (unless the map is empty), report.json
/// and report.html.
/// @throws InputError for a file that is no map, and for overrides, because a map has no keys
CommandReport runMapInfo(const CommandOptions& options, const std::atomic<bool>& interrupted);

}  // namespace photonav
