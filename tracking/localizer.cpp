// SPDX-License-Identifier: BSD-3-Clause
#include "localizer.hpp"

namespace photonav {

Localizer::Localizer(const ViewSource& map, const Camera& camera, const UncertainPose& start,
                     const LocalizerOptions& options)
    : options_(options),
      aligner_(map, camera, options.alignment),
      motion_(options.motion),
      filter_(start) {}

TrackedFrame Localizer::track(const ImageF& observed, double timestamp) {
    const double elapsed = lastTime_ ? timestamp - *lastTime_ : 0.;
    lastTime_ = timestamp;
    const UncertainPose before = filter_.belief();
    filter_.propagate(motion_.predict(elapsed));
    const UncertainPose predicted = filter_.belief();
    TrackedFrame frame;
    frame.alignment = filter_.update(aligner_, observed);
    if (knowsNothing(frame.alignment)) {
        filter_ = PoseFilter({before.mean, predicted.covariance});
        const Alignment again = filter_.update(aligner_, observed);
        if (!knowsNothing(again)) frame.alignment = again;
    }
    frame.lost = knowsNothing(frame.alignment) || (isLost_ && !isSure(frame.alignment));
    isLost_ = frame.lost;
    if (frame.lost) {
        motion_.forget();
        filter_ = PoseFilter(bounded({before.mean, predicted.covariance}));
    } else {
        motion_.observe(frame.alignment.T_c_w * before.mean.inverse(), elapsed);
    }
    frame.T_c_w = filter_.belief();
    return frame;
}

bool Localizer::isSure(const Alignment& alignment) const {
    const AlignmentOptions& o = options_.alignment;
    return alignment.residual.rms <= o.trust.residualSigmas * o.photometric.sigma ||
           alignment.residual.unexplained <= options_.sureness * o.trust.maxUnexplained;
}

UncertainPose Localizer::bounded(UncertainPose belief) const {
    Vector6 most;
    most << Eigen::Vector3d::Constant(options_.mostTranslation),
        Eigen::Vector3d::Constant(options_.mostRotation);
    const Vector6 sigma = belief.covariance.diagonal().cwiseMax(1e-30).cwiseSqrt();
    const Vector6 factor = most.cwiseQuotient(sigma).cwiseMin(1.);
    belief.covariance = factor.asDiagonal() * belief.covariance * factor.asDiagonal();
    return belief;
}

}  // namespace photonav
