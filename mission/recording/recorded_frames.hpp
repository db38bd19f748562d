// SPDX-License-Identifier: BSD-3-Clause
// Compares views predicted along a plan in a recorded map with the nearest recorded images.
#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <vector>

#include "problem/planning_problem.hpp"
#include "recording/recording.hpp"
#include "recording/view_difference.hpp"

namespace photonav {

/// A waypoint, the recorded frame nearest to it, and the map's prediction of this frame. All views
/// have the camera of the recording.
struct NearestFrame {
    std::size_t point = 0;      ///< index of the waypoint in EvaluatedPath::points
    double length = 0.;         ///< length of the path up to the waypoint [m]
    double timestamp = 0.;      ///< time stamp of the frame [s]
    double distance = 0.;       ///< between the camera centres of waypoint and frame [m]
    double angle = 0.;          ///< between the camera orientations of waypoint and frame [rad]
    View fromPath;              ///< the map's view at the waypoint
    View observed, predicted;   ///< the recorded image, and the map's view at the frame's pose
    ViewDifference difference;  ///< between `observed` and `predicted`
};
using RecordedComparison = std::vector<NearestFrame>;

/// Compares at most six waypoints, spread over a path, with the recording from which the map was
/// made. The nearest frame has the least sum of distance / mean depth in view and angle [rad],
/// which approximates the displacement in the image.
/// @param recording options of the map's recording (optionsOfMap()); depth images are not read
/// @throws InputError if the recording cannot be read
RecordedComparison compareWithRecording(const RecordingOptions& recording, const Config& config,
                                        const World& world, const EvaluatedPath& path);

/// [{waypoint, stamp, distance_m, angle_deg, predicted, mean_abs_difference}]. The last value is
/// null if the map predicts no pixel of the frame.
nlohmann::json toJson(const RecordedComparison& comparison);

/// Mean over the frames of their mean absolute differences, grey values in [0, 1]. Nothing if the
/// map predicts no pixel of any frame.
std::optional<double> meanDifference(const RecordedComparison& comparison);

}  // namespace photonav
