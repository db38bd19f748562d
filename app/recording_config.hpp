// SPDX-License-Identifier: BSD-3-Clause
// Which recording, in the config.yaml that `photonav map` and `photonav replay` leave behind.
#pragma once

#include <string>

#include "recording.hpp"
#include "yaml_reader.hpp"

namespace photonav {

/// A path as YAML that means the same from everywhere.
std::string absolutePath(const std::string& path);

/// A path in a config is relative to the config.
std::string resolvedPath(const std::string& path, const std::string& config);

/// All but `forgiving` and `needsDepth` as YAML that readRecordingKeys() reads back, paths
/// absolute.
std::string toYaml(const RecordingOptions& options);

/// Overwrites what the file says.
/// @throws InputError naming file, key and reason, also without `dataset`
void readRecordingKeys(YamlMap& yaml, RecordingOptions& options);

}  // namespace photonav
