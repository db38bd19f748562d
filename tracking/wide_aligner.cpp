// SPDX-License-Identifier: BSD-3-Clause
#include "wide_aligner.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "image_pyramid.hpp"
#include "se3.hpp"

namespace photonav {
namespace {

constexpr double kPlay = 6.;         // standard deviation that one start can find from [pixels]
constexpr double kSpacing = 8.;      // of the views compared [pixels of play]
constexpr double kReach = 2.5;       // that they cover [standard deviations]
constexpr double kMostPlaces = 4e3;  // of these views: beyond, they lie wider apart
constexpr std::size_t kStarts = 8;   // of alignments, at most
constexpr double kNoiseSlack = 1.1;  // of the image noise's variance
constexpr double kMisfit = 0.02;     // of the images' variance, beyond noise, at the right place
constexpr double kAmbiguous = 12.;   // difference of -2 log likelihood that decides
constexpr double kElsewhere = 30.;   // squared Mahalanobis distance of another place

/// Play that a prior's translation leaves to the image's content: principal axes [m per pixel] and
/// standard deviations [pixels].
struct Play {
    Eigen::Matrix3d axes;
    Eigen::Vector3d sigmas;
};

Play playOf(const Matrix6& covariance, const Camera& camera, double depth) {
    // A step along the optical axis moves the content at the image's side by that share of it.
    const Eigen::Vector3d pixelsPerMetre =
        Eigen::Vector3d(camera.fx(), camera.fy(), 0.5 * camera.width) / depth;
    const auto toPixels = pixelsPerMetre.asDiagonal();
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(
        toPixels * covariance.topLeftCorner<3, 3>() * toPixels);
    return {pixelsPerMetre.cwiseInverse().asDiagonal() * solver.eigenvectors(),
            solver.eigenvalues().cwiseMax(0.).cwiseSqrt()};
}

/// Points of a grid within an ellipsoid, its middle included [pixels].
std::vector<Eigen::Vector3d> placesWithin(const Eigen::Vector3d& sigmas) {
    const Eigen::Vector3d radii = kReach * sigmas;
    const double volume = (2. * radii / kSpacing).cwiseMax(1.).prod();
    const double spacing = kSpacing * std::cbrt(std::max(1., volume / kMostPlaces));
    const Eigen::Vector3i reach = (radii / spacing).array().floor().cast<int>();
    std::vector<Eigen::Vector3d> places;
    for (int i = -reach[0]; i <= reach[0]; ++i) {
        for (int j = -reach[1]; j <= reach[1]; ++j) {
            for (int k = -reach[2]; k <= reach[2]; ++k) {
                const Eigen::Vector3d place = spacing * Eigen::Vector3d(i, j, k);
                const Eigen::Vector3d share = place.cwiseQuotient(radii.cwiseMax(spacing));
                if (share.squaredNorm() <= 1.) places.push_back(place);
            }
        }
    }
    return places;
}

/// Harmonic mean; 1 where there is no surface.
double meanDepth(const View& view) {
    double sum = 0.;
    double count = 0.;
    for (unsigned i = 0; i < view.depth.getSize(); ++i) {
        if (view.depth.bitmap[i] <= 0.F) continue;
        sum += 1. / view.depth.bitmap[i];
        ++count;
    }
    return count > 0. ? count / sum : 1.;
}

/// -2 log likelihood of an image where there is a surface, in its likeliest exposure.
/// @param weight that makes mean square differences -2 log likelihoods
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
    // A little more on the diagonal: gain and offset of a uniform image cannot be told apart.
    AtA.diagonal() += prior->information() + Eigen::Vector2d::Constant(1e-9 * weight);
    return weight * sum / count - Atr.dot(AtA.inverse() * Atr);
}

double variance(const ImageF& image) {
    double sum = 0.;
    double squares = 0.;
    for (unsigned i = 0; i < image.getSize(); ++i) {
        const double value = image.bitmap[i];
        sum += value;
        squares += value * value;
    }
    const double n = image.getSize();
    return squares / n - sum * sum / (n * n);
}

/// What an image tells of what the prior leaves open: the largest eigenvalue of the prior's
/// covariance times Lambda. Below one, nothing that could be wrong.
double share(const Alignment& a, const UncertainPose& prior) {
    return (prior.covariance * a.information).eigenvalues().real().maxCoeff();
}

Camera quartered(const Camera& camera) { return halved(halved(camera)); }

Alignment undecided(Alignment a, const UncertainPose& prior, Verdict verdict) {
    a.T_c_w = prior.mean;
    a.covariance = prior.covariance;
    a.verdict = verdict;
    if (verdict == Verdict::degenerate) a.openDirections = {"all axes"};
    return a;
}

}  // namespace

