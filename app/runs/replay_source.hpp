// SPDX-License-Identifier: BSD-3-Clause
// A recording as a replay sees it: views, and poses only to judge by.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "dataset/recording.hpp"

namespace photonav {

struct ReplaySource {
    struct Frame {
        double timestamp = 0.;      ///< [s], increasing
        std::optional<Pose> T_c_w;  ///< true pose of the views' camera, world with z up
        std::string file;           ///< of the (left) image
    };

    std::string layout;                      ///< "TUM RGB-D", "EuRoC"
    std::string stereo;                      ///< how depth is found; empty: it is recorded
    std::string note;                        ///< what a reader of the poses must know
    Camera camera;                           ///< of the views
    std::string cameraFile;                  ///< that says so and the depth scale; may be empty
    std::optional<double> informationScale;  ///< see Sequence
    std::vector<Frame> frames;
    std::size_t recorded = 0;  ///< frames of the dataset
    std::vector<Sequence::Skipped> skipped;

    /// The view of a frame: rectified, with depth. @throws InputError for images that cannot be
    /// used
    std::function<View(std::size_t frame)> load;

    bool hasGroundtruth() const;
};

/// readRecording() of all frames that can be read, with a pose or without.
/// @throws InputError also for `up` without any poses
ReplaySource openReplaySource(const RecordingOptions& options);

}  // namespace photonav
