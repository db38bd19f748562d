// SPDX-License-Identifier: BSD-3-Clause
// Files with the calibration of a tracker's covariances. Replays write them; replays and flights
// read them.
#pragma once

#include <optional>
#include <string>

#include "estimation/calibration.hpp"
#include "problem/tracking_map.hpp"

namespace photonav {

/// What images are aligned to, in files and results: `odometry` (keyframes), `mesh`, `cells`
/// without surfaces inside, or `surfaces`.
const char* modeOf(std::optional<MapKind> map);

/// YAML that readCalibration() can read. A comment gives the same values as command-line options.
/// @param map kind of the map to which images were aligned; none: keyframes (odometry)
std::string toYaml(const Calibration& calibration, std::optional<MapKind> map);

/// Reads scale, least sigmas and correlation time.
/// @throws InputError naming file, key and reason
Calibration readCalibration(const std::string& file);

/// As above, with a check that the file is for alignments to this kind of map (none: to keyframes).
/// A file without the key `mode` is accepted.
/// @throws InputError as above, and for a file for another kind of alignments
Calibration readCalibration(const std::string& file, std::optional<MapKind> map);

}  // namespace photonav
