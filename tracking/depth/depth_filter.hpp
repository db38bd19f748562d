// SPDX-License-Identifier: BSD-3-Clause
// Depth from one moving camera: what every pixel of a reference image has learned from the images
// around it.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "photometry/view.hpp"

namespace photonav {

struct DepthFilterOptions {
    double minDepth = 0.5;      ///< nothing is nearer [m]; how far things may be is not limited
    double sigma = 0.01;        ///< image noise, grey values in [0, 1]
    double matchSigma = 0.25;   ///< error of a match along its epipolar line when images have no
                                ///< noise: poses, interpolation [pixels]
    double minScore = 0.6;      ///< correlation from which on patches are taken for the same
    double converged = 0.02;    ///< standard deviation of a depth that is known [share of it]
    double minInliers = 0.6;    ///< share of measurements that must have been good by then
    double maxOutliers = 0.95;  ///< share of bad measurements at which a pixel is given up
    int maxSteps = 120;         ///< longer searches along an epipolar line are put off [pixels]
};

enum class DepthState : std::uint8_t { searching, converged, givenUp };

/// The inverse depth w of every pixel of a reference image, with a Gaussian for its value and a
/// Beta distribution for the share of measurements that are worth anything:
///     p(x | w, rho) = rho N(x; w, tau^2) + (1 - rho) U(x; 0, 1 / minDepth)
/// (Vogiatzis and Hernandez, Video-based, real-time multi-view stereo, 2011, with inverse depth in
/// place of depth; REMODE, Pizzoli, Forster and Scaramuzza, ICRA 2014). Each image is searched
/// along the epipolar line, within two standard deviations of what is believed, for the patch of 9
/// x 9 pixels that correlates best; tau is what image noise and `matchSigma` make of the place
/// found. Pixels that have converged are left alone.
///
/// Poses are taken as exact. Surfaces without texture along the epipolar line stay unknown.
class DepthFilter {
  public:
    /// @param T_r_w pose of the camera when it took the reference image
    /// @throws std::invalid_argument for an image of another size than the camera's
    DepthFilter(ImageF reference, const Camera& camera, const Pose& T_r_w,
                const DepthFilterOptions& options = {});

    /// Learns from another image of the same camera. @throws std::invalid_argument for another size
    void observe(const ImageF& image, const Pose& T_c_w);

    /// The reference image with the depths that have converged, for fuse() (map_fusion.hpp).
    View view() const;

    DepthState state(unsigned v, unsigned u) const { return seeds_[v * camera_.width + u].state; }
    double shareConverged() const;               ///< of all pixels
    double shareNarrowed() const;                ///< of all pixels: to half the variance or less
    std::optional<double> medianDepth() const;   ///< of the converged pixels [m]
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
