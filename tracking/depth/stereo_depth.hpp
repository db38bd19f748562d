// SPDX-License-Identifier: BSD-3-Clause
// Depth from a calibrated camera pair: rectification, OpenCV's block matching, and least squares
// for the fraction of a pixel.
#pragma once

#include <memory>

#include "dataset/sequence_euroc.hpp"
#include "photometry/view.hpp"

namespace photonav {

enum class StereoMethod {
    blockMatching,  ///< StereoBM, quick; refined by least squares (refineDisparities())
    semiGlobal,     ///< StereoSGBM, denser, several times slower
};

struct StereoOptions {
    StereoMethod method = StereoMethod::blockMatching;
    int halvings = 1;       ///< how often the images are first halved in size; 0: full size
    double minDepth = 0.4;  ///< least depth that is found [m]; sets the range of disparities
    double maxDepth = 20.;  ///< farther surfaces are left out [m]
    /// Edge of a block, odd [pixels after halving]. Reduced to the size of small images; semiGlobal
    /// takes a third.
    int blockSize = 15;
    int uniqueness = 10;  ///< margin of the best match over the second best [%]
    int texture = 10;     ///< blocks with less contrast are left out (OpenCV's textureThreshold)
    int speckle = 60;     ///< smaller patches of depth are left out [pixels]
    /// Standard deviation of a Gaussian that smooths the images before they are matched, so that
    /// weak texture stands out from noise; 0: none [pixels after halving]
    double blur = 0.;
    /// Standard deviation of the noise of grey values in [0, 1], independent from pixel to pixel.
    /// If it is given, a block has a depth only if its texture fixes the disparity to one pixel
    /// (standard deviation), and only if some of this texture is in the middle of the block:
    /// otherwise it is the depth of something beside. 0: not given.
    double noise = 0.;
};

/// Makes views of the left camera, rectified and undistorted, with depth.
class StereoDepth {
  public:
    /// @throws std::invalid_argument if the images of the two cameras differ in size, if the right
    ///        camera is not to the right of the left one, and for halved images below 5 pixels a
    ///        side
    StereoDepth(const DistortedCamera& left, const DistortedCamera& right,
                const StereoOptions& options = {});
    ~StereoDepth();
    StereoDepth(StereoDepth&&) noexcept;
    StereoDepth& operator=(StereoDepth&&) noexcept;

    const Camera& camera() const;  ///< camera of the views
    const Pose& T_r_c() const;     ///< rotation from the left camera to its rectified frame
    double baseline() const;       ///< distance of the cameras [m]

    /// Computes a view with depth z = f b / d along the rectified axis [m]; 0 where no match was
    /// found. Not thread-safe (buffers are reused).
    /// @throws std::invalid_argument for images that are not of the cameras' size
    void operator()(const StereoImages& images, View& view);

  private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace photonav
