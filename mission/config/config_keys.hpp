// SPDX-License-Identifier: BSD-3-Clause
// The keys of a planning problem's YAML file.
#pragma once

#include "config/config.hpp"
#include "config/key_table.hpp"

namespace photonav {

/// The table of all keys. Its entries read and write the members of `config`, which must outlive
/// the table.
KeyTable keysOf(Config& config);

/// Add the keys of the sections `fly`, `sweep` and `explore`. `config` must outlive the table.
void addKeys(KeyTable& keys, FlyConfig& config);
void addKeys(KeyTable& keys, SweepConfig& config);
void addKeys(KeyTable& keys, ExploreConfig& config);

/// The angle of a camera mount below the horizon [degrees], from its name (down, front45, forward)
/// or a number within +-90; nothing for other texts.
std::optional<double> mountDegrees(const std::string& mount);

}  // namespace photonav
