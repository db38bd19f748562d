// SPDX-License-Identifier: BSD-3-Clause
// The config.yaml that `photonav replay` writes into its folder.
#pragma once

#include <string>

#include "commands/replay_command.hpp"
#include "config/key_table.hpp"
#include "runs/replay_run.hpp"

namespace photonav {

KeyTable keysOf(ReplayOptions& options);

/// Everything a replay depends on, as YAML that readReplayConfig() reads back: paths absolute,
/// factor and floor as the tracker had them.
std::string toYaml(const ReplayOptions& options, const ReplaySource& source,
                   const ReplayTracker& tracker);

/// Overwrites the values that the file has; paths in it are relative to the file.
/// @throws InputError naming file, key and reason, also for a file without `dataset`
void readReplayConfig(const std::string& file, ReplayOptions& options);

}  // namespace photonav
