// SPDX-License-Identifier: BSD-3-Clause
// Which recording, in the config.yaml that `photonav map` and `photonav replay` write.
#pragma once

#include "config/key_table.hpp"
#include "recording/recording.hpp"

namespace photonav {

/// Every key of a recording but `forgiving` and `needsDepth`; without `dataset` reading fails.
void addKeys(KeyTable& keys, RecordingOptions& options);

}  // namespace photonav
