// SPDX-License-Identifier: BSD-3-Clause
// Reads places from the command line.
#pragma once

#include <optional>
#include <string>

#include "config/config.hpp"

namespace photonav {

/// The place of the option --at, "x,y,z" or "x,y,z,yaw" (body, world frame [m, rad]). A place
/// without a heading gets the heading of the config's start.
/// @param at text of the option; none: the option was not given
/// @param otherwise the place if the option was not given
/// @throws InputError for another text, and for a place outside the bounds of the config
Place placeOf(const std::optional<std::string>& at, const Place& otherwise, const Config& config);

/// T_w_b of a level body at a place; heading 0 if the place has none.
Pose bodyAt(const Place& place);

}  // namespace photonav
