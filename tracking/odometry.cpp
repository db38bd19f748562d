// SPDX-License-Identifier: BSD-3-Clause
#include "odometry.hpp"

#include <algorithm>

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
        frame.lost = !beginWith(view);
        frame.isKeyframe = !frame.lost;
        if (!frame.lost) frame.alignment.verdict = Verdict::converged;
        frame.T_c_w = belief_;
        return frame;
    }
    sinceTracked_ = compound(motion, {Pose::Identity(), sinceTracked_}).covariance;
    frame.alignment = search(view, {motion.mean * belief_.mean, sinceTracked_});
    frame.lost = knowsNothing(frame.alignment);
    frame.isKeyframe = frame.lost ? miss(view, motion) : take(view, frame.alignment, elapsed);
    frame.T_c_w = belief_;
    return frame;
}

/// The belief after an image that could be aligned; whether the image becomes a keyframe.
bool Odometry::take(const View& view, const Alignment& alignment, double elapsed) {
    const Keyframe& keyframe = keyframes_.back();
    const Pose T_c_w = orthonormal(alignment.T_c_w);
    motion_.observe(T_c_w * belief_.mean.inverse(), elapsed);
    belief_ =
        compound({T_c_w * keyframe.T_k_w.mean.inverse(), alignment.covariance}, keyframe.T_k_w);
    belief_.mean = T_c_w;
    sinceTracked_.setZero();
    imagesLost_ = 0;
    if (needsKeyframe(alignment)) {
        addKeyframe(view, belief_);
        lastTracked_.reset();
        return true;
    }
    lastTracked_ = view;
    lastTrackedPose_ = belief_;
    return false;
}

/// The belief after a lost image; whether the flight is taken up from it.
bool Odometry::miss(const View& view, const UncertainPose& motion) {
    belief_.covariance = compound(motion, belief_).covariance;
    motion_.forget();
    lastTracked_.reset();
    if (++imagesLost_ < options_.patience || !beginWith(view)) return false;
    sinceTracked_.setZero();
    imagesLost_ = 0;
    return true;
}

/// An image that cannot even be aligned to itself is no keyframe.
bool Odometry::beginWith(const View& view) {
    addKeyframe(view, belief_);
    if (!knowsNothing(keyframes_.back().model.align(view.intensity, belief_.mean))) return true;
    keyframes_.pop_back();
    return false;
}

void Odometry::addKeyframe(const View& view, const UncertainPose& T_k_w) {
    keyframes_.push_back({KeyframeModel(view, camera_, T_k_w.mean, options_.keyframe), T_k_w});
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
        addKeyframe(*lastTracked_, lastTrackedPose_);
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
