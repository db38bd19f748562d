// SPDX-License-Identifier: BSD-3-Clause
// Intersections of rays with the surfaces inside cells.
#pragma once

#include <array>

#include "render/voxel_rays.hpp"

namespace photonav {

/// The positions of rays relative to a plane in the cell of each ray.
struct PlaneView {
    /// Distance in front of the plane, along the plane's axis [cells], and its derivative by t.
    simd::Float height, rate;
    simd::Int face;    ///< face that the plane's normal points to
    simd::Int exists;  ///< mask: the ray's cell has this plane

    /// The height when t has grown by `after`.
    simd::Float heightAt(const simd::Float& after) const { return height + rate * after; }
};

/// The intersections of rays with the surface in their cells.
struct Intersection {
    simd::Int met;      ///< mask: the ray ends in the cell, at the surface or at the cell's face
    simd::Float after;  ///< t of the intersection minus the present t
    simd::Int face;     ///< face that the plane's normal points to, or Rays::kNoPlane
};

/// Decodes planes (SurfacePlane) and computes the positions of rays relative to them.
/// @param at positions of the rays relative to the centres of their cells [cells]
[[gnu::always_inline]] inline PlaneView viewPlane(const simd::Int& plane,
                                                  const Vector3<simd::Float>& at,
                                                  const Vector3<simd::Float>& direction) {
    const simd::Int face = (plane >> 29 & 7) - 1;
    const simd::Float slopeP = simd::toFloat(plane << 23 >> 23) * SurfacePlane::kSlopeUnit;
    const simd::Float slopeQ = simd::toFloat(plane << 14 >> 23) * SurfacePlane::kSlopeUnit;
    const simd::Float offset = simd::toFloat(plane << 3 >> 21) * SurfacePlane::kOffsetUnit;
    const simd::Int onX = face <= 1, onZ = face >= 4;
    const auto above = [&](const Vector3<simd::Float>& v) {
        const simd::Float a = onX ? v.x : (onZ ? v.z : v.y);
        return a - slopeP * (onX ? v.y : v.x) - slopeQ * (onZ ? v.y : v.z);
    };
    const simd::Float height = above(at) - offset, rate = above(direction);
    const simd::Int outward = (face & 1) != 0;
    return {outward ? height : -height, outward ? rate : -rate, face, plane != 0};
}

/// Tolerance for planes on the border of their cell, such as a floor at a multiple of the cells'
/// edge: by rounding they can lie outside the cell by half a unit of the offset and of the slopes
/// [cells].
inline constexpr float kPlaneRounding =
    0.5F * SurfacePlane::kOffsetUnit + 0.5F * SurfacePlane::kSlopeUnit;

/// The intersections of rays with a single plane.
/// @param toExit t at which rays leave their cells, minus the present t
/// @param back largest distance by which an intersection may lie before the present t
[[gnu::always_inline]] inline Intersection intersectPlane(const PlaneView& plane,
                                                          const simd::Float& toExit,
                                                          const simd::Float& back) {
    const simd::Int facing = plane.rate < 0.F;
    const simd::Float after = plane.height / (facing ? -plane.rate : simd::splat(1.F));
    const simd::Int met = facing ? plane.heightAt(toExit) <= kPlaneRounding : plane.height <= 0.F;
    return {met, simd::max(after, -back), facing ? plane.face : simd::splat(Rays::kNoPlane)};
}

/// The intersections of rays with several planes that together bound the solid in a cell.
/// @param edges ShownSurfaces::edges
/// @param toExit,back see intersectPlane()
template <std::size_t N>
Intersection meetPlanes(const std::array<PlaneView, N>& planes, const simd::Int& edges,
                        const simd::Float& toExit, const simd::Float& back) {
    constexpr float kTolerance = 1e-4F;
    Intersection best{simd::splat(0), simd::splat(1e30F), simd::splat(Rays::kNoPlane)};
    simd::Int anyFacing = simd::splat(0), behindAny = simd::splat(0), behindAll = simd::splat(-1);
    for (std::size_t i = 0; i < N; ++i) {
        Intersection one = intersectPlane(planes[i], toExit, back);
        const simd::Int facing = planes[i].exists & (one.face >= 0);
        simd::Int met = facing & one.met & (one.after < best.after);
        for (std::size_t j = 0; j < N; ++j) {
            if (i == j) continue;
            const int pair = static_cast<int>(i + j) - 1;
            const simd::Float height = planes[j].heightAt(one.after);
            const simd::Int convex = (edges >> pair & 1) != 0,
                            concave = (edges >> (pair + 3) & 1) != 0;
            met &= ~(convex & (height > kTolerance)) & ~(concave & (height < -kTolerance));
        }
        best.met |= met;
        best.after = met ? one.after : best.after;
        best.face = met ? one.face : best.face;
        anyFacing |= facing;
        behindAny |= planes[i].exists & one.met;
        behindAll &= ~planes[i].exists | one.met;
    }
    const simd::Int isConcave = (edges >> 3) != 0;
    best.met |= ~anyFacing & (isConcave ? behindAny : behindAll);
    return best;
}

}  // namespace photonav
