// SPDX-License-Identifier: BSD-3-Clause
// Packets of rays that are traced through the cells of a grid.
#pragma once

#include <array>

#include "geometry/camera.hpp"
#include "photometry/simd.hpp"
#include "render/voxel_grid.hpp"

namespace photonav {

/// A vector for each ray of a packet, in the axes of the grid; one lane per ray.
template <class T>
struct Vector3 {
    T x, y, z;
};

/// The frame of the rays of one camera pose: coordinates in cells relative to the cell of the eye
/// (camera centre), so that precision does not depend on the position of the eye in the map.
struct RayFrame {
    Eigen::Matrix3f R;       ///< rotates from camera to world and scales from metres to cells
    Eigen::Array3i eye;      ///< cell of the eye in the grid (may lie outside it)
    Eigen::Vector3f offset;  ///< position of the eye in its cell, in [0, 1)
    bool inReach;            ///< whether the eye is close enough for single precision

    RayFrame(const VoxelGrid& grid, const Pose& T_c_w) {
        const Eigen::Matrix3d toCells = T_c_w.linear().transpose() / grid.resolution;
        const Eigen::Array3d position = -toCells * T_c_w.translation();
        const Eigen::Array3d cell = position.floor();
        R = toCells.cast<float>();
        inReach = (position - grid.first.cast<double>()).abs().maxCoeff() < 1e6;
        eye = inReach ? (cell.cast<int>() - grid.first).eval() : Eigen::Array3i::Zero().eval();
        offset = (position - cell).cast<float>();
        offset = offset.cwiseMin(std::nextafter(1.F, 0.F));
    }
};

/// State of a packet of rays at depth t (z in the camera frame [m]), before `cell` is tested.
struct Rays {
    static constexpr int kNoAxis = 3;    ///< `axis` of the cell that contains the eye
    static constexpr int kNoPlane = -1;  ///< `face` of a ray that ended at a face of the cell

    Vector3<simd::Float> direction, inverse;
    Vector3<simd::Int> cell;
    simd::Float t, tExit;
    simd::Int axis;  ///< axis along which the ray entered `cell`, or kNoAxis
    simd::Int active;
    simd::Int face;  ///< face that the normal of the surface at the ray's end points to
};

/// The cells of rays at depth t, along one axis. Consistent with rounding: it is the cell behind
/// all cell borders (planes of constant coordinate) that the ray has crossed before t.
/// @param counts lanes for which a border that is crossed exactly at t counts as crossed
[[gnu::always_inline]] inline simd::Int cellAt(const simd::Float& t, const simd::Float& direction,
                                               const simd::Float& inverse, float offset,
                                               const simd::Int& counts) {
    // Planes that are not crossed here are far from rounding.
    const simd::Float plane = simd::rounded(offset + t * direction);
    const simd::Float tPlane = (plane - offset) * inverse;
    const simd::Int crossed = (tPlane < t) | ((tPlane == t) & counts);
    const simd::Int forward = direction > 0.F;
    return simd::wrappingSum(simd::toInt(plane), crossed ^ forward);
}

}  // namespace photonav
