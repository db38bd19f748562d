// SPDX-License-Identifier: BSD-3-Clause
#include "alignment/coarse_to_fine.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "alignment/certain_information.hpp"
#include "alignment/conclusion.hpp"
#include "alignment/light_field.hpp"
#include "alignment/measured_slope.hpp"
#include "alignment/search_grid.hpp"
#include "geometry/constants.hpp"
#include "geometry/se3.hpp"

namespace photonav {

namespace {

constexpr double kMinDamping = 1e-3;
constexpr double kMaxDamping = 1e4;
constexpr int kMeasurements = 3;  // of the slope, at most
constexpr double kCertain = 0.6;  // share of the information
/// Response of the image to the model's gradients from which on the model's noise does not matter.
constexpr double kHardlyNoise = 0.8;
/// Relative noise of the cost. The used pixels change from pose to pose, and with them the cost, by
/// more than small steps do. (Steps by J M do not quite follow the gradient of the cost, either.)
constexpr double kCostNoise = 1e-3;
/// At full size, eliminating the light field takes half as long as comparing a view. So the search
/// does it only if the step of measured(), which knows of the field, is longer than this [standard
/// deviations, root mean square over the axes].
constexpr double kFarStep = 1.;
/// Displacement of the texture that a covariance allows [standard deviations].
constexpr double kTextureSigmas = 1.5;

/// A pose and the normal equations there.
struct Iterate {
    Pose T_c_w = Pose::Identity();
    Exposure exposure;
    NormalEquations equations;
    Vector6 fromPrior = Vector6::Zero();  ///< deviation() from its mean
    double priorTerm = 0.;                ///< squared distance from the prior
};

/// The equations of J M instead of J.
NormalEquations confined(NormalEquations e, const Matrix6& M) {
    e.AtA.topLeftCorner<6, 6>() = M.transpose() * e.AtA.topLeftCorner<6, 6>() * M;
    e.AtA.topRightCorner<6, 2>() = M.transpose() * e.AtA.topRightCorner<6, 2>();
    e.AtA.bottomLeftCorner<2, 6>() = e.AtA.bottomLeftCorner<2, 6>() * M;
    e.Atr.head<6>() = M.transpose() * e.Atr.head<6>();
    return e;
}

NormalEquations scaled(NormalEquations e, double weight) {
    e.AtA *= weight;
    e.Atr *= weight;
    return e;
}

class Search {
  public:
    Search(Comparison& comparison, const AlignmentOptions& options, const UncertainPose* prior)
        : comparison_(comparison), options_(options), prior_(prior) {}

    Alignment run(const Pose& T_start);

  private:
    bool descend();
    bool measureSlope();
    bool isTextureCertain();
    const SharedSlope& shared();
    MeasuredInformation measured();
    void searchWithLight(MeasuredInformation& image);
    bool improve(double& damping);
    Iterate evaluate(const Pose& T_c_w, const Exposure& exposure);
    void relateToPrior(Iterate& at) const;
    void adaptLoss(double below);
    double cost(const Iterate& at, double pixels) const;
    PoseEquations equations() const {
        return poseEquations(confined(at_.equations, slope_), options_.photometric,
                             options_.exposure, at_.exposure);
    }
    Vector6 step(const PoseEquations& equations, double damping) const;
    bool isSmall(const Vector6& xi, const Matrix6& information) const;
    std::optional<Matrix6> transportedPrior() const;
    double finerThanModel(const NormalEquations& e) const;
    std::size_t levelAsUncertainAs(const Alignment& a) const;
    void judgeTexture(Alignment& a);
    /// Factor that turns sums of squares into -2 log likelihoods.
    double weight() const {
        const PhotometricOptions& p = options_.photometric;
        return p.scale / (p.sigma * p.sigma);
    }
    double scale() const { return std::ldexp(1., static_cast<int>(level_)); }

