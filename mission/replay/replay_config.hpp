// SPDX-License-Identifier: BSD-3-Clause
// The keys of a replay's config.yaml.
#pragma once

#include "config/key_table.hpp"
#include "replay/replay_options.hpp"

namespace photonav {

/// Every key of a replay, those of its recording included.
void addKeys(KeyTable& keys, ReplayOptions& options);

}  // namespace photonav
