// SPDX-License-Identifier: BSD-3-Clause
// A plan in a recorded map beside the recorded images near the path.
#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <vector>

#include "problem/planning_problem.hpp"
#include "recording/recording.hpp"
#include "recording/view_difference.hpp"

namespace photonav {

/// The recorded frame nearest to a waypoint, and how well the map predicts it. All views are those
/// of the recording's camera.
struct NearestFrame {
    std::size_t point = 0;      ///< of the path
    double length = 0.;         ///< of the path up to there [m]
    double timestamp = 0.;      ///< of the frame [s]
    double distance = 0.;       ///< between the two camera centres [m]
    double angle = 0.;          ///< between the two camera orientations [rad]
    View fromPath;              ///< predicted at the waypoint
    View observed, predicted;   ///< the frame, and the map at the frame's own pose
    ViewDifference difference;  ///< of these two
};
using RecordedComparison = std::vector<NearestFrame>;

/// Compares a few waypoints spread over a path with the recording that its map was made of.
/// Nearest: least distance by the depth in view plus angle, about how far the image moves.
/// @param recording of the map (optionsOfMap()); its depth is not needed
/// @throws InputError when it cannot be read
RecordedComparison compareWithRecording(const RecordingOptions& recording, const Config& config,
                                        const World& world, const EvaluatedPath& path);

/// [{waypoint, stamp, distance_m, angle_deg, predicted, mean_abs_difference}], the last one null
/// where nothing is predicted.
nlohmann::json toJson(const RecordedComparison& comparison);

/// Mean absolute difference of all compared frames; none when nothing is predicted in any.
std::optional<double> meanDifference(const RecordedComparison& comparison);

}  // namespace photonav