/// Where in the prior views of a quarter of the size are most like the image.
std::vector<Pose> WideAligner::likelyStarts(const ImageF& observed, const UncertainPose& prior,
                                            double depth) const {
    const ImageF small = halvedAsRendered(halvedAsRendered(observed));
    const Camera camera = quartered(aligner_.camera());
    const Play play = playOf(prior.covariance, aligner_.camera(), depth);
    const std::vector<Eigen::Vector3d> places = placesWithin(play.sigmas);
    std::vector<Pose> poses;
    std::vector<double> costs;
    View view;
    for (const Eigen::Vector3d& place : places) {
        Vector6 offset = Vector6::Zero();
        offset.head<3>() = play.axes * place;
        poses.push_back(expSE3(offset) * prior.mean);
        model_.render(camera, poses.back(), view);
        costs.push_back(misfit(small, view, weight(), aligner_.options().exposure) +
                        place.cwiseQuotient(play.sigmas.cwiseMax(1e-3)).squaredNorm());
    }
    std::vector<std::size_t> order(places.size());
    std::iota(order.begin(), order.end(), 0U);
    std::sort(order.begin(), order.end(),
              [&](std::size_t a, std::size_t b) { return costs[a] < costs[b]; });
    std::vector<std::size_t> chosen;
    for (const std::size_t i : order) {
        const auto isNear = [&](std::size_t j) {
            return (places[i] - places[j]).norm() < 2. * kSpacing;
        };
        if (std::none_of(chosen.begin(), chosen.end(), isNear)) chosen.push_back(i);
        if (chosen.size() == kStarts) break;
    }
    std::vector<Pose> starts;
    starts.reserve(chosen.size());
    for (const std::size_t i : chosen) starts.push_back(poses[i]);
    return starts;
}

/// That makes mean square residuals -2 log likelihoods.
double WideAligner::weight() const {
    const PhotometricOptions& p = aligner_.options().photometric;
    const Camera& camera = aligner_.camera();
    return p.scale * camera.width * camera.height / (p.sigma * p.sigma);
}

/// -2 log likelihood of image and priors.
double WideAligner::costOf(const Alignment& a, const UncertainPose& prior) const {
    const auto& exposure = aligner_.options().exposure;
    return weight() * a.residual.rms * a.residual.rms +
           (exposure ? exposure->squaredDistance(a.exposure) : 0.) +
           squaredDistance(logSE3(a.T_c_w * prior.mean.inverse()), prior.covariance);
}

/// Whether image and prediction are the same down to the noise, by what there is to see: where a
/// strip of texture comes into view beside white, the wrong strip differs in few pixels.
bool WideAligner::fits(const Alignment& a) const {
    const double sigma = aligner_.options().photometric.sigma;
    const double noise = kNoiseSlack * sigma * sigma;
    const double square = a.residual.rms * a.residual.rms;
    return square <= noise || a.residual.unexplained * (1. - noise / square) < kMisfit;
}

/// An alignment that explains the image almost as well, from elsewhere.
const Alignment* WideAligner::rivalOf(const Alignment& best, const std::vector<Alignment>& found,
                                      const UncertainPose& prior) const {
    const double pixel = best.meanDepth / aligner_.camera().fx();  // on the surfaces in view [m]
    const double least = costOf(best, prior);
    for (const Alignment& a : found) {
        const Vector6 apart = logSE3(a.T_c_w * best.T_c_w.inverse());
        const bool isElsewhere = apart.head<3>().norm() > kSpacing * pixel &&
                                 squaredDistance(apart, best.covariance) > kElsewhere;
        if (isElsewhere && costOf(a, prior) < least + kAmbiguous) return &a;
    }
    return nullptr;
}

Alignment WideAligner::align(const ImageF& observed, const UncertainPose& prior) {
    const Alignment first = aligner_.align(observed, prior);
    if (share(first, prior) < 1. && fits(first)) return first;
    View expected;
    model_.render(quartered(aligner_.camera()), prior.mean, expected);
    const double depth = meanDepth(expected);
    if (playOf(prior.covariance, aligner_.camera(), depth).sigmas.maxCoeff() < kPlay) return first;

    std::vector<Alignment> found{first};
    for (const Pose& T_start_w : likelyStarts(observed, prior, depth)) {
        found.push_back(aligner_.align(observed, prior, T_start_w));
    }
    std::erase_if(found, [](const Alignment& a) { return isLost(a.verdict); });
    if (found.empty()) return first;
    const Alignment& best =
        *std::min_element(found.begin(), found.end(), [&](const Alignment& a, const Alignment& b) {
            return costOf(a, prior) < costOf(b, prior);
        });
    if (!fits(best)) return undecided(best, prior, Verdict::lostResidual);
    // Where the view expected shows something and the image nothing, no place is found: all places
    // that would show nothing are as likely, and the information of the view expected is not there.
    const double explained = variance(observed) - best.residual.rms * best.residual.rms;
    if (weight() * explained < kAmbiguous || rivalOf(best, found, prior)) {
        return undecided(best, prior, Verdict::degenerate);
    }
    return best;
}

}  // namespace photonav
