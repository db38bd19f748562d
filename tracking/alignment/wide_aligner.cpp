// SPDX-License-Identifier: BSD-3-Clause
#include "alignment/wide_aligner.hpp"

#include <algorithm>
#include <cmath>

#include "alignment/hole_margin.hpp"
#include "alignment/image_pyramid.hpp"
#include "alignment/repeated_texture.hpp"
#include "alignment/search_grid.hpp"
#include "geometry/eigensystem.hpp"
#include "geometry/gaussian.hpp"
#include "geometry/se3.hpp"

namespace photonav {
namespace {

constexpr std::size_t kTried = 64;   // most similar views, which are aligned at small size
constexpr std::size_t kStarts = 8;   // of full alignments, at most
constexpr double kJitter = 1.5;      // of starts, as hard edges may stop alignments [pixels]
constexpr double kNoiseSlack = 1.1;  // factor on the variance of the image noise
constexpr double kMisfit = 0.02;     // share of the images' variance, beyond noise, left
                                     // unexplained at the right pose
constexpr double kAmbiguous = 12.;   // least difference of -2 log likelihood between two poses
                                     // that decides for one of them
constexpr double kNarrow = 0.1;      // share of the pixels with contrast: less is a strip
constexpr double kMinShown = 0.13;   // explained variance of a strip, per pixel and times its
                                     // weight: a strip with less fits anywhere
constexpr double kStuck = 0.3;       // share of the explained variance that decides between poses
                                     // if all repetitions along a single wide axis were tried, as
                                     // hard edges stop alignments a pixel from the right pose
constexpr double kElsewhere = 30.;   // squared Mahalanobis distance of another place
constexpr double kNextApart = 1.5;   // of two repetitions, at least [pixels]

/// Share of the pixels that have an image's contrast: the participation ratio of its squares.
double contrastShare(const ImageF& image) {
    const auto pixels = Eigen::Map<const Eigen::ArrayXf>(image.bitmap, image.getSize());
    const Eigen::ArrayXd squares = (pixels - pixels.mean()).cast<double>().square();
    const double fourth = squares.square().sum();
    return fourth > 0. ? squares.sum() * squares.sum() / (fourth * double(squares.size())) : 0.;
}

/// -2 log likelihood of the observed pixels for which a surface is predicted, with the likeliest
/// exposure.
/// @param weight factor that turns mean square differences into -2 log likelihoods
double misfit(const ImageF& observed, const View& predicted, double weight,
              const std::optional<ExposurePrior>& prior) {
    Eigen::Matrix2d AtA = Eigen::Matrix2d::Zero();  // of gain and offset, from 1 and 0
    Eigen::Vector2d Atr = Eigen::Vector2d::Zero();
    double sum = 0.;
    for (unsigned i = 0; i < observed.getSize(); ++i) {
        if (predicted.depth.bitmap[i] <= 0.F) continue;
        const Eigen::Vector2d a(predicted.intensity.bitmap[i], 1.);
        const double r = observed.bitmap[i] - a[0];
        AtA += a * a.transpose();
        Atr += r * a;
        sum += r * r;
    }
    const double count = AtA(1, 1);
    if (count == 0.) return weight;
    AtA *= weight / count;
    Atr *= weight / count;
    if (!prior) return weight * sum / count;
    // Slightly raised diagonal: gain and offset cannot be separated in a uniform image.
    AtA.diagonal() += prior->information() + Eigen::Vector2d::Constant(1e-9 * weight);
    return weight * sum / count - Atr.dot(AtA.inverse() * Atr);
}

/// Largest eigenvalue of the prior's covariance times Lambda. Below one, the image informs less
/// than the prior in all directions.
double informationRatio(const Alignment& a, const UncertainPose& prior) {
    const Matrix6 root = rootOf(prior.covariance);
    return eigensystem(root.transpose() * a.information * root).values[5];
}

Camera quartered(const Camera& camera) { return halved(halved(camera)); }

/// To find where to begin.
AlignmentOptions unmeasured(AlignmentOptions options) {
    options.measureSlope = options.measureCovariance = false;
    return options;
}

/// For images of a quarter of the size, with the same information as the whole image.
AlignmentOptions forSmall(AlignmentOptions options) {
    options.levels = 1;
    options.maxIterations = 10;
    options.photometric.scale *= 16.;
    return options;
}

/// On coarser levels all starts would converge to the same pose: beside white, a strip of texture
/// is averaged away.
AlignmentOptions forNear(AlignmentOptions options) {
    options.levels = 2;
    return options;
}

/// Coarser levels average fine texture away, and lead to any of its repetitions.
AlignmentOptions forFine(AlignmentOptions options) {
    options.levels = 1;
    return options;
}

Alignment undecided(Alignment a, const UncertainPose& prior, Verdict verdict) {
    a.T_c_w = prior.mean;
    a.covariance = prior.covariance;
    a.verdict = verdict;
    if (verdict == Verdict::degenerate)
        a.openDirections.assign(kTwistAxes.begin(), kTwistAxes.end());
    return a;
}

struct Start {
    Pose T_c_w;
    double cost;  ///< -2 log likelihood
};

void sortByCost(std::vector<Start>& starts) {
    std::sort(starts.begin(), starts.end(),
              [](const Start& a, const Start& b) { return a.cost < b.cost; });
}

/// The first `most` starts, without those closer than `distance` [m] to an earlier one.
std::vector<Pose> distinct(const std::vector<Start>& starts, double distance, std::size_t most) {
    std::vector<Pose> chosen;
    for (const Start& start : starts) {
        const auto isNear = [&](const Pose& T_c_w) {
            return (start.T_c_w * T_c_w.inverse()).translation().norm() < distance;
        };
        if (chosen.size() < most && std::none_of(chosen.begin(), chosen.end(), isNear)) {
            chosen.push_back(start.T_c_w);
        }
    }
    return chosen;
}

}  // namespace

WideAligner::WideAligner(const ViewSource& model, const Camera& camera,
                         const AlignmentOptions& options)
    : model_(model),
      aligner_(model, camera, options),
      small_(model, quartered(camera), forSmall(unmeasured(options))),
      near_(model, camera, forNear(unmeasured(options))),
      final_(model, camera, forNear(options)),
      fine_(model, camera, forFine(unmeasured(options))),
      fineFinal_(model, camera, forFine(options)) {}

/// Poses within the prior whose views, at a quarter of the size, are most similar to the image.
std::vector<Pose> WideAligner::likelyStarts(const ImageF& observed, const UncertainPose& prior,
                                            double depth) {
    const ImageF image = halvedAsRendered(halvedAsRendered(observed));
    const ImageMotion motion = imageMotionOf(prior.covariance, aligner_.camera(), depth);
    std::vector<Start> starts;
    View view;
    const HoleMargin margin = holeMargin(prior.covariance, small_.camera(), depth);
    for (const Vector6& place : placesWithin(motion.sigmas)) {
        const Pose T_c_w = expSE3(motion.axes * place) * prior.mean;
        model_.render(small_.camera(), T_c_w, view);
        widenHoles(view, margin);
        starts.push_back(
            {T_c_w, misfit(image, view, weight(), aligner_.options().exposure) +
                        place.cwiseQuotient(motion.sigmas.cwiseMax(1e-3)).squaredNorm()});
    }
    sortByCost(starts);
    if (starts.size() > kTried) starts.resize(kTried);
    std::vector<Start> aligned;
    for (const Start& start : starts) {
        const Alignment a = small_.align(image, prior, start.T_c_w);
        const bool hasNoOverlap = a.verdict == Verdict::lostOverlap;
        aligned.push_back({a.T_c_w, hasNoOverlap ? kInfinity : costOf(a, prior)});
    }
    sortByCost(aligned);
    const double apart = 0.5 * kSearchSpacing * depth / aligner_.camera().fx();
    std::vector<Pose> likely = distinct(aligned, apart, kStarts);
    // Alignments do without the outermost pixels, which are many of a small image: where texture is
    // only there, they all end at the prior's mean.
    for (const Pose& T_c_w : distinct(starts, apart, kStarts)) likely.push_back(T_c_w);
    return likely;
}

/// Variance of the residuals that image noise leaves, and texture too fine for the model.
/// @param depth of the surfaces in view, mean [m]
double WideAligner::residualVariance(const ImageF& observed, double depth) const {
    const double noise = std::pow(aligner_.options().photometric.sigma, 2);
    const double cell = aligner_.options().cellSize;
    return std::max(noise, finerThan(cell, depth, aligner_.camera(), observed));
}

double WideAligner::pixels() const {
    return double(aligner_.camera().width) * aligner_.camera().height;
}

/// Factor that turns mean square residuals into -2 log likelihoods.
double WideAligner::weight() const {
    const PhotometricOptions& p = aligner_.options().photometric;
    return p.scale * pixels() / variance_;
}

/// -2 log likelihood of image and priors.
double WideAligner::costOf(const Alignment& a, const UncertainPose& prior) const {
    const auto& exposure = aligner_.options().exposure;
    const Vector6 e = deviation(a.T_c_w, prior.mean);
    return weight() * a.residual.rms * a.residual.rms +
           (exposure ? exposure->squaredDistance(a.exposure) : 0.) +
           squaredDistance(e, transported(prior.covariance, e));
}

const Alignment& WideAligner::likeliest(const std::vector<Alignment>& found,
                                        const UncertainPose& prior) const {
    return *std::ranges::min_element(found, {},
                                     [&](const Alignment& a) { return costOf(a, prior); });
}

/// Whether image and prediction agree down to what no pose explains, relative to the contrast in
/// view: where a strip of texture comes into view beside white, the wrong strip differs in few
/// pixels.
bool WideAligner::fits(const Alignment& a) const {
    const double noise = kNoiseSlack * variance_;
    const double square = a.residual.rms * a.residual.rms;
    return square <= noise || a.residual.unexplained * (1. - noise / square) < kMisfit;
}

/// Size of a pixel on the surfaces in view [m].
double WideAligner::pixel(const Alignment& a) const { return a.meanDepth / aligner_.camera().fx(); }

bool WideAligner::isElsewhere(const Alignment& a, const Alignment& best) const {
    const Vector6 apart = deviation(a.T_c_w, best.T_c_w);
    return apart.head<3>().norm() > kSearchSpacing * pixel(best) &&
           squaredDistance(apart, best.covariance) > kElsewhere;
}

/// Starts at ambiguous matches: the best pose, shifted along axes of large image motion to where
/// other alignments ended that explain the image worse. Repeated texture matches there if the other
/// axes are as at the best pose, where alignments from elsewhere may have stopped early.
std::vector<Pose> WideAligner::ambiguousMatches(const Alignment& best,
                                                const std::vector<Alignment>& found,
                                                const UncertainPose& prior) const {
    const ImageMotion motion = imageMotionOf(prior.covariance, aligner_.camera(), best.meanDepth);
    const Vector6 isWide = (motion.sigmas.array() >= kBasinSigma).cast<double>();
    const Matrix6 alongWide = motion.axes * isWide.asDiagonal() * motion.axes.inverse();
    std::vector<Start> starts;
    const double least = costOf(best, prior);
    for (const Alignment& a : found) {
        const double cost = costOf(a, prior);
        if (!isElsewhere(a, best) || cost < least + kAmbiguous) continue;
        const Vector6 apart = logSE3(a.T_c_w * best.T_c_w.inverse());
        starts.push_back({expSE3(alongWide * apart) * best.T_c_w, cost});
    }
    sortByCost(starts);
    std::vector<Pose> around;
    for (const Pose& T_c_w : distinct(starts, 0.5 * kSearchSpacing * pixel(best), kStarts)) {
        for (const double pixels : {0., -kJitter, kJitter}) {
            around.push_back(expSE3(pixels * motion.axes.col(5)) * T_c_w);
        }
    }
    return around;
}

/// Whether another place explains the image almost as well.
bool WideAligner::isAmbiguous(const Alignment& best, const std::vector<Alignment>& found,
                              const UncertainPose& prior) const {
    const ImageMotion motion = imageMotionOf(prior.covariance, aligner_.camera(), best.meanDepth);
    const double stuck =
        motion.sigmas[4] < kBasinSigma ? kStuck * weight() * best.residual.explained : 0.;
    const double decides = std::max(kAmbiguous, stuck);
    const double least = costOf(best, prior);
    return std::any_of(found.begin(), found.end(), [&](const Alignment& a) {
        return isElsewhere(a, best) && costOf(a, prior) < least + decides;
    });
}

/// The alignments from these starts that are not lost.
std::vector<Alignment> WideAligner::alignFrom(const std::vector<Pose>& starts,
                                              DenseAligner& aligner, const ImageF& observed,
                                              const UncertainPose& prior) {
    std::vector<Alignment> found;
    for (const Pose& T_start_w : starts) {
        const Alignment a = aligner.align(observed, prior, T_start_w);
        if (!isLost(a.verdict)) found.push_back(a);
    }
    return found;
}

/// Whether two alignments found different repetitions of the texture in view.
/// @param at an alignment of either, with its covariance measured: along bars there is one place
bool WideAligner::areApart(const Alignment& a, const Alignment& b, const Alignment& at) const {
    const Vector6 apart = deviation(a.T_c_w, b.T_c_w);
    const double radians = apart.head<3>().norm() / at.meanDepth + apart.tail<3>().norm();
    return aligner_.camera().fx() * radians > kNextApart &&
           squaredDistance(apart, at.covariance) > kElsewhere;
}

/// Where texture repeats within the prior, the first alignment may have found any repetition. The
/// others are aligned as well, and the best is the result, if there is one.
Alignment WideAligner::bestRepetition(const Alignment& first, const ImageF& observed,
                                      const UncertainPose& prior) {
    View predicted;
    model_.render(aligner_.camera(), first.T_c_w, predicted);
    std::vector<Pose> starts{first.T_c_w};
    for (const Vector6& xi :
         repetitions(predicted, first.T_c_w, prior, aligner_.camera(), weight() / pixels())) {
        if (starts.size() <= kStarts) starts.push_back(expSE3(xi) * first.T_c_w);
    }
    if (starts.size() == 1) return first;
    auto found = alignFrom(starts, fine_, observed, prior);
    found.push_back(first);
    const Alignment& best = likeliest(found, prior);
    const double decides = costOf(best, prior) + kAmbiguous;
    const auto isRival = [&](const Alignment& a) {
        return areApart(a, best, first) && costOf(a, prior) < decides;
    };
    if (std::any_of(found.begin(), found.end(), isRival)) {
        return undecided(best, prior, Verdict::degenerate);
    }
    return areApart(first, best, first) ? fineFinal_.align(observed, prior, best.T_c_w) : first;
}

Alignment WideAligner::align(const ImageF& observed, const UncertainPose& prior) {
    const Alignment first = aligner_.align(observed, prior);
    variance_ = residualVariance(observed, first.meanDepth);
    if (informationRatio(first, prior) < 1. && fits(first)) return first;
    View expected;
    model_.render(small_.camera(), prior.mean, expected);
    const double depth = meanDepth(expected);
    if (imageMotionOf(prior.covariance, aligner_.camera(), depth).sigmas.maxCoeff() < kBasinSigma) {
        // The texture may be elsewhere because it is another repetition's.
        const bool isFound = !isLost(first.verdict) || first.verdict == Verdict::lostTexture;
        return isFound ? bestRepetition(first, observed, prior) : first;
    }

    auto found = alignFrom(likelyStarts(observed, prior, depth), near_, observed, prior);
    if (!isLost(first.verdict)) found.push_back(first);
    if (found.empty()) return first;
    Alignment best = final_.align(observed, prior, likeliest(found, prior).T_c_w);
    if (isLost(best.verdict)) return undecided(best, prior, best.verdict);
    for (Alignment& a : alignFrom(ambiguousMatches(best, found, prior), final_, observed, prior)) {
        if (costOf(a, prior) < costOf(best, prior)) std::swap(a, best);
        found.push_back(a);
    }
    if (!fits(best)) {
        // So little contrast, in a map with noise of its own, neither confirms nor contradicts.
        const TrustOptions& trust = aligner_.options().trust;
        const double most = trust.residualSigmas * aligner_.options().photometric.sigma;
        return undecided(best, prior,
                         best.residual.rms > most ? Verdict::lostResidual : Verdict::degenerate);
    }
    // If the expected view has texture and the image has none, no pose is found: all poses without
    // texture in view are as likely, and the information of the expected view is not in the image.
    model_.render(small_.camera(), best.T_c_w, expected);
    const double explained = weight() * best.residual.explained;
    const bool isStrip = contrastShare(expected.intensity) < kNarrow;
    const double least = isStrip ? kMinShown * pixels() : kAmbiguous;
    if (explained < least || isAmbiguous(best, found, prior)) {
        return undecided(best, prior, Verdict::degenerate);
    }
    return bestRepetition(best, observed, prior);
}

}  // namespace photonav
