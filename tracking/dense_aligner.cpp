// SPDX-License-Identifier: BSD-3-Clause
#include "dense_aligner.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "image_pyramid.hpp"
#include "se3.hpp"

namespace photonav {

namespace {

constexpr unsigned kLeastSide = 12;  ///< pixels: smaller images are not worth a level
constexpr double kLeastDamping = 1e-4;
constexpr double kMostDamping = 1e4;

struct Level {
    Camera camera;
    ViewComparison compare;
    double scale = 1.;  ///< 1, 2, 4, ... original pixels
};

/// A pose on trial, and what the image says there.
struct Iterate {
    Pose T_c_w;
    Exposure exposure;
    NormalEquations equations;
    Vector6 fromPrior = Vector6::Zero();  ///< log(T_c_w T_prior^-1)
    double priorTerm = 0.;                ///< squared distance from the prior
};

}  // namespace

struct DenseAligner::Impl {
    const ViewSource* model;
    Camera camera;
    AlignmentOptions options;
    std::vector<Level> levels;
    std::vector<ImageF> observed;  ///< per level
    View predicted;

    Impl(const ViewSource& source, const Camera& full, const AlignmentOptions& o)
        : model(&source), camera(full), options(o) {
        Camera c = full;
        for (int l = 0; l < std::max(1, o.levels); ++l) {
            levels.push_back({c, ViewComparison(c, o.photometric), std::ldexp(1., l)});
            c = halved(c);
            if (std::min(c.width, c.height) < kLeastSide) break;
        }
        observed.resize(levels.size());
    }

