// SPDX-License-Identifier: BSD-3-Clause
// Depth from a calibrated camera pair: rectification and OpenCV's block matching.
#pragma once

#include <memory>

#include "dataset/sequence_euroc.hpp"
#include "photometry/view.hpp"

namespace photonav {

enum class StereoMethod {
    blockMatching,  ///< StereoBM, quick
    semiGlobal,     ///< StereoSGBM, denser, several times slower
};

struct StereoOptions {
    StereoMethod method = StereoMethod::blockMatching;
    int halvings = 1;       ///< of the images before anything else: 0 works at full size
    double minDepth = 0.4;  ///< nearest surface looked for [m]; sets the range of disparities
    double maxDepth = 20.;  ///< farther surfaces are left out [m]
    int blockSize = 15;     ///< odd [pixels of the working size], smaller where an image is lower
                            ///< or narrower; semiGlobal takes a third
    int uniqueness = 10;    ///< margin of the best match over the next [%]
    int texture = 10;       ///< blocks with less contrast are left out (blockMatching)
    int speckle = 60;       ///< smaller patches of depth are left out [pixels]
};

/// Makes views of the left camera, rectified and undistorted, with depth where it was found.
class StereoDepth {
  public:
    /// @throws std::invalid_argument for cameras that are not side by side: rectified, the right
    ///         one must see every point further left; for working images below 5 pixels a side
    StereoDepth(const DistortedCamera& left, const DistortedCamera& right,
                const StereoOptions& options = {});
    ~StereoDepth();
    StereoDepth(StereoDepth&&) noexcept;
    StereoDepth& operator=(StereoDepth&&) noexcept;

    const Camera& camera() const;  ///< of the views
    const Pose& T_r_c() const;     ///< from the left camera to the rectified one: a rotation
    double baseline() const;       ///< [m]

    /// Depth z = f b / d along the rectified axis; 0 where no match was found. Not thread-safe
    /// (buffers are reused).
    /// @throws std::invalid_argument for images that are not of the cameras' size
    void operator()(const StereoImages& images, View& view);

  private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace photonav
