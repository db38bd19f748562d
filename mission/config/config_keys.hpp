// SPDX-License-Identifier: BSD-3-Clause
// The keys of a planning problem's YAML file.
#pragma once

#include "config/config.hpp"
#include "config/key_table.hpp"

namespace photonav {

/// Every key with its default or present value, which must outlive the table.
KeyTable keysOf(Config& config);

/// The sections `fly`, `sweep` and `explore`.
void addKeys(KeyTable& keys, FlyConfig& config);
void addKeys(KeyTable& keys, SweepConfig& config);
void addKeys(KeyTable& keys, ExploreConfig& config);

/// Degrees below the horizon of a mount name or number; nothing when it is neither.
std::optional<double> mountDegrees(const std::string& mount);

}  // namespace photonav
