// SPDX-License-Identifier: BSD-3-Clause
// Traces rays through a grid, several at once.
#pragma once

#include "photometry/view.hpp"
#include "render/voxel_grid.hpp"

namespace photonav {

/// Depth and grey value of every pixel of a view, which has the camera's size; without point
/// spread. All 0 where the camera is more than 10^6 cells away.
void tracePackets(const VoxelGrid& grid, const Camera& camera, const Pose& T_c_w, View& view);

}  // namespace photonav
