// SPDX-License-Identifier: BSD-3-Clause
#include "odometry.hpp"

#include <algorithm>
#include <utility>

namespace photonav {
namespace {

/// Each pose is the product of ones before it: without this, what rounding leaves of a rotation's
/// columns not being orthogonal is multiplied by every keyframe.
Pose orthonormal(const Pose& T) {
    Pose result = T;
    result.linear() = Eigen::Quaterniond(T.linear()).normalized().toRotationMatrix();
    return result;
}

}  // namespace

Odometry::Odometry(const Camera& camera, const UncertainPose& start, const OdometryOptions& options)
    : camera_(camera), options_(options), motion_(options.motion), belief_(start) {}

TrackedFrame Odometry::track(const View& view, double timestamp) {
    const double elapsed = lastTime_ ? timestamp - *lastTime_ : 0.;
    lastTime_ = timestamp;
    TrackedFrame frame;
    const UncertainPose motion = motion_.predict(elapsed);
    if (keyframes_.empty()) {
        belief_.covariance = compound(motion, belief_).covariance;
        frame.lost = !beginWith(view, timestamp);
        if (!frame.lost) {
            frame.alignment.verdict = Verdict::converged;
            frame.keyframe = timestamp;
        }
        frame.T_c_w = belief_;
        return frame;
    }
    sinceTracked_ = compound(motion, {Pose::Identity(), sinceTracked_}).covariance;
    frame.keyframe = keyframes_.back().timestamp;
    frame.alignment = search(view, {motion.mean * belief_.mean, sinceTracked_});
    frame.lost = knowsNothing(frame.alignment);
    if (frame.lost) {
        miss(view, timestamp, motion);
    } else {
        frame.keyframe = keyframes_.back().timestamp;  // search() may have changed it
        take(view, frame.alignment, timestamp, elapsed);
    }
    frame.T_c_w = belief_;
    return frame;
}

/// The belief after an image that could be aligned.
void Odometry::take(const View& view, const Alignment& alignment, double timestamp,
                    double elapsed) {
    const Keyframe& keyframe = keyframes_.back();
    const Pose T_c_w = orthonormal(alignment.T_c_w);
    motion_.observe(T_c_w * belief_.mean.inverse(), elapsed);
    belief_ =
        compound({T_c_w * keyframe.T_k_w.mean.inverse(), alignment.covariance}, keyframe.T_k_w);
    belief_.mean = T_c_w;
    sinceTracked_.setZero();
    imagesLost_ = 0;
    if (needsKeyframe(alignment)) {
        remember(keyframeOf(view, belief_, timestamp));
        lastTracked_.reset();
    } else {
        lastTracked_ = {view, belief_, timestamp};
    }
}

/// The belief after a lost image. After many, the flight is taken up from it.
void Odometry::miss(const View& view, double timestamp, const UncertainPose& motion) {
    belief_.covariance = compound(motion, belief_).covariance;
    motion_.forget();
    lastTracked_.reset();
    if (++imagesLost_ < options_.patience || !beginWith(view, timestamp)) return;
    sinceTracked_.setZero();
    imagesLost_ = 0;
}

/// An image that cannot even be aligned to itself is no keyframe.
bool Odometry::beginWith(const View& view, double timestamp) {
    Keyframe keyframe = keyframeOf(view, belief_, timestamp);
    if (knowsNothing(keyframe.model.align(view.intensity, belief_.mean))) return false;
    remember(std::move(keyframe));
    return true;
}

Odometry::Keyframe Odometry::keyframeOf(const View& view, const UncertainPose& T_k_w,
                                        double timestamp) const {
    return {KeyframeModel(view, camera_, T_k_w.mean, options_.keyframe), T_k_w, timestamp};
}

void Odometry::remember(Keyframe keyframe) {
    keyframes_.push_back(std::move(keyframe));
    if (keyframes_.size() > options_.keyframes) keyframes_.pop_front();
}

/// The keyframe that the image could be aligned to is the last one afterwards.
Alignment Odometry::search(const View& view, const UncertainPose& predicted) {
    const ImageF& image = view.intensity;
    const Alignment first = keyframes_.back().model.align(image, predicted);
    if (!knowsNothing(first)) return first;
    const UncertainPose still{belief_.mean, predicted.covariance};
    Alignment again = keyframes_.back().model.align(image, still);
    if (!knowsNothing(again)) return again;
    if (lastTracked_) {
        remember(keyframeOf(lastTracked_->view, lastTracked_->T_c_w, lastTracked_->timestamp));
        again = keyframes_.back().model.align(image, still);
        if (!knowsNothing(again)) return again;
    }
    const double most = options_.sureness * options_.keyframe.alignment.trust.maxUnexplained;
    for (std::size_t k = keyframes_.size(); k-- > 0;) {
        again = keyframes_[k].model.align(image, keyframes_[k].T_k_w.mean);
        if (knowsNothing(again) || again.residual.unexplained > most) continue;
        const auto found = keyframes_.begin() + std::ptrdiff_t(k);
        std::rotate(found, found + 1, keyframes_.end());
        return again;
    }
    return first;
}

bool Odometry::needsKeyframe(const Alignment& alignment) const {
    const Pose motion = alignment.T_c_w * keyframes_.back().T_k_w.mean.inverse();
    return alignment.overlap < options_.minOverlap ||
           motion.translation().norm() > options_.maxShift * alignment.meanDepth ||
           Eigen::AngleAxisd(motion.linear()).angle() > options_.maxTurn;
}

}  // namespace photonav
