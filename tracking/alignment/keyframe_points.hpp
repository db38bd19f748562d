// SPDX-License-Identifier: BSD-3-Clause
// The pixels of a keyframe that have texture, and their comparison with another image. Included by
// .cpp files only.
#pragma once

#include <vector>

#include "alignment/gradient_noise.hpp"
#include "alignment/keyframe_model.hpp"
#include "photometry/simd.hpp"

namespace photonav {

/// The image at half the size: means of 2 x 2 pixels. Odd last rows and columns are dropped.
ImageF halvedByMean(const ImageF& image);

/// The depth image at half the size: mean of the measured depths among 2 x 2 pixels; 0 if they
/// differ by more than `spread` times the smallest, or if two or more are not measured: most of the
/// grey value of such a pixel may be that of something else, as at the border of an object.
ImageF halvedDepth(const ImageF& depth, float spread);

/// The points of one level of a keyframe.
class PointSet {
  public:
    /// Takes the pixels that are used by the rules of photometricInformation() and KeyframeOptions.
    PointSet(const View& view, const Camera& camera, const KeyframeOptions& options);

    /// Compares every point with `observed`, an image of the same camera, at its projection
    /// (bilinear). xi of the equations is the left perturbation of T_c_k: T_c_k = exp(xi^) T_mean.
    /// The noise of the keyframe has gradients too; their contribution to AtA is subtracted
    /// (GradientNoise).
    /// @param T_c_k transforms from the keyframe to the camera
    NormalEquations compare(const ImageF& observed, const Pose& T_c_k, const Exposure& exposure,
                            const Loss& loss);

    /// The equations of the last compare() by blocks of the keyframe's image, for the same
    /// arguments.
    std::vector<ImageBlock> blocks(const ImageF& observed, const Pose& T_c_k,
                                   const Exposure& exposure, const Loss& loss) const;

    const Camera& camera() const { return camera_; }
    std::size_t size() const { return size_; }  ///< number of points
    /// Robust standard deviation of a sample of the residuals of the last comparison [grey value].
    double robustSigma() const { return robustSigmaOf(residualSample_); }

  private:
    struct Row;
    struct Rule;
    struct Projection;
    void append(const Row& row, unsigned left, unsigned right);
    void finish();

    Camera camera_;
    std::size_t size_ = 0;
    double meanInverseDepth_ = 0.;
    double maxNoise_;  ///< variance of gx and of gy, if they were of white noise
    GradientNoise noise_;
    /// Structure of arrays, padded to whole vectors with points that are never in view: normalised
    /// coordinates, inverse depth [1/m], grey value, gradient as J has it (per pixel / 2).
    std::vector<float> x_, y_, w_, intensity_, gx_, gy_;
    std::vector<std::size_t> blockBegin_;  ///< first point of each ImageBlock; the end at the back
    std::vector<Eigen::Array2i> blockIndex_;
    /// From the perturbation of the last comparison to the one of its sums: what GradientNoise
    /// leaves of them, on the right.
    Matrix6 ofPoints_ = Matrix6::Identity();
    std::vector<float> residualSample_;
};

}  // namespace photonav
