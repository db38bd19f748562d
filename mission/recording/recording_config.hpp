// SPDX-License-Identifier: BSD-3-Clause
// The keys that describe a recording, in the config.yaml that `photonav map` and `photonav replay`
// write.
#pragma once

#include "config/key_table.hpp"
#include "recording/recording.hpp"

namespace photonav {

/// Adds the keys of all options except `forgiving` and `needsDepth`. `dataset` is required when a
/// file is read. `options` must outlive the table.
void addKeys(KeyTable& keys, RecordingOptions& options);

}  // namespace photonav
