// SPDX-License-Identifier: BSD-3-Clause
// The search that every alignment shares, whatever the image is compared with.
#pragma once

#include <functional>

#include "alignment/image_pyramid.hpp"
#include "alignment/residual_covariance.hpp"

namespace photonav {

/// Whether a model that can be rendered has noise of its own, whose gradients are to be told from
/// texture (shared_gradients.hpp).
enum class ModelNoise { none, measured };

struct AlignmentOptions {
    /// Noise and pixel rules, as the planner's; `scale` is the calibrated factor on Lambda and
    /// `stride` must be 1.
    PhotometricOptions photometric;
    TrustOptions trust;
    ModelNoise modelNoise = ModelNoise::none;  ///< of a model that can be rendered
    RobustWeight robust = RobustWeight::none;
    /// Estimate gain and offset of the observed image as well, with this prior (by default: none).
    std::optional<ExposurePrior> exposure;
    /// Point spread of the images, standard deviation [pixels]: kRenderedBlur where they are as
    /// blurred as rendered views, kAreaBlur for a sensor without defocus whose pixels average over
    /// their area. Image and rendered view are compared at the same sharpness; not those of cells,
    /// whose texture is blurred itself.
    double blur = kRenderedBlur;
    int levels = 4;           ///< of the pyramid, each half the size; fewer when images are small
    int maxIterations = 25;   ///< views rendered per level and descent
    double coarseStep = 0.3;  ///< every level but the finest ends below this step [its pixels]
    /// The finest level ends below this step [standard deviations, given the residuals]. At the
    /// edges of surfaces visibility changes from pixel to pixel, which keeps steps at about 0.3.
    double fineStep = 0.3;
    double cellSize = 0.;  ///< of a model made of cells: it shows no finer texture [m]; 0: a mesh
    /// Errors of model and camera that repeat from image to image.
    ModelErrors modelErrors;
    /// Covariance from the residuals (residual_covariance.hpp); else from `photometric.sigma` and
    /// `scale`.
    bool measureCovariance = false;
    /// Factor on the information measured, as a calibration asks for.
    double informationScale = 1.;
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
    /// The normal equations at a pose; xi is its left perturbation.
    virtual NormalEquations compare(std::size_t level, const Pose& T_c_w, const Exposure& exposure,
                                    const Loss& loss) = 0;
    /// The last comparison by blocks of the image; arguments as they were.
    virtual std::vector<ImageBlock> blocks(std::size_t level, const Pose& T_c_w,
                                           const Exposure& exposure, const Loss& loss) = 0;
    /// Motion since the image that the model's depth was measured with; identity for maps.
    virtual Pose sinceModel(const Pose& /*T_c_w*/) const { return Pose::Identity(); }
    /// See ResidualStatistics; at the mean depth of the view [m].
    virtual double finerThanModel(double /*depth*/) const { return 0.; }
    /// Robust standard deviation of the residuals of the last comparison.
    virtual double robustSigma() const = 0;
    /// How much of the gradients of the last comparison the image has as well.
    virtual Matrix6 sharedSlope(std::size_t /*level*/, const Exposure& /*exposure*/) const {
        return Matrix6::Identity();
    }
    /// A function that takes the view predicted at one pose as the observed image and compares it
    /// with the view predicted at another pose; empty if the model cannot be rendered from other
    /// poses.
    using AgainstPrediction = std::function<NormalEquations(const Pose& T_c_w)>;
    virtual AgainstPrediction predictionAsImage(std::size_t, const Pose&) { return {}; }
};

/// Coarse to fine, Gauss-Newton with Levenberg's damping, from a pose or from a prior's mean.
/// @param prior minimises image and prior together when there is one
Alignment alignCoarseToFine(Comparison& comparison, const AlignmentOptions& options,
                            const Pose& T_start, const UncertainPose* prior);

}  // namespace photonav
