// SPDX-License-Identifier: BSD-3-Clause
#include "recording/recorded_frames.hpp"

#include <utility>

#include "geometry/constants.hpp"
#include "result/json_values.hpp"

namespace photonav {
namespace {

constexpr std::size_t kWaypoints = 6;

/// Waypoints of the path, first and last included.
std::vector<std::size_t> chosenPoints(const EvaluatedPath& path) {
    std::vector<std::size_t> waypoints;
    for (std::size_t i = 0; i < path.points.size(); ++i) {
        if (path.points[i].isWaypoint) waypoints.push_back(i);
    }
    if (waypoints.size() <= kWaypoints) return waypoints;
    std::vector<std::size_t> chosen;
    for (std::size_t k = 0; k < kWaypoints; ++k) {
        chosen.push_back(waypoints[k * (waypoints.size() - 1) / (kWaypoints - 1)]);
    }
    return chosen;
}

/// Mean depth of a view [m]; 1 where nothing is in view.
double typicalDepth(const View& view) {
    double sum = 0.;
    unsigned count = 0;
    for (unsigned i = 0; i < view.depth.getSize(); ++i) {
        if (!(view.depth.bitmap[i] > 0.F)) continue;
        sum += view.depth.bitmap[i];
        ++count;
    }
    return count > 0 ? sum / count : 1.;
}

/// @return its index
std::size_t findNearest(const Sequence& sequence, const Pose& T_c_w, double depth,
                        NearestFrame& nearest) {
    double least = kInfinity;
    std::size_t index = 0;
    for (std::size_t i = 0; i < sequence.frames.size(); ++i) {
        const Pose motion = T_c_w * sequence.frames[i].T_c_w.inverse();
        const double distance = motion.translation().norm();
        const double angle = Eigen::AngleAxisd(motion.linear()).angle();
        if (distance / depth + angle >= least) continue;
        least = distance / depth + angle;
        index = i;
        nearest.distance = distance;
        nearest.angle = angle;
    }
    nearest.timestamp = sequence.frames[index].timestamp;
    return index;
}

}  // namespace

RecordedComparison compareWithRecording(const RecordingOptions& recording, const Config& config,
                                        const World& world, const EvaluatedPath& path) {
    RecordingOptions images = recording;  // grey values alone are compared
    images.needsDepth = false;
    images.depthScale.reset();
    const Recording recorded = readRecording(images);
    const Sequence& sequence = recorded.sequence;
    RecordedComparison comparison;
    for (const std::size_t point : chosenPoints(path)) {
        const BeliefPoint& waypoint = path.points[point];
        const Pose T_c_w = (waypoint.T_w_b * config.camera.T_b_c()).inverse();
        NearestFrame nearest;
        nearest.point = point;
        nearest.length = waypoint.length;
        world.views().render(sequence.camera, T_c_w, nearest.fromPath);
        const std::size_t index =
            findNearest(sequence, T_c_w, typicalDepth(nearest.fromPath), nearest);
        RecordedFrame frame = recorded.load(index);
        world.views().render(sequence.camera, frame.T_c_w, nearest.predicted);
        nearest.difference = compareViews(frame.view, nearest.predicted);
        nearest.observed = std::move(frame.view);
        comparison.push_back(std::move(nearest));
    }
    return comparison;
}

nlohmann::json toJson(const RecordedComparison& comparison) {
    nlohmann::json frames = nlohmann::json::array();
    for (const NearestFrame& frame : comparison) {
        frames.push_back({{"waypoint", frame.point},
                          {"stamp", frame.timestamp},
                          {"distance_m", frame.distance},
                          {"angle_deg", frame.angle / kDegree},
                          {"predicted", frame.difference.predicted},
                          {"mean_abs_difference", orNull(frame.difference.meanIntensity)}});
    }
    return frames;
}

std::optional<double> meanDifference(const RecordedComparison& comparison) {
    double sum = 0.;
    int count = 0;
    for (const NearestFrame& frame : comparison) {
        if (!frame.difference.meanIntensity) continue;
        sum += *frame.difference.meanIntensity;
        ++count;
    }
    return count > 0 ? std::optional(sum / count) : std::nullopt;
}

}  // namespace photonav
