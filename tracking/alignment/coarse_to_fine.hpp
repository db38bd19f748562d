// SPDX-License-Identifier: BSD-3-Clause
// The search that every alignment shares, whatever the image is compared with.
#pragma once

#include <functional>

#include "alignment/alignment.hpp"

namespace photonav {

struct AlignmentOptions {
    /// Noise and pixel rules, as the planner's; `scale` is the calibrated factor on Lambda and
    /// `stride` must be 1.
    PhotometricOptions photometric;
    TrustOptions trust;
    ModelNoise modelNoise = ModelNoise::none;  ///< of a model that can be rendered
    RobustWeight robust = RobustWeight::none;
    /// Estimate gain and offset of the observed image as well, with this prior (by default: none).
    std::optional<ExposurePrior> exposure;
    int levels = 4;           ///< of the pyramid, each half the size; fewer when images are small
    int maxIterations = 25;   ///< views rendered per level and descent
    double coarseStep = 0.3;  ///< a level but the finest is done below this step [its pixels]
    /// The finest is done below this step [standard deviations, given the residuals seen]. Where
    /// surfaces end, visibility jumps from pixel to pixel and keeps steps at about 0.3.
    double fineStep = 0.3;
    bool measureSlope = true;  ///< where a model can be rendered (measured_slope.hpp)
};

/// An image and a model of what it shows, at several sizes: level 0 is the finest.
class Comparison {
  public:
    Comparison() = default;
    Comparison(const Comparison&) = delete;
    Comparison& operator=(const Comparison&) = delete;
    virtual ~Comparison() = default;

    virtual std::size_t levels() const = 0;
    virtual const Camera& camera(std::size_t level) const = 0;
    /// How many pixels could count at the finest level.
    virtual std::size_t pixels() const = 0;
    /// What the image says at a pose; xi of the equations is its left perturbation.
    virtual NormalEquations compare(std::size_t level, const Pose& T_c_w, const Exposure& exposure,
                                    const Loss& loss) = 0;
    /// Of the residuals of the last comparison.
    virtual double robustSigma() const = 0;
    /// A function that compares what is predicted at a pose, as if it were the image, with what is
    /// predicted at others; empty where the model cannot be seen from elsewhere.
    using AgainstPrediction = std::function<NormalEquations(const Pose& T_c_w)>;
    virtual AgainstPrediction predictionAsImage(std::size_t, const Pose&) { return {}; }
};

/// Coarse to fine, Gauss-Newton with Levenberg's damping, from a pose or from a prior's mean.
/// @param prior minimises image and prior together when there is one
Alignment alignCoarseToFine(Comparison& comparison, const AlignmentOptions& options,
                            const Pose& T_start, const UncertainPose* prior);

}  // namespace photonav
