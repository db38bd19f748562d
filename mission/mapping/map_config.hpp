// SPDX-License-Identifier: BSD-3-Clause
// The config.yaml that `photonav map` writes beside its map.
#pragma once

#include <optional>
#include <string>

#include "config/key_table.hpp"
#include "mapping/map_options.hpp"

namespace photonav {

/// Every key of either kind of map, those of its recording included.
KeyTable keysOf(MapOptions& options);
KeyTable keysOf(ScanMapOptions& options);

/// Everything a map depends on, as YAML that readMapConfig() reads back: up as it was found, paths
/// absolute.
std::string toYaml(const MapOptions& options, const Recording& recording);

/// The same of a map of laser scans.
std::string toYaml(const ScanMapOptions& options);

/// Whether this is the config of a recording's map: it has a key `dataset`.
/// @throws InputError if it is no YAML
bool isMapConfig(const std::string& file);

/// Whether this is the config of a map of laser scans: it has a key `scans`.
/// @throws InputError if it is no YAML
bool isScanConfig(const std::string& file);

/// Overwrites the values that the file has; paths in it are relative to the file.
/// @throws InputError naming file, key and reason
void readMapConfig(const std::string& file, MapOptions& options);
void readScanConfig(const std::string& file, ScanMapOptions& options);

/// What the map in a file was made of, as `photonav map` notes it in config.yaml beside it.
/// @return nothing where there is no config of a recording's map, and for an empty name
/// @throws InputError for one that cannot be used
std::optional<MapOptions> optionsOfMap(const std::string& mapFile);

}  // namespace photonav
