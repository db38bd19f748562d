// SPDX-License-Identifier: BSD-3-Clause
// Alignment with a prior that is wider than the basin of convergence.
#pragma once

#include "alignment/dense_aligner.hpp"

namespace photonav {

/// Finds the most likely pose given an image and a prior. If the image content may have moved by
/// more than a few pixels, texture can match in several places. Therefore small views from poses
/// all over the prior are compared with the image, and the most similar ones are aligned at small
/// size. Full alignments start from the best of these. The best result is then shifted to the
/// results of the other alignments and aligned again, which finds the other bars of a grating.
///
/// The best pose is the result if its residuals are within the image noise (in a map of cells: or
/// within the texture that is finer than the cells), the image has enough texture, and no other
/// pose explains the image almost as well. Otherwise the result is the prior. The verdict is then
/// `degenerate` along all axes if several poses match or the residuals are below
/// TrustOptions::residualSigmas, and lost if no pose matches.
///
/// Fine texture may also repeat within a narrow prior, as books on a shelf do. The poses that
/// repetitions() predicts from the view at the result are then aligned as well, and the best one is
/// the result. If no pose is much better than the others, the result is the prior.
class WideAligner {
  public:
    /// @param model must outlive the aligner
    /// @throws std::invalid_argument as DenseAligner does
    WideAligner(const ViewSource& model, const Camera& camera, const AlignmentOptions& options);

    /// The most likely pose given the image and a prior of T_c_w. Not thread-safe.
    /// @param observed grey values in [0, 1], of the camera's size
    /// @throws std::invalid_argument for an image of another size
    Alignment align(const ImageF& observed, const UncertainPose& prior);

  private:
    std::vector<Pose> likelyStarts(const ImageF& observed, const UncertainPose& prior,
                                   double depth);
    static std::vector<Alignment> alignFrom(const std::vector<Pose>& starts, DenseAligner& aligner,
                                            const ImageF& observed, const UncertainPose& prior);
    double residualVariance(const ImageF& observed, double depth) const;
    double pixels() const;
    double weight() const;
    double costOf(const Alignment& alignment, const UncertainPose& prior) const;
    const Alignment& likeliest(const std::vector<Alignment>& found,
                               const UncertainPose& prior) const;
    bool fits(const Alignment& alignment) const;
    double pixel(const Alignment& alignment) const;
    bool isElsewhere(const Alignment& alignment, const Alignment& best) const;
    std::vector<Pose> ambiguousMatches(const Alignment& best, const std::vector<Alignment>& found,
                                       const UncertainPose& prior) const;
    bool areApart(const Alignment& a, const Alignment& b, const Alignment& at) const;
    Alignment bestRepetition(const Alignment& first, const ImageF& observed,
                             const UncertainPose& prior);
    bool isAmbiguous(const Alignment& best, const std::vector<Alignment>& found,
                     const UncertainPose& prior) const;

    const ViewSource& model_;
    DenseAligner aligner_;
    DenseAligner small_;      ///< images of a quarter of the size
    DenseAligner near_;       ///< starts at the best poses of small images
    DenseAligner final_;      ///< starts at the best pose, with measured slope
    DenseAligner fine_;       ///< starts at repetitions of texture, at full size alone
    DenseAligner fineFinal_;  ///< starts at the best of these, with measured slope
    double variance_ = 0.;    ///< of the residuals of the present image at the right pose
};

}  // namespace photonav
