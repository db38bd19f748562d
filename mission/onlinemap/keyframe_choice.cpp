// SPDX-License-Identifier: BSD-3-Clause
#include "onlinemap/keyframe_choice.hpp"

#include <algorithm>
#include <cmath>

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
           shareNew(image, shown, tracked.T_c_w.mean) > config_.keyframeNew;
}

void KeyframeChoice::add(int number, const View& image, const Pose& T_c_w) {
    T_last_w_ = T_c_w;
    notInMap_[number] = {image.depth, T_c_w};
}

/// Of the surfaces within range, those that are neither in the map nor in a keyframe.
double KeyframeChoice::shareNew(const View& image, const View& shown, const Pose& T_c_w) const {
    constexpr unsigned kStride = 4;
    const Pose T_w_c = T_c_w.inverse();
    double surfaces = 0., missing = 0.;
    for (unsigned v = 0; v < image.depth.getHeight(); v += kStride) {
        for (unsigned u = 0; u < image.depth.getWidth(); u += kStride) {
            const float z = image.depth[v][u];
            if (!(z > 0.F) || z > config_.range) continue;
            ++surfaces;
            if (shown.depth[v][u] > 0.F) continue;
            const Eigen::Vector3d p_w = T_w_c * camera_.unproject(u, v, z);
            missing += std::none_of(notInMap_.begin(), notInMap_.end(), [&](const auto& keyframe) {
                return isSurfaceOf(keyframe.second, p_w);
            });
        }
    }
    return surfaces > 0. ? missing / surfaces : 0.;
}

/// Whether a keyframe shows a surface at a point, within two cells in depth.
bool KeyframeChoice::isSurfaceOf(const Keyframe& keyframe, const Eigen::Vector3d& p_w) const {
    const Eigen::Vector3d p_c = keyframe.T_c_w * p_w;
    if (!(p_c.z() > 0.)) return false;
    const Eigen::Array2d pixel = camera_.project(p_c).array().round();
    const ImageF& depth = keyframe.depth;
    if (!(pixel >= 0.).all() || pixel.x() >= depth.getWidth() || pixel.y() >= depth.getHeight()) {
        return false;
    }
    const float z = depth[static_cast<unsigned>(pixel.y())][static_cast<unsigned>(pixel.x())];
    return z > 0.F && z <= config_.range && std::abs(z - p_c.z()) < 2. * config_.cell();
}

}  // namespace photonav
