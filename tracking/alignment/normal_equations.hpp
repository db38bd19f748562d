// SPDX-License-Identifier: BSD-3-Clause
// The normal equations of Gauss-Newton at one pose, from one pass over an image pair.
#pragma once

#include <algorithm>
#include <vector>

#include "alignment/shared_gradients.hpp"
#include "photometry/photometric.hpp"

namespace photonav {

using Vector8 = Eigen::Matrix<double, 8, 1>;
using Matrix8 = Eigen::Matrix<double, 8, 8>;

/// How residuals are weighted. `huber` and `tukey` keep 95 % of the efficiency on Gaussian noise.
enum class RobustWeight { none, huber, tukey };

/// A robust loss for residuals of the given scale.
struct Loss {
    RobustWeight kind = RobustWeight::none;
    double sigma = 1.;  ///< standard deviation of the inliers [grey value]

    /// Residual at which weights begin to fall (huber: 1.345 sigma) or end (tukey: 4.685 sigma).
    double width() const { return (kind == RobustWeight::huber ? 1.345 : 4.685) * sigma; }
};

/// observed = gain * predicted + offset.
struct Exposure {
    double gain = 1.;
    double offset = 0.;
};

/// Sums with b, by which the exposed prediction changes per pixel^2 of blur, to first order: half
/// of its Laplacian.
struct BlurSums {
    Vector8 Atb = Vector8::Zero();  ///< sum w A^T b
    double btb = 0.;                ///< sum w b^2
    double btr = 0.;                ///< sum w b r

    /// Variance of the blur after the image, divided by `noise`; times btr it is the likeliest
    /// blur.
    /// @param sigma standard deviation of the blur without the image [pixels^2]
    /// @param noise variance of a pixel [grey value^2]
    double variance(double sigma, double noise) const {
        return sigma > 0. && btb > 0. ? 1. / (btb + noise / (sigma * sigma)) : 0.;
    }
};

/// Sums over the pixels that count, for residuals r = observed - (gain * predicted + offset) and
/// unknowns (xi, d gain, d offset), where xi is the left perturbation of the camera pose:
/// r = A (xi, dg, do), A = [-gain * J | predicted | 1], J as in photometricInformation().
struct NormalEquations {
    Matrix8 AtA = Matrix8::Zero();  ///< sum w A^T A
    Vector8 Atr = Vector8::Zero();  ///< sum w A^T r
    double loss = 0.;               ///< sum rho(r), rho = r^2 where the weight is one
    double count = 0.;              ///< pixels used
    double sum = 0.;                ///< of r, not weighted
    double sumSquares = 0.;         ///< of r^2, not weighted
    double sumPredicted = 0.;       ///< of the predicted grey values, not weighted
    double sumPredictedSquares = 0.;
    double sumPredictedTimesR = 0.;
    double meanInverseDepth = 0.;  ///< over the surfaces in view [1/m]; 0: none
    BlurSums byBlur;               ///< zero where it is not known
};

/// The equations of an image that is blurrier than the prediction by an unknown variance, which is
/// eliminated. Where an edge is all that is in view, its width would tell the distance otherwise.
/// @param sigma standard deviation of that variance, whose mean is zero [pixels^2]
/// @param noise variance of a pixel [grey value^2]
NormalEquations withoutBlur(NormalEquations e, double sigma, double noise);

/// The part of NormalEquations that comes from one block of the image.
struct ImageBlock {
    /// Edge of a block [pixels], a multiple of eight: about a 24th of the image's width.
    static unsigned side(const Camera& camera) {
        return 8 * std::max(1U, (camera.width + 96) / 192);
    }

    Matrix8 AtA = Matrix8::Zero();
    Vector8 Atr = Vector8::Zero();
    BlurSums byBlur;
    Eigen::Array2i index = Eigen::Array2i::Zero();     ///< column and row of the block
    Eigen::Vector3d normal = Eigen::Vector3d::Zero();  ///< of the surface, camera frame; 0: unknown
};

/// The blocks with the residuals that the likeliest blur leaves; parameters as above.
std::vector<ImageBlock> withoutBlur(std::vector<ImageBlock> blocks, double sigma, double noise);

/// Compares a predicted view with an observed image, pixel by pixel at the same place. The gradient
/// is that of the prediction. Pixels are chosen by the prediction alone, by the rules of
/// photometricInformation(), whose Lambda this is (times sigma^2, without weights).
/// `photometric.stride` must be 1.
class ViewComparison {
  public:
    ViewComparison(const Camera& camera, const PhotometricOptions& photometric);

    /// @throws std::invalid_argument when the images and the camera differ in size
    NormalEquations operator()(const View& predicted, const ImageF& observed,
                               const Exposure& exposure, const Loss& loss);

    /// 1.4826 times the median of |r| of the last call; 0 when no pixel counted.
    double robustSigma() const;

    /// The equations of the last call by blocks of the image.
    std::vector<ImageBlock> blocks(const Exposure& exposure, const Loss& loss) const;

    /// sharedSlope() of the prediction's gradients, as they were exposed, with those of the
    /// observed image, last call.
    Matrix6 sharedSlope(const Exposure& exposure) const;

  private:
    void load(const View& predicted, const ImageF& observed);
    GradientTile tileAt(unsigned left, unsigned top, double gain) const;
    Eigen::Vector3d normalAt(unsigned u, unsigned v) const;

    Camera camera_;
    PhotometricOptions photometric_;
    std::size_t pitch_;  ///< of the padded copies: a column before and whole vectors after
    std::vector<float> intensity_, inverseDepth_, observed_;
    std::vector<float> residual_;  ///< kUnused where a pixel does not count
    double meanInverseDepth_ = 0.;
};

/// 1.4826 times the median of |r| over the values below 2 (larger ones mark unused pixels).
double robustSigmaOf(const std::vector<float>& residuals);

}  // namespace photonav
