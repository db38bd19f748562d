// SPDX-License-Identifier: BSD-3-Clause
// The tracker of a replay: visual odometry or localisation in a map.
#pragma once

#include <functional>
#include <memory>
#include <optional>

#include "estimation/tracker.hpp"

namespace photonav {

/// A frame's view and its tracking result.
struct TrackedView {
    View view;
    TrackedFrame tracked;
};

struct ReplayTracker {
    /// Tracks the next frame. @param view with `camera`; @param timestamp [s]
    std::function<TrackedFrame(const View& view, double timestamp)> track;
    /// Predicts the view of a frame at its estimated pose, from the map or the keyframe. Depth 0:
    /// the model has no surface there. The prediction has the size of the frame's view, which may
    /// be reduced by further halvings.
    /// @param keyframe the keyframe to which the frame was aligned, if any, in the same size
    std::function<View(const TrackedView& frame, const std::optional<TrackedView>& keyframe)>
        predict;
    bool odometry = false;  ///< tracks without a map
    double scale = 1.;      ///< factor on the information of its alignments
    TrustOptions trust;     ///< thresholds of its alignments, for describe()
    Camera camera;          ///< intrinsics of the views for track()
    int halvings = 0;       ///< number of halvings from recorded views to views for track()
    double blur = 0.;       ///< assumed point spread of views for track() [pixels]; maps only
    /// Whether to give up, because no image could be aligned near the start; empty: never.
    std::function<bool()> hasGivenUp;
};

/// A tracker by visual odometry from a start pose T_c_w.
ReplayTracker odometryTracker(const Camera& camera, const UncertainPose& start,
                              const KeyframeChainOptions& options);

/// A tracker in a map.
/// @param camera intrinsics of the recorded views
/// @param start initial belief of T_c_w
/// @param maxWidth images are halved until they are at most this wide [pixels]
ReplayTracker mapTracker(const std::shared_ptr<const ViewSource>& map, const Camera& camera,
                         const UncertainPose& start, const TrackerOptions& options,
                         unsigned maxWidth);

}  // namespace photonav
