// SPDX-License-Identifier: BSD-3-Clause
#include "depth/monocular_depth.hpp"

#include <utility>

namespace photonav {

MonocularDepth::MonocularDepth(const Camera& camera, const MonocularOptions& options)
    : camera_(camera), options_(options) {}

std::optional<DepthFilter> MonocularDepth::add(const ImageF& image, const Pose& T_c_w) {
    std::optional<DepthFilter> finished;
    if (filter_) {
        filter_->observe(image, T_c_w);
        ++images_;
        if (isUninformative()) {
            ++givenUp_;
            images_ = 0;
        } else if (hasMovedOn(T_c_w)) {
            finished = finish();
        } else {
            return {};
        }
    }
    filter_.emplace(image, camera_, T_c_w, options_.filter);
    return finished;
}

std::optional<DepthFilter> MonocularDepth::finish() {
    std::optional<DepthFilter> finished;
    if (std::exchange(images_, 0) > 0) finished = std::move(filter_);
    filter_.reset();
    return finished;
}

bool MonocularDepth::isUninformative() const {
    if (images_ < options_.minImages) return false;
    return filter_->shareNarrowed() < options_.minNarrowed ||
           (images_ >= 10 * options_.minImages && !filter_->medianDepth());
}

bool MonocularDepth::hasMovedOn(const Pose& T_c_w) const {
    const Pose motion = T_c_w * filter_->pose().inverse();
    if (Eigen::AngleAxisd(motion.linear()).angle() > options_.maxTurn) return true;
    const auto depth = filter_->medianDepth();
    return images_ >= options_.minImages && depth &&
           motion.translation().norm() > options_.maxShift * *depth;
}

}  // namespace photonav
