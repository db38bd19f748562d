// SPDX-License-Identifier: BSD-3-Clause
// The tracker of a replay: odometry, or localisation in a map.
#pragma once

#include <functional>
#include <memory>
#include <optional>

#include "estimation/tracker.hpp"

namespace photonav {

/// A frame as it was given to the tracker, and the result.
struct TrackedView {
    View view;
    TrackedFrame tracked;
};

struct ReplayTracker {
    std::function<TrackedFrame(const View& view, double timestamp)> track;
    /// The view of a frame as the model predicts it at the believed pose; depth 0: nothing there.
    /// Of the size of the frame's view, which may have been halved some more times.
    /// @param keyframe that the frame was aligned to, if any; of the same size
    std::function<View(const TrackedView& frame, const std::optional<TrackedView>& keyframe)>
        predict;
    bool odometry = false;  ///< without a map
    double scale = 1.;      ///< factor on the information of its alignments
    TrustOptions trust;     ///< of its alignments, to put them in words
    Camera camera;          ///< of the views to be given to it
    int halvings = 0;       ///< of the recorded views
    /// Whether to give up, because nothing agrees with the start; empty: never.
    std::function<bool()> hasGivenUp;
};

/// Odometry from `start`.
ReplayTracker odometryTracker(const Camera& camera, const UncertainPose& start,
                              const KeyframeChainOptions& options);

/// Localisation in a map, with images halved until they are at most `maxWidth` wide.
ReplayTracker mapTracker(const std::shared_ptr<const ViewSource>& map, const Camera& camera,
                         const UncertainPose& start, const TrackerOptions& options,
                         unsigned maxWidth);

}  // namespace photonav
