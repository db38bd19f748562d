// SPDX-License-Identifier: BSD-3-Clause
// The keys of a replay's config.yaml.
#pragma once

#include "config/key_table.hpp"
#include "replay/replay_options.hpp"

namespace photonav {

/// Adds all keys of a replay, including those of its recording. `options` must outlive the table.
void addKeys(KeyTable& keys, ReplayOptions& options);

}  // namespace photonav