    Alignment align(const ImageF& image, const Pose& T_start, const UncertainPose* prior);
    bool descend(std::size_t l, const UncertainPose* prior, Iterate& at, int& iterations);
    Vector6 step(const Level& level, const UncertainPose* prior, const Iterate& at,
                 const PoseEquations& equations, double damping) const;
    Iterate evaluate(std::size_t l, const UncertainPose* prior, const Pose& T_c_w,
                     const Exposure& exposure, const Loss& loss);
    double cost(const Iterate& at, double pixels) const;
    bool isSmall(const Level& level, const Vector6& xi, const Iterate& at,
                 const Matrix6& information) const;
};

Iterate DenseAligner::Impl::evaluate(std::size_t l, const UncertainPose* prior, const Pose& T_c_w,
                                     const Exposure& exposure, const Loss& loss) {
    Iterate at{T_c_w, exposure, {}};
    model->render(levels[l].camera, T_c_w, predicted);
    at.equations = levels[l].compare(predicted, observed[l], exposure, loss);
    if (prior) {
        at.fromPrior = logSE3(T_c_w * prior->mean.inverse());
        at.priorTerm = squaredDistance(at.fromPrior, prior->covariance);
    }
    return at;
}

/// -2 log likelihood, as if `pixels` had been seen: iterates see different numbers of them.
double DenseAligner::Impl::cost(const Iterate& at, double pixels) const {
    if (at.equations.count < 1.) return std::numeric_limits<double>::infinity();
    const PhotometricOptions& p = options.photometric;
    return p.scale / (p.sigma * p.sigma) * at.equations.loss * pixels / at.equations.count +
           at.priorTerm;
}

Vector6 DenseAligner::Impl::step(const Level& level, const UncertainPose* prior, const Iterate& at,
                                 const PoseEquations& equations, double damping) const {
    const double inverseDepth = at.equations.meanInverseDepth;
    const Spectrum s = spectrum(equations.information, inverseDepth > 0. ? 1. / inverseDepth : 1.);
    if (prior) {
        const Matrix6 J = leftJacobian(at.fromPrior);
        return mapStep(s, equations, at.fromPrior, J * prior->covariance * J.transpose(), damping);
    }
    // A level of a quarter of the pixels has about a quarter of the information.
    const double sigma = options.trust.openSigma * level.scale;
    return imageStep(s, equations.right, 1. / (sigma * sigma), damping);
}

bool DenseAligner::Impl::isSmall(const Level& level, const Vector6& xi, const Iterate& at,
                                 const Matrix6& information) const {
    if (level.scale == 1.) {
        return xi.dot(information * xi) < 6. * options.fineStep * options.fineStep;
    }
    const double radians =
        xi.head<3>().norm() * at.equations.meanInverseDepth + xi.tail<3>().norm();
    return level.camera.fx() * radians < options.coarseStep;
}

/// Levenberg-Marquardt at one level; false when it found no minimum.
bool DenseAligner::Impl::descend(std::size_t l, const UncertainPose* prior, Iterate& at,
                                 int& iterations) {
    Level& level = levels[l];
    Loss loss{options.robust, options.photometric.sigma};
    at = evaluate(l, prior, at.T_c_w, at.exposure, loss);
    const int last = ++iterations + options.maxIterations - 1;
    double damping = 0.;
    while (iterations < last && at.equations.count > 0.) {
        if (loss.kind != RobustWeight::none) {  // the scale of what is seen here, not below noise
            loss.sigma = std::max(options.photometric.sigma, level.compare.robustSigma());
            at.equations = level.compare(predicted, observed[l], at.exposure, loss);
        }
        const PoseEquations equations =
            poseEquations(at.equations, options.photometric, options.exposure);
        Iterate next;
        for (;;) {
            const Vector6 xi = step(level, prior, at, equations, damping);
            Exposure exposure = at.exposure;
            const Eigen::Vector2d change = equations.exposureRight - equations.exposureOfPose * xi;
            exposure.gain += change[0];
            exposure.offset += change[1];
            next = evaluate(l, prior, expSE3(xi) * at.T_c_w, exposure, loss);
            ++iterations;
            const bool small = isSmall(level, xi, at, equations.information);
            const bool better = cost(next, at.equations.count) <= cost(at, at.equations.count);
            if (better) {
                at = next;
                damping = damping > kLeastDamping ? 0.1 * damping : 0.;
            }
            if (small) return true;
            if (better) break;
            damping = std::max(10. * kLeastDamping, 10. * damping);
            if (damping > kMostDamping || iterations >= last) return false;
        }
    }
    return false;
}

Alignment DenseAligner::Impl::align(const ImageF& image, const Pose& T_start,
                                    const UncertainPose* prior) {
    if (image.getWidth() != camera.width || image.getHeight() != camera.height) {
        throw std::invalid_argument("alignment: image and camera differ in size");
    }
    observed[0] = image;
    for (std::size_t l = 1; l < levels.size(); ++l) observed[l] = halvedAsRendered(observed[l - 1]);
    Alignment result;
    Iterate at;
    at.T_c_w = T_start;
    bool converged = false;
    for (std::size_t l = levels.size(); l-- > 0;) {
        converged = descend(l, prior, at, result.iterations);
    }
    result.T_c_w = at.T_c_w;
    result.exposure = at.exposure;
    if (converged) result.verdict = Verdict::converged;
    if (prior && at.priorTerm > options.trust.maxSurprise) {
        result.verdict = Verdict::lostImplausible;
    }
    std::optional<Matrix6> transported;
    if (prior) {
        const Matrix6 J = leftJacobian(at.fromPrior);
        transported = J * prior->covariance * J.transpose();
    }
    conclude(result, at.equations, static_cast<std::size_t>(image.getSize()), options.photometric,
             options.exposure, transported, options.trust);
    result.residual.robustSigma = levels[0].compare.robustSigma();
    return result;
}

DenseAligner::DenseAligner(const ViewSource& model, const Camera& camera,
                           const AlignmentOptions& options)
    : impl_(std::make_unique<Impl>(model, camera, options)) {}
DenseAligner::~DenseAligner() = default;
DenseAligner::DenseAligner(DenseAligner&&) noexcept = default;
DenseAligner& DenseAligner::operator=(DenseAligner&&) noexcept = default;

const AlignmentOptions& DenseAligner::options() const { return impl_->options; }
const Camera& DenseAligner::camera() const { return impl_->camera; }

Alignment DenseAligner::align(const ImageF& observed, const Pose& T_start) {
    return impl_->align(observed, T_start, nullptr);
}

Alignment DenseAligner::align(const ImageF& observed, const UncertainPose& prior) {
    return impl_->align(observed, prior.mean, &prior);
}

}  // namespace photonav
