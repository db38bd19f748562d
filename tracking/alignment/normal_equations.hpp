// SPDX-License-Identifier: BSD-3-Clause
// The normal equations of Gauss-Newton at one pose, from one pass over an image pair.
#pragma once

#include <algorithm>
#include <vector>

#include "alignment/shared_gradients.hpp"
#include "io/interrupted.hpp"
#include "photometry/photometric.hpp"

namespace photonav {

using Vector8 = Eigen::Matrix<double, 8, 1>;
using Matrix8 = Eigen::Matrix<double, 8, 8>;

/// How residuals are weighted. `huber` and `tukey` have 95 % efficiency for Gaussian noise.
enum class RobustWeight { none, huber, tukey };

/// A robust loss function of residuals with the given scale.
struct Loss {
    RobustWeight kind = RobustWeight::none;
    double sigma = 1.;  ///< standard deviation of the inliers [grey value]

    /// Residual at which weights begin to fall (huber: 1.345 sigma) or end (tukey: 4.685 sigma).
    double width() const { return (kind == RobustWeight::huber ? 1.345 : 4.685) * sigma; }
};

/// Brightness change between a model and an image: observed = gain * predicted + offset.
struct Exposure {
    double gain = 1.;
    double offset = 0.;
};

/// Sums for an unknown blur of the image. With b the derivative of gain * predicted by the variance
/// of the blur [per pixel^2], half of the Laplacian.
struct BlurSums {
    Vector8 Atb = Vector8::Zero();  ///< sum w A^T b
    double btb = 0.;                ///< sum w b^2
    double btr = 0.;                ///< sum w b r

    /// Posterior variance of the blur, divided by `noise`. Multiplied by btr, it gives the most
    /// likely blur [pixels^2].
    /// @param sigma prior standard deviation of the blur [pixels^2]
    /// @param noise variance of a pixel [grey value^2]
    double variance(double sigma, double noise) const {
        return sigma > 0. && btb > 0. ? 1. / (btb + noise / (sigma * sigma)) : 0.;
    }
};

/// Sums over the pixels used, for residuals r = observed - (gain * predicted + offset) and unknowns
/// (xi, d gain, d offset), where xi is the left perturbation of the camera pose, (rho, phi):
///     r = A (xi, dg, do),   A = [-gain * J | predicted | 1],   J as in photometricInformation().
struct NormalEquations {
    Matrix8 AtA = Matrix8::Zero();  ///< sum w A^T A
    Vector8 Atr = Vector8::Zero();  ///< sum w A^T r
    double loss = 0.;               ///< sum rho(r), rho = r^2 where the weight is one
    double count = 0.;              ///< number of pixels used
    double sum = 0.;                ///< of r, not weighted
    double sumSquares = 0.;         ///< of r^2, not weighted
    double sumPredicted = 0.;       ///< of the predicted grey values, not weighted
    double sumPredictedSquares = 0.;
    double sumPredictedTimesR = 0.;
    double meanInverseDepth = 0.;  ///< mean over the surfaces in view [1/m]; 0: no surface
    BlurSums byBlur;               ///< zero if not computed
};

/// Eliminates an unknown blur, by which the image differs from the prediction, from the equations.
/// If a single edge is in view, its width would otherwise determine the distance.
/// @param sigma standard deviation of the variance of the blur, whose mean is zero [pixels^2]
/// @param noise variance of a pixel [grey value^2]
NormalEquations withoutBlur(NormalEquations e, double sigma, double noise);

/// The part of NormalEquations that comes from one block of the image.
struct ImageBlock {
    /// Edge of a block [pixels], a multiple of eight: about a 24th of the image's width.
    static unsigned side(const Camera& camera) {
        return 8 * std::max(1U, (camera.width + 96) / 192);
    }
    /// Columns and rows of blocks. The outermost pixels of the image are in none.
    static Eigen::Array2i numberIn(const Camera& camera) {
        return Eigen::Array2i(camera.width - 3, camera.height - 3) / int(side(camera)) + 1;
    }

    Matrix8 AtA = Matrix8::Zero();
    Vector8 Atr = Vector8::Zero();
    BlurSums byBlur;
    Eigen::Array2i index = Eigen::Array2i::Zero();     ///< column and row of the block
    Eigen::Vector3d normal = Eigen::Vector3d::Zero();  ///< of the surface, camera frame; 0: unknown
    double count = 0.;                                 ///< number of pixels used
};

/// Corrects the residuals of all blocks by the most likely blur; parameters as above.
std::vector<ImageBlock> withoutBlur(std::vector<ImageBlock> blocks, double sigma, double noise);

/// Compares a predicted view with an observed image at the same pixels. Gradients are those of the
/// prediction. Pixels are selected by the prediction alone, by the rules of
/// photometricInformation(): without weights, the pose block of AtA is Lambda * sigma^2 / scale.
class ViewComparison {
  public:
    /// @param isStopped asked at every row, for the sake of large images
    /// @throws std::invalid_argument for images below 3 x 3 pixels or a stride other than 1
    ViewComparison(const Camera& camera, const PhotometricOptions& photometric,
                   IsStopped isStopped = {});

    /// The normal equations of a predicted view and an observed image.
    /// @throws std::invalid_argument when the images and the camera differ in size
    /// @throws Interrupted when `isStopped` says so; then there is no last call until the next one
    NormalEquations operator()(const View& predicted, const ImageF& observed,
                               const Exposure& exposure, const Loss& loss);

    /// 1.4826 times the median of |r| of the last call; 0 if no pixel was used.
    double robustSigma() const;

    /// The equations of the last call by blocks of the image, for the same arguments.
    std::vector<ImageBlock> blocks(const Exposure& exposure, const Loss& loss) const;

    /// The gradients of the last prediction, and of the last observed image divided by the gain.
    std::vector<GradientTile> tiles(const Exposure& exposure) const;

  private:
    void allocate();
    void load(const View& predicted, const ImageF& observed);
    GradientTile tileAt(unsigned left, unsigned top, double gain) const;
    Eigen::Vector3d normalAt(unsigned u, unsigned v) const;

    Camera camera_;
    PhotometricOptions photometric_;
    IsStopped isStopped_;
    std::size_t pitch_;  ///< of the padded copies: a column before and whole vectors after
    std::vector<float> intensity_, inverseDepth_, observed_;
    std::vector<float> residual_;  ///< kUnused where a pixel does not count
    double meanInverseDepth_ = 0.;
};

/// 1.4826 times the median of |r| over the values below 2 (larger ones mark unused pixels).
double robustSigmaOf(const std::vector<float>& residuals);

}  // namespace photonav
