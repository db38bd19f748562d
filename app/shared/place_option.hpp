// SPDX-License-Identifier: BSD-3-Clause
// Places on a command line.
#pragma once

#include <optional>
#include <string>

#include "config/config.hpp"

namespace photonav {

/// The place "x,y,z" or "x,y,z,yaw" of --at, or the one of the config; without a heading that of
/// the config's start.
/// @throws InputError for another text and for a place outside the bounds
Place placeOf(const std::optional<std::string>& at, const Place& otherwise, const Config& config);

/// T_w_b of a level body.
Pose bodyAt(const Place& place);

}  // namespace photonav
