// SPDX-License-Identifier: BSD-3-Clause
// Traces packets of rays through a grid.
#pragma once

#include "photometry/view.hpp"
#include "render/voxel_grid.hpp"

namespace photonav {

/// Computes depth and grey value of every pixel of a view, without point spread. All pixels are 0
/// if the camera is more than 10^6 cells away.
/// @param view must have the camera's size
void tracePackets(const VoxelGrid& grid, const Camera& camera, const Pose& T_c_w, View& view);

}  // namespace photonav
