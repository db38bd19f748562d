// SPDX-License-Identifier: BSD-3-Clause
// The calibration of a tracker as a file, which a replay writes and replays and flights read.
#pragma once

#include <optional>
#include <string>

#include "estimation/calibration.hpp"
#include "problem/tracking_map.hpp"

namespace photonav {

/// For the command line, and as YAML that readCalibration() reads back.
/// @param map that images were aligned to; none: to keyframes (odometry)
std::string toYaml(const Calibration& calibration, std::optional<MapKind> map);

/// Scale, least sigmas and correlation time of such a file.
/// @throws InputError naming file, key and reason
Calibration readCalibration(const std::string& file);

/// The same, of alignments to this kind of map, or to keyframes. A file that does not say what it
/// is of is taken as it is.
/// @throws InputError as above, and for a file of another kind
Calibration readCalibration(const std::string& file, std::optional<MapKind> map);

}  // namespace photonav
