// SPDX-License-Identifier: BSD-3-Clause
// `photonav info MAP`: what a map file holds.
#pragma once

#include "recordings/map_command.hpp"
#include "shared/command_io.hpp"

namespace photonav {

/// Says how large the map in the file `config` is and how much of it has grey values. Writes
/// result.json, overview.png, report.json and report.html.
/// @throws InputError for a file that is no map, and for overrides: a map has no keys
MapReport runMapInfo(const CommandOptions& options);

}  // namespace photonav
