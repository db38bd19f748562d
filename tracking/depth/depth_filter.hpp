// SPDX-License-Identifier: BSD-3-Clause
// Depth from one moving camera: a filter for every pixel of a reference image, updated by other
// images.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "photometry/view.hpp"

namespace photonav {

struct DepthFilterOptions {
    double minDepth = 0.5;  ///< least depth of surfaces [m]; the largest depth is not limited
    double sigma = 0.01;    ///< standard deviation of the image noise, grey values in [0, 1]
    /// Standard deviation of a match along its epipolar line without image noise, by errors of
    /// poses and interpolation [pixels].
    double matchSigma = 0.25;
    double minScore = 0.6;      ///< least correlation of matching patches
    double converged = 0.02;    ///< standard deviation of a converged depth [share of the depth]
    double minInliers = 0.6;    ///< least share of inliers of a converged depth
    double maxOutliers = 0.95;  ///< share of outliers at which a pixel is given up
    int maxSteps = 120;         ///< longer searches along an epipolar line are skipped [pixels]
};

enum class DepthState : std::uint8_t { searching, converged, givenUp };

/// The inverse depth w of every pixel of a reference image, with a Gaussian for its value and a
/// Beta distribution for the inlier ratio rho:
///     p(x | w, rho) = rho N(x; w, tau^2) + (1 - rho) U(x; 0, 1 / minDepth)
/// (Vogiatzis and Hernandez, Video-based, real-time multi-view stereo, 2011, with inverse depth in
/// place of depth; REMODE, Pizzoli, Forster and Scaramuzza, ICRA 2014). Each image is searched
/// along the epipolar line, within two standard deviations of the estimate, for the patch of 9 x 9
/// pixels that correlates best; tau is the standard deviation of this match by image noise and
/// `matchSigma`. Converged pixels are not updated.
///
/// Poses are assumed to be exact. Surfaces without texture along the epipolar line do not converge.
class DepthFilter {
  public:
    /// @param T_r_w pose of the camera when it took the reference image
    /// @throws std::invalid_argument for an image of another size than the camera's
    DepthFilter(ImageF reference, const Camera& camera, const Pose& T_r_w,
                const DepthFilterOptions& options = {});

    /// Updates the filter by another image of the same camera.
    /// @param T_c_w pose of the camera when it took `image`
    /// @throws std::invalid_argument for an image of another size
    void observe(const ImageF& image, const Pose& T_c_w);

    /// The reference image with the depths that have converged, 0 elsewhere, for fuse()
    /// (map_fusion.hpp).
    View view() const;

    /// State of the pixel in row v and column u.
    DepthState state(unsigned v, unsigned u) const { return seeds_[v * camera_.width + u].state; }
    /// Share of all pixels whose variance of inverse depth is at most half of the first one.
    double shareNarrowed() const;
    /// Median depth of the converged pixels [m]; none if no pixel has converged.
    std::optional<double> medianDepth() const;
    const Pose& pose() const { return T_r_w_; }  ///< T_r_w
    const ImageF& reference() const { return reference_; }

  private:
    struct Seed {
        float mean, variance;  ///< of the inverse depth [1/m]
        float a, b;            ///< of the Beta distribution
        DepthState state;
    };

    void update(Seed& seed, double x, double tau2) const;
    void decide(Seed& seed) const;

    ImageF reference_;
    Camera camera_;
    Pose T_r_w_;
    DepthFilterOptions options_;
    std::vector<Seed> seeds_;
};

}  // namespace photonav
