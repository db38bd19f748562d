// SPDX-License-Identifier: BSD-3-Clause
#include "exploration/mapper.hpp"

#include <algorithm>
#include <cmath>

namespace photonav {
namespace {

/// Images come a quarter of a metre apart: few see the same surface.
MonocularOptions monocularFor(const PhotometricOptions& photometric) {
    MonocularOptions options;
    options.minImages = 4;
    // The matching of patches counts pixels as independent.
    options.filter.sigma = photometric.sigma / std::sqrt(std::min(1., photometric.scale));
    return options;
}

}  // namespace

Mapper::Mapper(const Config& config, OnlineMap& map)
    : camera_(config.camera.camera()), map_(map), choice_(config.explore) {
    if (config.explore.sensor != ExploreSensor::monocular) return;
    depth_.emplace(camera_, monocularFor(config.photometric));
}

std::optional<MapChange> Mapper::add(const TrackedFrame& tracked, const View& image,
                                     const View& shown, bool isNeeded) {
    std::optional<MapChange> forgotten;
    if (tracked.isMapInconsistent) forgotten = map_.forget(shown, camera_, tracked.T_c_w.mean);
    std::optional<MapChange> change =
        depth_ ? addToFilter(tracked, image, shown, isNeeded)
               : addKeyframe(tracked, image, shown, isNeeded || tracked.isMapInconsistent);
    if (!forgotten) return change;
    if (change) forgotten->join(*change);
    return forgotten;
}

std::optional<MapChange> Mapper::addKeyframe(const TrackedFrame& tracked, const View& image,
                                             const View& shown, bool isNeeded) {
    const bool isWanted =
        isNeeded ? choice_.isUsable(tracked, image) : choice_.isKeyframe(tracked, image, shown);
    if (!isWanted) return {};
    ++keyframes_;
    choice_.fused(tracked.T_c_w.mean);
    map_.compare(shown, image.intensity, camera_);
    return map_.fuse(image, camera_, tracked.T_c_w.mean, map_.addPose(tracked.T_c_w));
}

std::optional<MapChange> Mapper::addToFilter(const TrackedFrame& tracked, const View& image,
                                             const View& shown, bool isNeeded) {
    std::optional<MapChange> change;
    if (isNeeded) change.emplace();
    if (!choice_.isUsable(tracked, image)) {
        depth_->finish();  // the pose may be wrong: what was found so far cannot be gone on with
        return change;
    }
    const std::optional<DepthFilter> finished = depth_->add(image.intensity, tracked.T_c_w.mean);
    if (finished) {
        ++keyframes_;
        map_.compare(shown, image.intensity, camera_);
        change = map_.fuse(finished->view(), camera_, finished->pose(), reference_);
    }
    if (depth_->isAtReference()) reference_ = map_.addPose(tracked.T_c_w);
    return change;
}

}  // namespace photonav
