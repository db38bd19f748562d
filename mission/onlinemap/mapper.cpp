// SPDX-License-Identifier: BSD-3-Clause
#include "onlinemap/mapper.hpp"

#include <algorithm>
#include <cmath>

#include "geometry/se3.hpp"
#include "onlinemap/known_map.hpp"

namespace photonav {
namespace {

// Of a known map, in the frame of the start [m^2, rad^2]: 2 cm, and 4, 4 and 10 mrad. So exact are
// maps of explorations of rooms of 8 m; their errors grow with the distance from the start.
const Vector6 kKnownVariances{{4e-4, 4e-4, 4e-4, 1.6e-5, 1.6e-5, 1e-4}};

/// Images come a quarter of a metre apart: few see the same surface.
MonocularOptions monocularFor(const PhotometricOptions& photometric) {
    MonocularOptions options;
    options.minImages = 4;
    // The matching of patches counts pixels as independent.
    options.filter.sigma = photometric.sigma / std::sqrt(std::min(1., photometric.scale));
    return options;
}

/// Depths that are fused; the others are 0.
ImageF fusedDepth(const ImageF& depth, double range) {
    const double least = FusionOptions{}.minRange;
    ImageF fused = depth;
    for (unsigned i = 0; i < fused.getSize(); ++i) {
        float& z = fused.bitmap[i];
        if (!(z >= least && z <= range)) z = 0.F;
    }
    return fused;
}

}  // namespace

Mapper::Mapper(const Config& config, const TexturedOcTree* known)
    : camera_(config.camera.camera()),
      errors_(std::make_shared<MapErrors>(config.explore.cell())),
      choice_(config.explore, camera_),
      range_(config.explore.range) {
    if (known != nullptr) addKnown(*known, config.start);
    if (config.explore.sensor != ExploreSensor::monocular) return;
    depth_.emplace(camera_, monocularFor(config.photometric));
}

/// All of it has one error.
void Mapper::addKnown(const TexturedOcTree& known, const Place& start) {
    const auto hasTexture = [&](const TexturedOcTreeNode& leaf) {
        return known.isNodeOccupied(leaf) && leaf.meanGrey().has_value();
    };
    const Pose T_w_b = levelPose(start.position, start.yaw.value_or(0.));
    errors_->addMap(T_w_b.inverse(), kKnownVariances.asDiagonal(), bricksWith(known, hasTexture));
}

std::optional<MapInput> Mapper::choose(const TrackedFrame& tracked, const View& image,
                                       const View& shown, bool isNeeded) {
    const bool isInconsistent = tracked.isMapInconsistent;
    std::optional<Keyframe> keyframe =
        depth_ ? addToFilter(tracked, image)
               : chooseImage(tracked, image, shown, isNeeded || isInconsistent);
    keyframes_ += keyframe ? 1 : 0;
    if (!keyframe && !isInconsistent && !(depth_ && isNeeded)) return {};
    return MapInput{image, shown, tracked.T_c_w, isInconsistent, std::move(keyframe)};
}

std::optional<MapInput::Keyframe> Mapper::chooseImage(const TrackedFrame& tracked,
                                                      const View& image, const View& shown,
                                                      bool isNeeded) {
    const bool isWanted =
        isNeeded ? choice_.isUsable(tracked, image) : choice_.isKeyframe(tracked, image, shown);
    if (!isWanted) return {};
    const int number = errors_->addPose(tracked.T_c_w);
    choice_.add(number, image, tracked.T_c_w.mean);
    return Keyframe{image, tracked.T_c_w.mean, number};
}

std::optional<MapInput::Keyframe> Mapper::addToFilter(const TrackedFrame& tracked,
                                                      const View& image) {
    if (!choice_.isUsable(tracked, image)) {
        depth_->finish();  // the pose may be wrong: what was found so far cannot be gone on with
        return {};
    }
    std::optional<Keyframe> keyframe;
    const std::optional<DepthFilter> finished = depth_->add(image.intensity, tracked.T_c_w.mean);
    if (finished) keyframe = Keyframe{finished->view(), finished->pose(), reference_};
    if (depth_->isAtReference()) reference_ = errors_->addPose(tracked.T_c_w);
    return keyframe;
}

void Mapper::setFused(const MapInput& fused) {
    if (fused.isMapInconsistent) {
        errors_->removeSurfaces(fused.shown.depth, camera_, fused.T_c_w.mean);
    }
    if (!fused.keyframe) return;
    const auto& [view, T_c_w, number] = *fused.keyframe;
    choice_.setFused(number);
    errors_->addSurfaces(number, fusedDepth(view.depth, range_), camera_);
}

}  // namespace photonav
