// SPDX-License-Identifier: BSD-3-Clause
// The coarse-to-fine search of all alignments, for any kind of model.
#pragma once

#include <functional>

#include "alignment/image_pyramid.hpp"
#include "alignment/residual_covariance.hpp"

namespace photonav {

/// What the noise of a model that can be rendered concerns. Its gradients look like those of
/// texture (shared_gradients.hpp).
enum class ModelNoise {
    none,          ///< the model has no noise
    inCovariance,  ///< the covariance counts only the gradients that model and image share
    inPose,        ///< so does the pose: it does not move in directions that are noise alone
};

struct AlignmentOptions {
    /// Image noise and selection of pixels, as in the planner; `scale` is the calibrated factor on
    /// Lambda and `stride` must be 1.
    PhotometricOptions photometric;
    TrustOptions trust;
    ModelNoise modelNoise = ModelNoise::none;  ///< of a model that can be rendered
    RobustWeight robust = RobustWeight::none;
    /// Prior of gain and offset of the observed image, which are then estimated; none: fixed.
    std::optional<ExposurePrior> exposure;
    /// Point spread of the images, standard deviation [pixels]: kRenderedBlur if they are as
    /// blurred as rendered views, kAreaBlur for a sensor without defocus whose pixels average over
    /// their area. Image and rendered view are compared at the same sharpness, except for a model
    /// made of cells, whose texture is blurred itself.
    double blur = kRenderedBlur;
    int levels = 4;           ///< levels of the pyramid, each half the size; fewer for small images
    int maxIterations = 25;   ///< largest number of views rendered per descent on one level
    double coarseStep = 0.3;  ///< step below which a coarser level ends [pixels of the level]
    /// Step below which the finest level ends [standard deviations, given the residuals]. At the
    /// edges of surfaces visibility changes from pixel to pixel, which keeps steps at about 0.3.
    double fineStep = 0.3;
    double cellSize = 0.;  ///< edge of the cells of the model [m]; 0: a mesh
    /// Errors of model and camera that repeat from image to image.
    ModelErrors modelErrors;
    /// Whether the covariance follows from the residuals (residual_covariance.hpp); otherwise it
    /// follows from `photometric.sigma` and `photometric.scale`.
    bool measureCovariance = false;
    /// Calibrated factor on the information by the residuals (calibration.hpp).
    double informationScale = 1.;
    /// Use measuredSlope() if the model can be rendered: where texture is not certain
    /// (certainShare()), and everywhere if the noise of the images is assumed, or ModelNoise is
    /// `inPose`.
    bool measureSlope = true;
};

/// An image and a model that it is compared with, at several sizes: level 0 is the finest.
class Comparison {
  public:
    Comparison() = default;
    Comparison(const Comparison&) = delete;
    Comparison& operator=(const Comparison&) = delete;
    virtual ~Comparison() = default;

    virtual std::size_t levels() const = 0;
    virtual const Camera& camera(std::size_t level) const = 0;
    /// Largest number of pixels that can be used at the finest level.
    virtual std::size_t pixels() const = 0;
    /// The normal equations at a pose; xi is its left perturbation.
    virtual NormalEquations compare(std::size_t level, const Pose& T_c_w, const Exposure& exposure,
                                    const Loss& loss) = 0;
    /// The normal equations of the last compare() by blocks of the image, for the same arguments.
    virtual std::vector<ImageBlock> blocks(std::size_t level, const Pose& T_c_w,
                                           const Exposure& exposure, const Loss& loss) = 0;
    /// Motion T_c_k of the camera since the keyframe that is the model; identity for maps.
    virtual Pose sinceModel(const Pose& /*T_c_w*/) const { return Pose::Identity(); }
    /// ResidualStatistics::finer of the observed image, at the mean depth of the view [m].
    virtual double finerThanModel(double /*depth*/) const { return 0.; }
    /// Robust standard deviation of the residuals of the last comparison [grey value].
    virtual double robustSigma() const = 0;
    /// Whether tiles() can be known.
    virtual bool hasTiles() const { return false; }
    /// The gradients of model and image in the last comparison.
    virtual std::vector<GradientTile> tiles(std::size_t /*level*/,
                                            const Exposure& /*exposure*/) const {
        return {};
    }
    /// The gradients of the last prediction, and, as those of the image, of the view predicted for
    /// a grid of pixels that lies between those of the camera.
    virtual std::vector<GradientTile> resampledTiles() { return {}; }
    /// A function that takes the view predicted at one pose as the observed image and compares it
    /// with the view predicted at another pose; empty if the model cannot be rendered from other
    /// poses.
    using AgainstPrediction = std::function<NormalEquations(const Pose& T_c_w)>;
    virtual AgainstPrediction predictionAsImage(std::size_t, const Pose&) { return {}; }
};

/// Coarse-to-fine Gauss-Newton with Levenberg's damping.
/// @param T_start camera pose T_c_w from which the search starts
/// @param prior prior of T_c_w, which is part of the cost; null: none
Alignment alignCoarseToFine(Comparison& comparison, const AlignmentOptions& options,
                            const Pose& T_start, const UncertainPose* prior);

}  // namespace photonav
