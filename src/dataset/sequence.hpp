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

/// One recorded moment.
struct RecordedFrame {
    Pose T_c_w = Pose::Identity();
    View view;              ///< measured; depth 0: no measurement
    double timestamp = 0.;  ///< of the colour image [s]
};

/// What a dataset holds, without the images.
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

    Camera camera;  ///< of the colour images, and of the views loaded
    /// Of the depth images, when they are not registered to the colour images.
    std::optional<DepthCamera> depthCamera;
    std::string cameraFile;      ///< that says so; empty when it is assumed
    bool cameraAssumed = false;  ///< the dataset does not say; this is the format's usual one
    double depthScale = 5000.;   ///< depth image value of one metre
    bool needsDepth = true;      ///< false: a depth image that cannot be used is as none
    /// Factor on the photometric information, by the noise of these images, if given.
    std::optional<double> informationScale;
    /// Point spread of the colour images, standard deviation [pixels]; none: that of pixels which
    /// average over their area.
    std::optional<double> blur;
    /// Relative error of depth that repeats from image to image: a wrong scale, or depth images
    /// that do not fit the colour images. None: not known.
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
