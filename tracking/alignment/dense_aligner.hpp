// SPDX-License-Identifier: BSD-3-Clause
// Where a camera is in a model, from one image: dense photometric alignment.
#pragma once

#include <memory>

#include "alignment/coarse_to_fine.hpp"

namespace photonav {

/// Aligns images to a model that is rendered anew at every iterate and compared pixel by pixel with
/// the observed image; the gradient is that of the synthetic image. (Warping the noisy image
/// instead, with its own gradients, makes the covariance several times too small.) Coarse to fine,
/// Gauss-Newton with Levenberg's damping.
///
/// With T_c_w = exp(xi^) T the predicted image changes by -J xi (photometric.hpp), so that observed
/// - predicted = -J xi + noise. Along open directions, only a prior can change the pose.
class DenseAligner {
  public:
    /// @param model must outlive the aligner
    /// @throws std::invalid_argument for images below 3 x 3 pixels or a stride other than 1
    DenseAligner(const ViewSource& model, const Camera& camera,
                 const AlignmentOptions& options = {});
    ~DenseAligner();
    DenseAligner(DenseAligner&&) noexcept;
    DenseAligner& operator=(DenseAligner&&) noexcept;

    /// The most likely pose given the image alone. Does not throw because of the image's content:
    /// see the verdict. Not thread-safe (buffers are reused).
    /// @param observed of the camera's size @throws std::invalid_argument otherwise
    Alignment align(const ImageF& observed, const Pose& T_start);

    /// The most likely pose given the image and a prior, starting at its mean. The covariance is
    /// (Lambda + P^-1)^-1, P the prior's covariance transported() to the result.
    Alignment align(const ImageF& observed, const UncertainPose& prior);

    /// The same, starting at another pose.
    Alignment align(const ImageF& observed, const UncertainPose& prior, const Pose& T_start);

    const AlignmentOptions& options() const;
    const Camera& camera() const;

  private:
    class RenderedModel;
    std::unique_ptr<RenderedModel> model_;
};

}  // namespace photonav
