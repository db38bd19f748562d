// SPDX-License-Identifier: BSD-3-Clause
// Tracks a recorded flight in a map or by visual odometry.
#pragma once

#include <atomic>
#include <functional>
#include <optional>

#include "dataset/trajectory.hpp"
#include "io/interrupted.hpp"
#include "problem/tracking_map.hpp"
#include "replay/depth_sensor.hpp"
#include "replay/replay_options.hpp"
#include "replay/replay_run.hpp"

namespace photonav {

/// A recording and, unless it is tracked by odometry, the map in which it is tracked. Errors of a
/// run are computed by evaluate() in replay_errors.hpp, other results by replay_result.hpp,
/// replay_tables.hpp and replay_calibration.hpp.
class Replay {
  public:
    /// Reads the tables of the recording, a few of its images, and the map.
    /// @throws InputError for a recording or map that cannot be used, and for an option out of
    /// range
    explicit Replay(const ReplayOptions& options);

    /// The given options, completed by the values in use: `stereo`, `startSigma`, `scale` and the
    /// least sigmas.
    const ReplayOptions& options() const { return options_; }
    const Recording& recording() const { return recording_; }  ///< frames without pose included
    const TrackingMap& map() const { return map_; }            ///< empty for odometry
    /// Median depth of a few images spread over the recording [m]; nothing if they have no depth.
    const std::optional<double>& medianDepth() const { return medianDepth_; }
    /// Noise of the depth in these images: standard deviation at 1 m [m].
    double depthNoise() const { return depthNoise_; }
    /// The systematic depth error that the covariances include. 0 for a map whose folder has no
    /// trajectory.tum with the poses of its images.
    const DepthError& depthError() const { return depthError_; }

    /// Tracks the recording from its first image on. The trajectory of odometry is aligned to the
    /// ground truth at its first pose, see alignToTruth().
    /// @param isStopped asked before every frame, and while large views of a map are rendered; when
    ///        it returns true, the run ends with the frames tracked so far
    /// @param progress called after every frame with the number of frames done
    /// @throws InputError if none of the first ten frames can be loaded, with the reason for the
    ///         first of them
    ReplayRun run(const IsStopped& isStopped = {},
                  const std::function<void(std::size_t done)>& progress = {}) const;

  private:
    ReplayTracker makeTracker(const IsStopped& isStopped) const;

    ReplayOptions options_;
    Recording recording_;
    TrackingMap map_;
    Trajectory makers_;  // poses of the images from which the map was made, if known
    UncertainPose start_;
    AlignmentOptions alignment_;
    std::optional<double> medianDepth_;
    double depthNoise_ = 0.;
    DepthError depthError_;
};

}  // namespace photonav
