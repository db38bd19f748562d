// SPDX-License-Identifier: BSD-3-Clause
// The config.yaml that `photonav map` writes beside its map.
#pragma once

#include <optional>
#include <string>

#include "config/key_table.hpp"
#include "mapping/map_options.hpp"

namespace photonav {

/// The keys of a map of a recording (including those of the recording) and of a map of laser scans.
/// `options` must outlive the table.
KeyTable keysOf(MapOptions& options);
KeyTable keysOf(ScanMapOptions& options);

/// Everything on which a map depends, as YAML that readMapConfig() can read. It contains the upward
/// direction, stereo method and depth scale that were used, and absolute paths.
std::string toYaml(const MapOptions& options, const Recording& recording);

/// As above, for a map of laser scans; keysOf(ScanMapOptions&) reads it.
std::string toYaml(const ScanMapOptions& options);

/// Whether a file is the config of a map of a recording: it has a key `dataset`.
/// @throws InputError if the file is no YAML
bool isMapConfig(const std::string& file);

/// Whether a file is the config of a map of laser scans: it has a key `scans`.
/// @throws InputError if the file is no YAML
bool isScanConfig(const std::string& file);

/// Sets the options whose keys are in the file; paths are relative to the folder of the file.
/// @throws InputError naming file, key and reason
void readMapConfig(const std::string& file, MapOptions& options);

/// The options with which a map was made from a recording: `photonav map` writes them as
/// config.yaml into the folder of the map.
/// @return nothing if the folder has no config of a map of a recording, and for an empty file name
/// @throws InputError for a config that cannot be used
std::optional<MapOptions> optionsOfMap(const std::string& mapFile);

}  // namespace photonav
