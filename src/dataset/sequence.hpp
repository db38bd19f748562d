// SPDX-License-Identifier: BSD-3-Clause
// A recorded flight: images with depth and camera poses, loaded one at a time.
#pragma once

#include <algorithm>
#include <optional>
#include <string>
#include <vector>

#include "dataset/depth_camera.hpp"
#include "photometry/view.hpp"

namespace photonav {

/// One loaded frame of a recording.
struct RecordedFrame {
    Pose T_c_w = Pose::Identity();
    View view;              ///< measured image and depth; depth 0: not measured
    double timestamp = 0.;  ///< of the colour image [s]
};

/// The tables of a dataset, without the images.
struct Sequence {
    struct Entry {
        double timestamp = 0.;  ///< of the colour image [s]
        Pose T_c_w = Pose::Identity();
        bool hasPose = true;  ///< false only where `forgiving` keeps such frames
        std::string colourFile;
        std::string depthFile;  ///< empty: none
    };
    struct Skipped {
        std::string file;
        std::string reason;
    };

    Camera camera;  ///< of the colour images and of the loaded views
    /// The depth camera, if depth images are not registered to the colour images.
    std::optional<DepthCamera> depthCamera;
    std::string cameraFile;  ///< file that `camera` was read from; empty if it is assumed
    /// The dataset has no camera parameters; `camera` is the usual one of the format.
    bool cameraAssumed = false;
    double depthScale = 5000.;  ///< depth image value of one metre
    /// False: a frame whose depth image cannot be used counts as a frame without depth.
    bool needsDepth = true;
    /// Factor on the photometric information that suits the noise of these images, if given.
    std::optional<double> informationScale;
    /// Point spread of the colour images, standard deviation [pixels]; none: pixels that average
    /// over their area (kAreaBlur).
    std::optional<double> blur;
    /// Relative systematic error of depth, from a wrong scale or wrong registration to the colour
    /// images. None: not known.
    std::optional<double> depthError;
    std::vector<Entry> frames;  ///< in order of time
    std::size_t recorded = 0;   ///< images that the dataset lists
    std::vector<Skipped> skipped;

    bool hasDepth() const {
        return std::ranges::any_of(frames, [](const Entry& f) { return !f.depthFile.empty(); });
    }
    /// Whether any frame has a pose.
    bool hasPoses() const { return std::ranges::any_of(frames, &Entry::hasPose); }
};

}  // namespace photonav
