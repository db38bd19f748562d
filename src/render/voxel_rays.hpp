// SPDX-License-Identifier: BSD-3-Clause
// Packets of rays on their way through the cells of a grid.
#pragma once

#include <array>

#include "geometry/camera.hpp"
#include "photometry/simd.hpp"
#include "render/voxel_grid.hpp"

namespace photonav {

/// A vector in the grid, one lane per ray.
template <class T>
struct Vector3 {
    T x, y, z;
};

/// Rays of one camera pose in cells, counted from the cell of the eye: precision does not depend on
/// where in the map the eye is.
struct RayFrame {
    Eigen::Matrix3f R;       ///< camera to world, metres to cells
    Eigen::Array3i eye;      ///< cell of the grid (may lie outside it)
    Eigen::Vector3f offset;  ///< of the eye in its cell, in [0, 1)
    bool inReach;            ///< the eye is close enough for single precision

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

/// State of a packet of rays: at z-depth t, before testing `cell`, which they entered across
/// `axis`.
struct Rays {
    static constexpr int kNoAxis = 3;    ///< the eye is in the cell
    static constexpr int kNoPlane = -1;  ///< the ray ended at a face of the cell

    Vector3<simd::Float> direction, inverse;
    Vector3<simd::Int> cell;
    simd::Float t, tExit;
    simd::Int axis;
    simd::Int active;
    simd::Int face;  ///< that the surface met in a cell points to, or kNoPlane
};

/// The cell of rays at time t along one axis: exactly the one behind the planes that they have
/// crossed. @param counts lanes for which a plane that they cross at t itself is crossed
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
