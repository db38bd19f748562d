// SPDX-License-Identifier: BSD-3-Clause
// Alignment where the prior is wider than the basin of convergence.
#pragma once

#include "alignment/dense_aligner.hpp"

namespace photonav {

/// Standard deviation of a prior within which one start suffices [pixels].
inline constexpr double kBasinSigma = 6.;

/// Distance between the views that a search of a prior compares, as motion of the image [pixels].
/// The number of views is limited: from some width on they are farther apart.
/// @param covariance of the prior, camera frame; @param depth mean depth of the view [m]
double searchSpacing(const Matrix6& covariance, const Camera& camera, double depth);

/// Farther apart, the true pose can be outside the basins of both views beside it: the search no
/// longer covers the prior.
inline constexpr double kWidestSearchSpacing = 2. * kBasinSigma;

/// Finds the most likely pose given an image and a prior. If the image content may have moved by
/// more than a few pixels, texture matches in several places. Therefore small views from poses all
/// over the prior are compared with the image, and the most similar ones are aligned; full
/// alignments start from the best of these. The best result is then shifted to where other
/// alignments ended and aligned again: this finds the other bars of a grating.
///
/// The best pose is the result if it explains the image down to the noise and, in a map of cells,
/// to the texture that is finer than they are, the image has enough texture, and no other pose
/// explains it almost as well. Otherwise the result is the prior, and the verdict is `degenerate`
/// along all axes (several poses match, or what is left unexplained is below
/// TrustOptions::residualSigmas) or lost (no pose matches).
///
/// Fine texture may repeat within a prior that is not wide, too, as books on a shelf do. The
/// repetitions() of the view at the result are then aligned as well, and the best is the result;
/// where none is much better than the others it is the prior.
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
    double residualVariance(const ImageF& observed, double depth) const;
    double pixels() const;
    double weight() const;
    double costOf(const Alignment& alignment, const UncertainPose& prior) const;
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
