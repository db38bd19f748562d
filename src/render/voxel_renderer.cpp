// SPDX-License-Identifier: BSD-3-Clause
#include "render/voxel_renderer.hpp"

#include <stdexcept>

#include "render/packet_tracer.hpp"
#include "render/voxel_grid_builder.hpp"

namespace photonav {

VoxelRenderer::VoxelRenderer(const TexturedOcTree& map, UnknownPolicy unknown) {
    VoxelGridBuilder(map, unknown, grid_);
}

void VoxelRenderer::render(const Camera& camera, const Pose& T_c_w, View& view) const {
    if (!T_c_w.matrix().allFinite()) {
        throw std::invalid_argument("VoxelRenderer: the pose is not finite");
    }
    view.intensity.resize(camera.height, camera.width);
    view.depth.resize(camera.height, camera.width);
    tracePackets(grid_, camera, T_c_w, view);
    if (camera.hasPointSpread) applyPointSpread(view);
}

}  // namespace photonav
