// SPDX-License-Identifier: BSD-3-Clause
// The pixels of a keyframe that have texture, and their look-up in another image. Included by .cpp
// files only.
#pragma once

#include <vector>

#include "alignment/gradient_noise.hpp"
#include "alignment/keyframe_model.hpp"
#include "photometry/simd.hpp"

namespace photonav {

/// Half the size: mean of two by two pixels. Odd last rows and columns are dropped.
ImageF halvedByMean(const ImageF& image);

/// Half the size: mean of the depths that are there, of two by two; nothing where they are spread
/// by more than `spread` times the nearest.
ImageF halvedDepth(const ImageF& depth, float spread);

/// One level of a keyframe.
class PointSet {
  public:
    /// Keeps the pixels that are used by the rules of photometricInformation() and have a gradient.
    PointSet(const View& view, const Camera& camera, const KeyframeOptions& options);

    /// Looks up every point in `observed` (bilinear), an image of the same camera. xi of the
    /// equations is the perturbation of T on the right, T = T_mean exp(xi^). The noise of the
    /// keyframe has gradients too; their contribution to AtA is subtracted.
    /// @param T_c_k from the keyframe to the camera
    NormalEquations compare(const ImageF& observed, const Pose& T_c_k, const Exposure& exposure,
                            const Loss& loss);

    /// The equations of compare() by blocks of the keyframe's image, after it and with its
    /// arguments.
    std::vector<ImageBlock> blocks(const ImageF& observed, const Pose& T_c_k,
                                   const Exposure& exposure, const Loss& loss) const;

    const Camera& camera() const { return camera_; }
    std::size_t size() const { return size_; }
    /// Robust standard deviation of a sample of the residuals of the last comparison.
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
    Matrix8 withoutNoise_ = Matrix8::Identity();  ///< of GradientNoise, last comparison
    std::vector<float> residualSample_;
};

}  // namespace photonav
