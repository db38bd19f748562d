// SPDX-License-Identifier: BSD-3-Clause
// Where rays meet the surfaces inside cells.
#pragma once

#include <array>

#include "render/voxel_rays.hpp"

namespace photonav {

/// Rays before a plane, each in its cell: by how much they are in front of it, along the plane's
/// axis, and how fast that changes with t.
struct PlaneView {
    simd::Float height, rate;
    simd::Int face;
    simd::Int exists;

    simd::Float heightAt(const simd::Float& after) const { return height + rate * after; }
};

/// Where rays meet the surface in a cell, after the present t.
struct Meeting {
    simd::Int met;      ///< the surface, or from behind a cell with surfaces: the
                        ///< cell's face
    simd::Float after;  ///< t less the present one
    simd::Int face;
};

/// Decodes planes (SurfacePlane) and looks at them from where rays are in their cells.
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

/// A plane on the border of its cell, as a floor at a multiple of the cells' edge, lies beyond the
/// cell by as much as planes are rounded: half a unit of the offset and of the slopes [cells].
inline constexpr float kPlaneRounding =
    0.5F * SurfacePlane::kOffsetUnit + 0.5F * SurfacePlane::kSlopeUnit;

/// Where rays meet a single plane.
[[gnu::always_inline]] inline Meeting meetPlane(const PlaneView& plane, const simd::Float& toExit,
                                                const simd::Float& back) {
    const simd::Int facing = plane.rate < 0.F;
    const simd::Float after = plane.height / (facing ? -plane.rate : simd::splat(1.F));
    const simd::Int met = facing ? plane.heightAt(toExit) <= kPlaneRounding : plane.height <= 0.F;
    return {met, simd::max(after, -back), facing ? plane.face : simd::splat(Rays::kNoPlane)};
}

/// Where rays meet planes that bound a cell's solid together.
template <std::size_t N>
Meeting meetPlanes(const std::array<PlaneView, N>& planes, const simd::Int& edges,
                   const simd::Float& toExit, const simd::Float& back) {
    constexpr float kTolerance = 1e-4F;
    Meeting best{simd::splat(0), simd::splat(1e30F), simd::splat(Rays::kNoPlane)};
    simd::Int anyFacing = simd::splat(0), behindAny = simd::splat(0), behindAll = simd::splat(-1);
    for (std::size_t i = 0; i < N; ++i) {
        Meeting one = meetPlane(planes[i], toExit, back);
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
