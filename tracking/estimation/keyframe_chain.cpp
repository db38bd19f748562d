// SPDX-License-Identifier: BSD-3-Clause
#include "estimation/keyframe_chain.hpp"

#include <algorithm>
#include <utility>

namespace photonav {
namespace {

/// Each pose is the product of ones before it: without this, the rounding error by which a
/// rotation's columns are not orthogonal is multiplied by every keyframe.
Pose orthonormal(const Pose& T) {
    Pose result = T;
    result.linear() = Eigen::Quaterniond(T.linear()).normalized().toRotationMatrix();
    return result;
}

bool isUsable(const Alignment& alignment) {
    return !isLost(alignment.verdict) && !isUninformative(alignment);
}

}  // namespace

bool KeyframeChain::begin(const View& view, const UncertainPose& T_k_w, double time) {
    Keyframe keyframe = keyframeOf(view, T_k_w, time);
    if (!isUsable(keyframe.model.align(view.intensity, T_k_w.mean))) return false;
    remember(std::move(keyframe));
    return true;
}

bool KeyframeChain::keepLastTracked() {
    if (!lastTracked_) return false;
    remember(keyframeOf(lastTracked_->view, lastTracked_->T_c_w, lastTracked_->time));
    lastTracked_.reset();
    return true;
}

std::optional<Alignment> KeyframeChain::relocalize(const ImageF& image, double maxUnexplained) {
    for (std::size_t k = keyframes_.size(); k-- > 0;) {
        const Alignment found = keyframes_[k].model.align(image, keyframes_[k].T_k_w.mean);
        if (!isUsable(found) || found.residual.unexplained > maxUnexplained) continue;
        const auto at = keyframes_.begin() + std::ptrdiff_t(k);
        std::rotate(at, at + 1, keyframes_.end());
        return found;
    }
    return {};
}

UncertainPose KeyframeChain::beliefOf(const Alignment& alignment) const {
    const UncertainPose& T_k_w = keyframes_.back().T_k_w;
    const Pose T_c_w = orthonormal(alignment.T_c_w);
    UncertainPose belief = compound({T_c_w * T_k_w.mean.inverse(), alignment.covariance}, T_k_w);
    belief.mean = T_c_w;
    return belief;
}

bool KeyframeChain::add(const View& view, const UncertainPose& T_c_w, double time, double overlap,
                        double meanDepth) {
    if (!isFar(T_c_w.mean, overlap, meanDepth)) {
        lastTracked_ = {view, T_c_w, time};
        return false;
    }
    remember(keyframeOf(view, T_c_w, time));
    lastTracked_.reset();
    return true;
}

KeyframeChain::Keyframe KeyframeChain::keyframeOf(const View& view, const UncertainPose& T_k_w,
                                                  double time) const {
    return {KeyframeModel(view, camera_, T_k_w.mean, options_.keyframe), T_k_w, time};
}

void KeyframeChain::remember(Keyframe keyframe) {
    keyframes_.push_back(std::move(keyframe));
    if (keyframes_.size() > options_.keyframes) keyframes_.pop_front();
}

bool KeyframeChain::isFar(const Pose& T_c_w, double overlap, double meanDepth) const {
    const Pose motion = T_c_w * keyframes_.back().T_k_w.mean.inverse();
    return overlap < options_.minOverlap ||
           motion.translation().norm() > options_.maxShift * meanDepth ||
           Eigen::AngleAxisd(motion.linear()).angle() > options_.maxTurn;
}

}  // namespace photonav
