// SPDX-License-Identifier: BSD-3-Clause
// The pose of a camera in a model from one image: dense photometric alignment.
#pragma once

#include <memory>

#include "alignment/coarse_to_fine.hpp"

namespace photonav {

/// Aligns images to a model. The model is rendered at every iterate and compared pixel by pixel
/// with the observed image. Gradients are those of the rendered image. (Gradients of the observed,
/// noisy image, warped to the model, would make the covariance several times too small.)
/// Coarse-to-fine Gauss-Newton with Levenberg's damping.
///
/// With T_c_w = exp(xi^) T the predicted image changes by -J xi (photometric.hpp):
///     observed - predicted = -J xi + noise.
/// In open directions (TrustOptions::openSigma) only a prior changes the pose.
class DenseAligner {
  public:
    /// @param model must outlive the aligner
    /// @throws std::invalid_argument for images below 3 x 3 pixels or a stride other than 1
    DenseAligner(const ViewSource& model, const Camera& camera,
                 const AlignmentOptions& options = {});
    ~DenseAligner();
    DenseAligner(DenseAligner&&) noexcept;
    DenseAligner& operator=(DenseAligner&&) noexcept;

    /// The most likely pose given the image alone. An image that cannot be aligned gives a verdict
    /// that isLost(), not an exception. Not thread-safe (buffers are reused).
    /// @param observed grey values in [0, 1], of the camera's size
    /// @param T_start camera pose T_c_w from which the alignment starts
    /// @throws std::invalid_argument for an image of another size
    Alignment align(const ImageF& observed, const Pose& T_start);

    /// The most likely pose given the image and a prior of T_c_w, starting at the prior's mean. The
    /// covariance is (Lambda + P^-1)^-1, where P is the prior's covariance transported() to the
    /// result.
    Alignment align(const ImageF& observed, const UncertainPose& prior);

    /// The most likely pose given the image and a prior of T_c_w, starting at `T_start`.
    Alignment align(const ImageF& observed, const UncertainPose& prior, const Pose& T_start);

    const AlignmentOptions& options() const;
    const Camera& camera() const;

  private:
    class RenderedModel;
    std::unique_ptr<RenderedModel> model_;
};

}  // namespace photonav
