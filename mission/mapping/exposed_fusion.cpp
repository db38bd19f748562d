// SPDX-License-Identifier: BSD-3-Clause
#include "mapping/exposed_fusion.hpp"

#include <algorithm>

#include "alignment/fitted_gain.hpp"
#include "alignment/image_pyramid.hpp"

namespace photonav {
namespace {

constexpr unsigned kLargestWidth = 200;  // of compared images [pixels]: gains need no more

Camera smallCamera(Camera camera) {
    while (camera.width > kLargestWidth) camera = halved(camera);
    return camera;
}

void removeGain(ImageF& image, double gain) {
    for (unsigned k = 0; k < image.getSize(); ++k) {
        image.bitmap[k] = std::min(1.F, static_cast<float>(image.bitmap[k] / gain));
    }
}

}  // namespace

ExposedFusion::ExposedFusion(TexturedOcTree& map, const Camera& camera, bool estimate)
    : map_(map), camera_(camera), small_(smallCamera(camera)), estimate_(estimate) {}

void ExposedFusion::add(View observed, const Pose& T_c_w, const FusionOptions& options) {
    if (views_) {
        estimateGain(observed.intensity, T_c_w);
        removeGain(observed.intensity, gain_);
    }
    const MapChange change = fuse(map_, observed, camera_, T_c_w, options);
    if (!estimate_) return;
    if (views_) {
        views_->update(map_, change);
    } else {
        views_ = std::make_unique<VoxelSnapshots>(map_, UnknownPolicy::free);
    }
}

void ExposedFusion::estimateGain(const ImageF& observed, const Pose& T_c_w) {
    ImageF small = observed;
    while (small.getWidth() > small_.width) small = halvedAsRendered(small);
    views_->current()->render(small_, T_c_w, view_);
    gain_ = fittedGain(small, view_, gain_);
}

}  // namespace photonav