    Comparison& comparison_;
    const AlignmentOptions& options_;
    const UncertainPose* prior_;
    std::size_t level_ = 0;
    Loss loss_;
    Matrix6 slope_ = Matrix6::Identity();  ///< the pose follows J slope_
    Iterate at_;
    int iterations_ = 0;
    bool isCompared_ = false;            ///< at_ is the last comparison
    std::optional<SharedSlope> shared_;  ///< of the last comparison, once it was asked for
    bool done_ = false;                  ///< with this level, as the last step was small
    bool isLightSearched_ = false;       ///< the light field is eliminated at full size, too
    double lastSigmas_ = 0.;             ///< length of the step of measured()
};

Iterate Search::evaluate(const Pose& T_c_w, const Exposure& exposure) {
    Iterate at{T_c_w, exposure, comparison_.compare(level_, T_c_w, exposure, loss_)};
    if (options_.modelErrors.light > 0. && (level_ > 0 || isLightSearched_)) {
        const LightField light(comparison_.blocks(level_, T_c_w, exposure, loss_),
                               comparison_.camera(level_), options_.modelErrors.light,
                               1. / weight());
        at.equations = light.eliminatedFrom(at.equations);
    }
    ++iterations_;
    isCompared_ = true;
    shared_.reset();
    relateToPrior(at);
    return at;
}

void Search::relateToPrior(Iterate& at) const {
    if (!prior_) return;
    at.fromPrior = deviation(at.T_c_w, prior_->mean);
    at.priorTerm = squaredDistance(at.fromPrior, transported(prior_->covariance, at.fromPrior));
}

/// -2 log likelihood of image and priors, scaled to `pixels` pixels, because iterates use different
/// numbers of pixels.
double Search::cost(const Iterate& at, double pixels) const {
    if (at.equations.count < 1.) return kInfinity;
    const double exposureTerm =
        options_.exposure ? options_.exposure->squaredDistance(at.exposure) : 0.;
    return weight() * at.equations.loss * pixels / at.equations.count + at.priorTerm + exposureTerm;
}

std::optional<Matrix6> Search::transportedPrior() const {
    if (!prior_) return {};
    return transported(prior_->covariance, at_.fromPrior);
}

Vector6 Search::step(const PoseEquations& equations, double damping) const {
    const double inverseDepth = at_.equations.meanInverseDepth;
    const Spectrum s = spectrum(equations.information, inverseDepth > 0. ? 1. / inverseDepth : 1.);
    if (const auto prior = transportedPrior()) {
        return posteriorStep(s, equations, at_.fromPrior, *prior, damping);
    }
    // A level of a quarter of the pixels has about a quarter of the information.
    const double sigma = options_.trust.openSigma * scale();
    return imageStep(s, equations.rhs, 1. / (sigma * sigma), damping);
}

bool Search::isSmall(const Vector6& xi, const Matrix6& information) const {
    if (level_ == 0) {
        const NormalEquations& e = at_.equations;
        const double sigma = options_.photometric.sigma;
        const double noise = std::max(1., e.sumSquares / (e.count * sigma * sigma));
        const double step = options_.fineStep;
        return xi.dot(information * xi) < 6. * step * step * noise;
    }
    const double radians =
        xi.head<3>().norm() * at_.equations.meanInverseDepth + xi.tail<3>().norm();
    return comparison_.camera(level_).fx() * radians < options_.coarseStep;
}

/// Updates the scale of the robust loss by the last residuals (not below the image noise), if it
/// has fallen below `below` times the present scale.
void Search::adaptLoss(double below) {
    if (options_.robust == RobustWeight::none) return;
    const double seen = std::max(options_.photometric.sigma, comparison_.robustSigma());
    if (seen >= below * loss_.sigma) return;
    loss_ = {options_.robust, seen};
    at_ = evaluate(at_.T_c_w, at_.exposure);
}

/// One step that lowers the cost, raising the damping until it does; false when there is none.
bool Search::improve(double& damping) {
    const PoseEquations equations = this->equations();
    for (;;) {
        const Vector6 xi = step(equations, damping);
        const Eigen::Vector2d change = equations.exposureRhs - equations.exposureOfPose * xi;
        const double most = options_.trust.maxGain;
        const Exposure exposure{std::clamp(at_.exposure.gain + change[0], 1. / most, most),
                                at_.exposure.offset + change[1]};
        const Iterate next = evaluate(expSE3(xi) * at_.T_c_w, exposure);
        const double pixels = at_.equations.count;
        const double before = cost(at_, pixels);
        const double after = cost(next, pixels);
        const bool better = after <= (1. + kCostNoise) * before;
        done_ = isSmall(xi, equations.information);
        isCompared_ = better;
        if (better) {
            at_ = next;
            // A step that gains less than the noise of the cost raises the damping: where
            // visibility changes from pixel to pixel, iterates would otherwise oscillate.
            const bool isGain = after < (1. - kCostNoise) * before;
            damping = isGain ? (damping > kMinDamping ? 0.1 * damping : 0.)
                             : std::max(kMinDamping, 10. * damping);
        }
        if (better || done_) return true;
        damping = std::max(kMinDamping, 10. * damping);
        if (damping > kMaxDamping) return false;
    }
}

/// One level; false when no minimum was found.
bool Search::descend() {
    adaptLoss(1.);
    const int last = iterations_ + options_.maxIterations;
    double damping = 0.;
    done_ = false;
    while (at_.equations.count > 0. && iterations_ < last) {
        if (!improve(damping)) return false;
        if (done_) return true;
        adaptLoss(0.7);
    }
    return false;
}

/// How much of the model's gradients the image shares in the last comparison.
const SharedSlope& Search::shared() {
    if (!shared_) shared_ = sharedSlope(comparison_.tiles(level_, at_.exposure));
    return *shared_;
}

/// Measures the slope of the image over the uncertainty of the pose: of the model, and how much of
/// it the image shares. False where it is known, or cannot be measured.
bool Search::measureSlope() {
    const auto compare = comparison_.predictionAsImage(level_, at_.T_c_w);
    if (!compare) return false;
    if (!isCompared_) at_ = evaluate(at_.T_c_w, at_.exposure);
    if (isTextureCertain()) return false;
    slope_ = measuredSlope(transportedPrior(), options_.trust, [&](const Pose& T_away_here) {
        ++iterations_;
        return scaled(compare(T_away_here * at_.T_c_w), weight());
    });
    if (options_.modelNoise == ModelNoise::inPose) slope_ *= shared().slope;
    return true;
}

/// Whether the image changes as J says in all directions. With an assumed noise this is not known:
/// residuals show where edges jump. Nor is it where the model's noise looks like texture.
bool Search::isTextureCertain() {
    if (!options_.measureCovariance || options_.modelNoise == ModelNoise::inPose) return false;
    const bool isNoisy = options_.modelNoise == ModelNoise::inCovariance;
    if (isNoisy && shared().least < kHardlyNoise) return false;
    return certainShare(comparison_.resampledTiles()) > kCertain;
}

/// The information of the image by its residuals; the pose becomes that at which image, so
/// weighted, and prior agree.
MeasuredInformation Search::measured() {
    if (!isCompared_) at_ = evaluate(at_.T_c_w, at_.exposure);
    const ComparedBlocks compared{comparison_.blocks(level_, at_.T_c_w, at_.exposure, loss_),
                                  comparison_.camera(level_), at_.exposure};
    MeasuredInformation image = respondingBy(
        slope_, measuredInformation(compared, options_.photometric, options_.exposure,
                                    options_.modelErrors, comparison_.sinceModel(at_.T_c_w)));
    image.equations.information *= options_.informationScale;
    image.equations.rhs *= options_.informationScale;
    image.repeating /= options_.informationScale;
    const Vector6 xi = step(image.equations, 0.);
    lastSigmas_ = std::sqrt(xi.dot(image.equations.information * xi) / 6.);
    at_.T_c_w = expSE3(xi) * at_.T_c_w;
    relateToPrior(at_);
    const bool isNoisy = options_.modelNoise == ModelNoise::inCovariance;
    return isNoisy ? respondingBy(shared().slope, image) : image;
}

/// Goes on at full size with the light field, and measures again. Without a minimum the pose of
/// before remains.
void Search::searchWithLight(MeasuredInformation& image) {
    const Iterate before = at_;
    isLightSearched_ = true;
    at_ = evaluate(at_.T_c_w, at_.exposure);
    if (descend()) {
        image = measured();
    } else {
        at_ = before;
        isCompared_ = false;
    }
}

/// It matters only where the residuals exceed the noise.
double Search::finerThanModel(const NormalEquations& e) const {
    const double noise = options_.trust.residualSigmas * options_.photometric.sigma;
    const bool isNoise = e.sumSquares <= e.count * noise * noise;
    return isNoise ? 0. : comparison_.finerThanModel(1. / e.meanInverseDepth);
}

/// The finest level on which the covariance moves the texture by little more than a pixel, along
/// its widest axis: a map with errors of its own moves the parts of the image apart along this
/// axis.
std::size_t Search::levelAsUncertainAs(const Alignment& a) const {
    const ImageMotion motion = imageMotionOf(a.covariance, comparison_.camera(0), a.meanDepth);
    double pixels = kTextureSigmas * motion.sigmas.maxCoeff();
    std::size_t level = 0;
    for (; pixels > 1. && level + 1 < comparison_.levels(); ++level) pixels *= 0.5;
    return level;
}

/// Whether the texture is where the alignment claims that it is. (At full size that of the last
/// iterate is taken: the step after it was small.)
void Search::judgeTexture(Alignment& a) {
    const std::size_t level = levelAsUncertainAs(a);
    if (level > 0) comparison_.compare(level, at_.T_c_w, at_.exposure, loss_);
    // Halving lowers the noise by more than two.
    const double sigma = std::ldexp(options_.photometric.sigma, -static_cast<int>(level));
    const bool isNoisy = options_.modelNoise != ModelNoise::none || options_.cellSize > 0.;
    a.residual.texture =
        sharedTexture(comparison_.tiles(level, at_.exposure), sigma / at_.exposure.gain, isNoisy);
    const bool claims = a.verdict == Verdict::converged;
    if (claims && isTextureElsewhere(a.residual, options_.trust)) a.verdict = Verdict::lostTexture;
}

Alignment Search::run(const Pose& T_start) {
    at_.T_c_w = T_start;
    bool converged = false;
    for (level_ = comparison_.levels(); level_-- > 0;) {
        loss_ = {RobustWeight::none, std::numeric_limits<double>::max()};
        at_ = evaluate(at_.T_c_w, at_.exposure);
        converged = descend();
        if (level_ == 0) break;
    }
    for (int i = 0; i < kMeasurements && converged && options_.measureSlope; ++i) {
        const Pose before = at_.T_c_w;
        if (!measureSlope()) break;
        converged = descend();
        if (isSmall(logSE3(at_.T_c_w * before.inverse()), equations().information)) break;
    }
    MeasuredInformation image{equations(), Matrix6::Zero()};
    if (options_.measureCovariance && converged && at_.equations.count > 0.) {
        image = measured();
        if (options_.modelErrors.light > 0. && lastSigmas_ > kFarStep) searchWithLight(image);
    }
    Alignment result;
    result.T_c_w = at_.T_c_w;
    result.exposure = at_.exposure;
    result.iterations = iterations_;
    result.verdict = converged ? Verdict::converged : Verdict::lostDivergence;
    if (prior_ && at_.priorTerm > options_.trust.maxPriorDistance) {
        result.verdict = Verdict::lostImplausible;
    }
    LastIterate last{confined(at_.equations, slope_), comparison_.pixels(), image};
    last.finer = finerThanModel(last.equations);
    last.prior = transportedPrior();
    conclude(result, last, options_);
    result.residual.robustSigma = comparison_.robustSigma();
    const bool isMeasured = options_.measureCovariance && comparison_.hasTiles();
    if (isMeasured && !isLost(result.verdict)) judgeTexture(result);
    return result;
}

}  // namespace

Alignment alignCoarseToFine(Comparison& comparison, const AlignmentOptions& options,
                            const Pose& T_start, const UncertainPose* prior) {
    return Search(comparison, options, prior).run(T_start);
}

}  // namespace photonav
