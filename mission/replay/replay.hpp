// SPDX-License-Identifier: BSD-3-Clause
// A recorded flight through the tracker, in a map or by odometry.
#pragma once

#include <atomic>
#include <functional>
#include <optional>

#include "dataset/trajectory.hpp"
#include "problem/tracking_map.hpp"
#include "replay/depth_sensor.hpp"
#include "replay/replay_options.hpp"
#include "replay/replay_run.hpp"

namespace photonav {

/// A recording and the map it is tracked in, checked and ready to run. Errors of a run are computed
/// by evaluate() in replay_errors.hpp, other results in replay_result.hpp, replay_tables.hpp and
/// replay_calibration.hpp.
class Replay {
  public:
    /// Reads the tables of the recording, a few of its images, and the map.
    /// @throws InputError for a recording or map that cannot be used and an option out of range
    explicit Replay(const ReplayOptions& options);

    /// As given, with the values that recording and tracker decide filled in: `stereo`,
    /// `startSigma`, `scale` and the least sigmas.
    const ReplayOptions& options() const { return options_; }
    const Recording& recording() const { return recording_; }  ///< frames without pose included
    const TrackingMap& map() const { return map_; }            ///< empty for odometry
    /// Of all depths in a few images spread over the recording [m]; nothing when there are none.
    const std::optional<double>& medianDepth() const { return medianDepth_; }
    /// Of the depth in these images: standard deviation at 1 m [m].
    double depthNoise() const { return depthNoise_; }
    /// What covariances allow for: none in a map that does not say where its images were taken.
    const DepthError& depthError() const { return depthError_; }

    /// Tracks the recording from its first image on. The path of odometry is moved so that its
    /// first pose is the true one.
    /// @param isStopped asked before every frame, and in large views of a map; the run ends with
    /// the frames that were tracked
    /// @param progress called after every frame with the number done
    /// @throws InputError when none of the first ten frames can be loaded, with the reason of the
    ///         first
    ReplayRun run(const std::function<bool()>& isStopped = {},
                  const std::function<void(std::size_t done)>& progress = {}) const;

  private:
    ReplayTracker makeTracker(const std::function<bool()>& isStopped) const;

    ReplayOptions options_;
    Recording recording_;
    TrackingMap map_;
    Trajectory makers_;  // the images that the map was made of, where it says so
    UncertainPose start_;
    AlignmentOptions alignment_;
    std::optional<double> medianDepth_;
    double depthNoise_ = 0.;
    DepthError depthError_;
};

}  // namespace photonav
