// SPDX-License-Identifier: BSD-3-Clause
// Alignment where the prior is wider than the basin of convergence.
#pragma once

#include "alignment/dense_aligner.hpp"

namespace photonav {

/// The pose most likely given an image and a prior. Where the image's content
/// may have moved by more than a few pixels, texture matches in several places: small views from
/// all over the prior are compared with the image and the most alike of them aligned; full
/// alignments begin where the best of these end. The best is tried again where others ended, moved
/// there as it is: that finds the other bars of a grating. It is the answer, if it explains the
/// image down to the noise, the image shows enough, and nothing else explains it almost as well.
/// Otherwise the result is the prior, and the verdict `degenerate` along all axes (the image does
/// not say which place it is) or lost (it is none of them).
class WideAligner {
  public:
    /// @param model must outlive the aligner
    /// @throws std::invalid_argument as DenseAligner does
    WideAligner(const ViewSource& model, const Camera& camera, const AlignmentOptions& options);

    /// @param observed of the camera's size @throws std::invalid_argument otherwise
    Alignment align(const ImageF& observed, const UncertainPose& prior);

  private:
    std::vector<Pose> likelyStarts(const ImageF& observed, const UncertainPose& prior,
                                   double depth);
    static std::vector<Alignment> alignFrom(const std::vector<Pose>& starts, DenseAligner& aligner,
                                            const ImageF& observed, const UncertainPose& prior);
    double pixels() const;
    double weight() const;
    double costOf(const Alignment& alignment, const UncertainPose& prior) const;
    bool fits(const Alignment& alignment) const;
    double pixel(const Alignment& alignment) const;
    bool isElsewhere(const Alignment& alignment, const Alignment& best) const;
    std::vector<Pose> ambiguousMatches(const Alignment& best, const std::vector<Alignment>& found,
                                       const UncertainPose& prior) const;
    bool hasRival(const Alignment& best, const std::vector<Alignment>& found,
                  const UncertainPose& prior) const;

    const ViewSource& model_;
    DenseAligner aligner_;
    DenseAligner small_;  ///< images of a quarter of the size
    DenseAligner near_;   ///< from where small images agree
    DenseAligner final_;  ///< and once more, with the slope measured
};

}  // namespace photonav
