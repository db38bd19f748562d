// SPDX-License-Identifier: BSD-3-Clause
#include "onlinemap/keyframe_choice.hpp"

namespace photonav {

bool KeyframeChoice::isUsable(const TrackedFrame& tracked, const View& image) const {
    if (isBlack(image.intensity)) return false;
    // Where the map shows too little to be aligned to, it has to grow; where it is doubted, it has
    // to be made again.
    return !tracked.rejected || tracked.isMapInconsistent ||
           tracked.alignment.verdict == Verdict::lostOverlap;
}

bool KeyframeChoice::isKeyframe(const TrackedFrame& tracked, const View& image,
                                const View& shown) const {
    if (!isUsable(tracked, image)) return false;
    if (!T_last_w_) return true;
    const Pose motion = tracked.T_c_w.mean * T_last_w_->inverse();
    return motion.translation().norm() > config_.keyframeDistance ||
           Eigen::AngleAxisd(motion.linear()).angle() > config_.keyframeAngle ||
           shareNew(image, shown) > config_.keyframeNew;
}

/// Of the surfaces within range, those that the map lacks.
double KeyframeChoice::shareNew(const View& image, const View& shown) const {
    constexpr unsigned kStride = 4;
    double surfaces = 0., missing = 0.;
    for (unsigned v = 0; v < image.depth.getHeight(); v += kStride) {
        for (unsigned u = 0; u < image.depth.getWidth(); u += kStride) {
            const float z = image.depth[v][u];
            if (!(z > 0.F) || z > config_.range) continue;
            ++surfaces;
            missing += shown.depth[v][u] > 0.F ? 0. : 1.;
        }
    }
    return surfaces > 0. ? missing / surfaces : 0.;
}

}  // namespace photonav
