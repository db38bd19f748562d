// SPDX-License-Identifier: BSD-3-Clause
#include "render/voxel_renderer.hpp"

#include <bit>
#include <cmath>
#include <cstring>
#include <stdexcept>

#include "photometry/simd.hpp"
#include "render/voxel_grid_builder.hpp"

namespace photonav {
namespace {

using simd::Float;
using simd::Int;

constexpr int kNoFace = 3;

// Planes of neighbouring cells do not meet exactly. A ray that enters a cell behind the plane that
// faces it went through such a gap: it meets the plane up to this far before the cell [cells].
constexpr float kGap = 0.5F;

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
    Vector3<Float> direction, inverse;
    Vector3<Int> cell;
    Float t, tExit;
    Int axis;
    Int active;
    Int face;  ///< that the surface met in a cell points to; kNoPlane: the ray ended at a face
};

constexpr int kNoPlane = -1;

/// Rays before a plane, each in its cell: by how much they are in front of it, along the plane's
/// axis, and how fast that changes with t.
struct PlaneView {
    Float height, rate;
    Int face;
    Int exists;

    Float heightAt(const Float& after) const { return height + rate * after; }
};

/// Where rays meet the surface in a cell, after the present t.
struct Meeting {
    Int met;      ///< the surface, or from behind a cell with surfaces: the cell's face
    Float after;  ///< t less the present one
    Int face;
};

class PacketTracer {
  public:
    PacketTracer(const VoxelGrid& grid, const Camera& camera, const Pose& T_c_w)
        : grid_(grid), camera_(camera), frame_(grid, T_c_w) {
        for (int a = 0; a < 3; ++a) {
            low_[a] = grid.box.low[a] - frame_.eye[a];
            high_[a] = grid.box.high[a] - frame_.eye[a];
        }
    }

    bool inReach() const { return frame_.inReach; }

    static constexpr int kPackets = 2;  ///< traced at once: each waits for memory most of the time
    using Packets = std::array<Rays, kPackets>;

    /// Renders kPackets * simd::kWidth pixels from (u, v) to the right.
    void render(unsigned u, unsigned v, std::array<Float, kPackets>& depth,
                std::array<Float, kPackets>& intensity) const {
        Packets packets;
        for (int i = 0; i < kPackets; ++i) packets[i] = start(u + i * simd::kWidth, v);
        const std::array<Int, kPackets> hit = march(packets);
        for (int i = 0; i < kPackets; ++i) shade(packets[i], hit[i], depth[i], intensity[i]);
    }

  private:
    /// Where rays leave their cells: at t, across the plane of one axis.
    struct Exit {
        Float t;
        Int xFirst, yFirst;
    };

    Rays start(unsigned u, unsigned v) const;
    std::array<Int, kPackets> march(Packets& packets) const;
    std::array<Int, kPackets> marchToCells(Packets& packets) const;
    Int distances(const Rays& rays, const Int& wanted) const;
    Int enterCells(Rays& rays, Int& inside) const;
    Meeting meetSurfaces(const Rays& rays, const Int& planes, const Exit& exit) const;
    Int planesOf(const Rays& rays, const Int& wanted) const;
    Vector3<Float> fromCentre(const Rays& rays) const;
    Exit exitOf(const Rays& rays) const;
    static Int leaveCells(Rays& rays, const Int& leaving, const Exit& exit);
    void shade(const Rays& rays, Int hit, Float& depth, Float& intensity) const;
    void enterAxis(Rays& rays, const Float& direction, const Float& inverse, int a) const;
    static void advance(Rays& rays, const Int& radius, const Eigen::Vector3f& offset);

    const VoxelGrid& grid_;
    const Camera& camera_;
    RayFrame frame_;
    std::array<int, 3> low_, high_;  ///< the map's bounding box, relative to the eye's cell
};

void PacketTracer::enterAxis(Rays& rays, const Float& direction, const Float& inverse,
                             int a) const {
    const Int forward = direction > 0.F;
    const Float nearPlane = simd::toFloat(forward ? simd::splat(low_[a]) : simd::splat(high_[a]));
    const Float farPlane = simd::toFloat(forward ? simd::splat(high_[a]) : simd::splat(low_[a]));
    const Float tNear = (nearPlane - frame_.offset[a]) * inverse;
    rays.tExit = simd::min(rays.tExit, (farPlane - frame_.offset[a]) * inverse);
    const Int later = tNear > rays.t;
    rays.t = later ? tNear : rays.t;
    rays.axis = later ? simd::splat(a) : rays.axis;
}

Rays PacketTracer::start(unsigned u, unsigned v) const {
    const Float x = (simd::ramp() + static_cast<float>(u) - static_cast<float>(camera_.cx())) *
                    static_cast<float>(1. / camera_.fx());
    const auto y = static_cast<float>((v - camera_.cy()) / camera_.fy());
    const auto component = [&](int a) {
        const Float d = frame_.R(a, 0) * x + (frame_.R(a, 1) * y + frame_.R(a, 2));
        const Int parallel = simd::abs(d) < 1e-20F;  // keeps the inverse finite
        return parallel ? simd::splat(1e-20F) : d;
    };
    Rays rays;
    rays.direction = {component(0), component(1), component(2)};
    rays.inverse = {1.F / rays.direction.x, 1.F / rays.direction.y, 1.F / rays.direction.z};
    rays.t = simd::splat(0.F);
    rays.tExit = simd::splat(1e30F);
    rays.axis = simd::splat(kNoFace);
    enterAxis(rays, rays.direction.x, rays.inverse.x, 0);
    enterAxis(rays, rays.direction.y, rays.inverse.y, 1);
    enterAxis(rays, rays.direction.z, rays.inverse.z, 2);
    rays.active = rays.t < rays.tExit;
    const auto cell = [&](const Float& direction, int a) {
        const Float at = frame_.offset[a] + rays.t * direction;
        const Float inside =
            simd::clamp(at, static_cast<float>(low_[a]), static_cast<float>(high_[a]) - 0.5F);
        const Int entered = simd::floor(inside);
        return rays.axis == a ? (direction > 0.F ? simd::splat(low_[a]) : simd::splat(high_[a] - 1))
                              : entered;
    };
    rays.cell = {cell(rays.direction.x, 0), cell(rays.direction.y, 1), cell(rays.direction.z, 2)};
    return rays;
}

/// Moves active rays out of the cube of empty cells around theirs, `radius` >= 1 cells to each side
/// up to its outer planes, into the cell behind the plane they cross.
inline void PacketTracer::advance(Rays& rays, const Int& radius, const Eigen::Vector3f& offset) {
    struct Crossing {
        Int next;
        Float t;
    };
    const auto cross = [&](const Int& cell, const Float& direction, const Float& inverse, float o) {
        const Int backward = direction < 0.F;
        const Int next = backward ? cell - radius : cell + radius;
        return Crossing{next, (simd::toFloat(next - backward) - o) * inverse};
    };
    const Crossing x = cross(rays.cell.x, rays.direction.x, rays.inverse.x, offset.x());
    const Crossing y = cross(rays.cell.y, rays.direction.y, rays.inverse.y, offset.y());
    const Crossing z = cross(rays.cell.z, rays.direction.z, rays.inverse.z, offset.z());
    const Int xFirst = (x.t <= y.t) & (x.t <= z.t);
    const Int yFirst = ~xFirst & (y.t <= z.t);
    const Float t = xFirst ? x.t : (yFirst ? y.t : z.t);
    const Int axis = xFirst ? simd::splat(0) : (yFirst ? simd::splat(1) : simd::splat(2));
    const auto move = [&](Int& cell, const Float& direction, float o, const Int& next,
                          const Int& crossed) {
        const Int within = simd::floor(o + t * direction);
        const Int kept = simd::clamp(within, cell - (radius - 1), cell + (radius - 1));
        cell = rays.active ? (crossed ? next : kept) : cell;
    };
    move(rays.cell.x, rays.direction.x, offset.x(), x.next, xFirst);
    move(rays.cell.y, rays.direction.y, offset.y(), y.next, yFirst);
    move(rays.cell.z, rays.direction.z, offset.z(), z.next, ~xFirst & ~yFirst);
    rays.axis = rays.active ? axis : rays.axis;
    rays.t = rays.active ? t : rays.t;
    rays.active &= rays.t < rays.tExit;
}

/// VoxelGrid::distance of rays' cells.
inline Int PacketTracer::distances(const Rays& rays, const Int& wanted) const {
    const int strideY = grid_.size.x(), strideZ = grid_.size.x() * grid_.size.y();
    const auto base = static_cast<int>(frame_.eye.x() + std::int64_t(frame_.eye.y()) * strideY +
                                       std::int64_t(frame_.eye.z()) * strideZ);
    const Int index = base + rays.cell.x + rays.cell.y * strideY + rays.cell.z * strideZ;
    return simd::gather<1>(grid_.distance.data(), index & wanted) & 0xFF;
}

/// Moves active rays to the cells where they end. @returns those that reached one
std::array<Int, PacketTracer::kPackets> PacketTracer::marchToCells(Packets& packets) const {
    std::array<Int, kPackets> hit{};
    while (simd::any(packets[0].active | packets[1].active)) {
        for (int i = 0; i < kPackets; ++i) {
            Rays& rays = packets[i];
            const Int radius = distances(rays, rays.active);
            const Int ended = rays.active & (radius == 0);
            hit[i] |= ended;
            rays.active &= ~ended;
            advance(rays, radius, frame_.offset);
        }
    }
    return hit;
}

/// Decodes planes (SurfacePlane) and looks at them from where rays are in their cells.
[[gnu::always_inline]] inline PlaneView viewPlane(const Int& plane, const Vector3<Float>& at,
                                                  const Vector3<Float>& direction) {
    const Int face = (plane >> 29 & 7) - 1;
    const Float slopeP = simd::toFloat(plane << 23 >> 23) * SurfacePlane::kSlopeUnit;
    const Float slopeQ = simd::toFloat(plane << 14 >> 23) * SurfacePlane::kSlopeUnit;
    const Float offset = simd::toFloat(plane << 3 >> 21) * SurfacePlane::kOffsetUnit;
    const Int onX = face <= 1, onZ = face >= 4;
    const auto above = [&](const Vector3<Float>& v) {
        const Float a = onX ? v.x : (onZ ? v.z : v.y);
        return a - slopeP * (onX ? v.y : v.x) - slopeQ * (onZ ? v.y : v.z);
    };
    const Float height = above(at) - offset, rate = above(direction);
    const Int outward = (face & 1) != 0;
    return {outward ? height : -height, outward ? rate : -rate, face, plane != 0};
}

/// Where rays meet a single plane.
[[gnu::always_inline]] inline Meeting meetPlane(const PlaneView& plane, const Float& toExit,
                                                const Float& back) {
    const Int facing = plane.rate < 0.F;
    const Float after = plane.height / (facing ? -plane.rate : simd::splat(1.F));
    const Int met = facing ? after <= toExit : plane.height <= 0.F;
    return {met, simd::max(after, -back), facing ? plane.face : simd::splat(kNoPlane)};
}

/// Where rays meet planes that bound a cell's solid together.
template <std::size_t N>
Meeting meetPlanes(const std::array<PlaneView, N>& planes, const Int& edges, const Float& toExit,
                   const Float& back) {
    constexpr float kTolerance = 1e-4F;
    Meeting best{simd::splat(0), simd::splat(1e30F), simd::splat(kNoPlane)};
    Int anyFacing = simd::splat(0), behindAny = simd::splat(0), behindAll = simd::splat(-1);
    for (std::size_t i = 0; i < N; ++i) {
        Meeting one = meetPlane(planes[i], toExit, back);
        const Int facing = planes[i].exists & (one.face >= 0);
        Int met = facing & one.met & (one.after < best.after);
        for (std::size_t j = 0; j < N; ++j) {
            if (i == j) continue;
            const int pair = static_cast<int>(i + j) - 1;
            const Float height = planes[j].heightAt(one.after);
            const Int convex = (edges >> pair & 1) != 0, concave = (edges >> (pair + 3) & 1) != 0;
            met &= ~(convex & (height > kTolerance)) & ~(concave & (height < -kTolerance));
        }
        best.met |= met;
        best.after = met ? one.after : best.after;
        best.face = met ? one.face : best.face;
        anyFacing |= facing;
        behindAny |= planes[i].exists & one.met;
        behindAll &= ~planes[i].exists | one.met;
    }
    const Int isConcave = (edges >> 3) != 0;
    best.met |= ~anyFacing & (isConcave ? behindAny : behindAll);
    return best;
}

Vector3<Float> PacketTracer::fromCentre(const Rays& rays) const {
    const auto along = [&](const Float& direction, const Int& cell, float offset) {
        return offset + rays.t * direction - simd::toFloat(cell) - 0.5F;
    };
    return {along(rays.direction.x, rays.cell.x, frame_.offset.x()),
            along(rays.direction.y, rays.cell.y, frame_.offset.y()),
            along(rays.direction.z, rays.cell.z, frame_.offset.z())};
}

/// Where rays leave their cells.
PacketTracer::Exit PacketTracer::exitOf(const Rays& rays) const {
    const auto time = [&](const Float& direction, const Float& inverse, const Int& cell, float o) {
        const Int forward = direction > 0.F;
        return (simd::toFloat(cell - forward) - o) * inverse;
    };
    const auto& d = rays.direction;
    const Float x = time(d.x, rays.inverse.x, rays.cell.x, frame_.offset.x());
    const Float y = time(d.y, rays.inverse.y, rays.cell.y, frame_.offset.y());
    const Float z = time(d.z, rays.inverse.z, rays.cell.z, frame_.offset.z());
    const Int xFirst = (x <= y) & (x <= z), yFirst = ~xFirst & (y <= z);
    return {xFirst ? x : (yFirst ? y : z), xFirst, yFirst};
}

/// Moves some rays into the next cell. @returns those of them that are still in the map
Int PacketTracer::leaveCells(Rays& rays, const Int& leaving, const Exit& exit) {
    const auto move = [&](Int& cell, const Float& direction, const Int& crossed) {
        const Int step = direction > 0.F ? simd::splat(1) : simd::splat(-1);
        cell += step & crossed & leaving;
    };
    const Int zFirst = ~exit.xFirst & ~exit.yFirst;
    move(rays.cell.x, rays.direction.x, exit.xFirst);
    move(rays.cell.y, rays.direction.y, exit.yFirst);
    move(rays.cell.z, rays.direction.z, zFirst);
    const Int axis = (exit.yFirst & 1) + (zFirst & 2);
    rays.axis = leaving ? axis : rays.axis;
    rays.t = leaving ? exit.t : rays.t;
    return leaving & (rays.t < rays.tExit);
}

/// The entries of VoxelGrid::planes of rays' cells; 0 for all but the wanted ones.
Int PacketTracer::planesOf(const Rays& rays, const Int& wanted) const {
    const Int x = (rays.cell.x + frame_.eye.x()) & wanted,
              y = (rays.cell.y + frame_.eye.y()) & wanted,
              z = (rays.cell.z + frame_.eye.z()) & wanted;
    const Int brick = ((z >> 2) * grid_.bricks.y() + (y >> 2)) * grid_.bricks.x() + (x >> 2);
    const Int textures = simd::gather<4>(grid_.brickTextures.data(), brick);
    const Int bit = (x & 3) + 4 * (y & 3) + 16 * (z & 3);
    const Int entry = textures * VoxelGrid::kCellsPerBrick + bit;
    return simd::gather<4>(grid_.planes.data(), entry & wanted) & wanted;
}

/// Where rays in cells with these planes meet the surface.
Meeting PacketTracer::meetSurfaces(const Rays& rays, const Int& planes, const Exit& exit) const {
    const auto& d = rays.direction;
    const Vector3<Float> at = fromCentre(rays);
    const auto& inverse = rays.inverse;  // the least one is the time to cross a cell
    const Float back = kGap * simd::min(simd::min(simd::abs(inverse.x), simd::abs(inverse.y)),
                                        simd::abs(inverse.z));
    const Float toExit = exit.t - rays.t;
    const Int several = (planes >> 29 & 7) == static_cast<int>(SurfacePlane::kSeveral);
    if (!simd::any(several)) return meetPlane(viewPlane(planes, at, d), toExit, back);
    const Int index = (planes & 0x1FFFFFFF & several) * 4;
    const auto part = [&](int i) { return simd::gather<4>(grid_.several.data(), index + i); };
    return meetPlanes<3>({viewPlane(several ? part(0) : planes, at, d), viewPlane(part(1), at, d),
                          viewPlane(part(2), at, d)},
                         part(3), toExit, back);
}

/// Moves rays inside occupied cells to the surfaces there, or, where they miss them, into the next
/// cell. `inside` keeps those that are in an occupied cell again; those that came out are active.
/// @returns those that met a surface or are in a cell without
inline Int PacketTracer::enterCells(Rays& rays, Int& inside) const {
    const Int planes = planesOf(rays, inside);
    const Exit exit = exitOf(rays);
    const Meeting meeting = meetSurfaces(rays, planes, exit);
    const Int met = inside & ((planes == 0) | meeting.met);
    const Int moved = met & (planes != 0) & (meeting.face >= 0);
    rays.t = moved ? rays.t + meeting.after : rays.t;
    rays.face = moved ? meeting.face : rays.face;
    inside = leaveCells(rays, inside & ~met, exit);
    const Int ends = distances(rays, inside) == 0;
    rays.active |= inside & ~ends;
    inside &= ends;
    return met;
}

/// @returns the lanes that ended at a surface
std::array<Int, PacketTracer::kPackets> PacketTracer::march(Packets& packets) const {
    std::array<Int, kPackets> hit{};
    for (Rays& rays : packets) rays.face = simd::splat(kNoPlane);
    while (simd::any(packets[0].active | packets[1].active)) {
        std::array<Int, kPackets> inside = marchToCells(packets);
        while (simd::any(inside[0] | inside[1])) {
            for (int i = 0; i < kPackets; ++i) hit[i] |= enterCells(packets[i], inside[i]);
        }
    }
    return hit;
}

void PacketTracer::shade(const Rays& rays, Int hit, Float& depth, Float& intensity) const {
    // Nothing is seen from inside a solid.
    hit &= rays.face >= 0 ? rays.t > 0.F : rays.axis != kNoFace;
    const Float along =
        rays.axis == 0 ? rays.direction.x : (rays.axis == 2 ? rays.direction.z : rays.direction.y);
    const Int faceOfCell = 2 * rays.axis - (along < 0.F);  // a ray down hits an upper face
    const Int face = rays.face >= 0 ? rays.face : faceOfCell;
    const Int onX = face <= 1, onZ = face >= 4;
    const auto inCell = [&](const Float& direction, const Int& cell, int a) {
        const Float at = frame_.offset[a] + rays.t * direction - simd::toFloat(cell);
        return simd::clamp(at, -0.5F, 1.499F);  // up to the neighbouring faces' centres
    };
    const Float fx = inCell(rays.direction.x, rays.cell.x, 0);
    const Float fy = inCell(rays.direction.y, rays.cell.y, 1);
    const Float fz = inCell(rays.direction.z, rays.cell.z, 2);
    const Int x = (rays.cell.x + frame_.eye.x()) & hit, y = (rays.cell.y + frame_.eye.y()) & hit,
              z = (rays.cell.z + frame_.eye.z()) & hit;

    // The face's layer in the brick, and the coordinates p and q of its plane.
    const Int layer = (onX ? x : (onZ ? z : y)) & 3;
    const Int p = (onX ? y : x) & 3, q = (onZ ? y : z) & 3;
    const Float fp = onX ? fy : fx, fq = onZ ? fy : fz;

    const Int brick = ((z >> 2) * grid_.bricks.y() + (y >> 2)) * grid_.bricks.x() + (x >> 2);
    const Int textures = simd::gather<4>(grid_.brickTextures.data(), brick);
    const Int entry = (textures * VoxelGrid::kPatchesPerBrick + 4 * face + layer) & hit;
    constexpr int kWords = sizeof(FacePatch) / 2;
    const Int patch = simd::gather<4>(grid_.patchOf.data(), entry) * kWords;
    const Int valid = simd::gather<2>(grid_.patches.data(), patch + FacePatch::kValidIndex);
    hit &= (valid >> (4 * q + p) & 1) != 0;

    const Float rp = simd::toFloat(p) + (fp + 0.5F), rq = simd::toFloat(q) + (fq + 0.5F);
    const Int ip = simd::floor(rp), iq = simd::floor(rq);
    const Float wp = rp - simd::toFloat(ip), wq = rq - simd::toFloat(iq);
    const Int corner = patch + FacePatch::kSide * iq + ip;
    const Int upper = simd::gather<2>(grid_.patches.data(), corner);
    const Int lower = simd::gather<2>(grid_.patches.data(), corner + FacePatch::kSide);
    const auto lerp = [](const Float& a, const Float& b, const Float& w) {
        return a + (b - a) * w;
    };
    const auto left = [](const Int& pair) { return simd::toFloat(pair & 0xFFFF); };
    const auto right = [](const Int& pair) { return simd::toFloat(pair >> 16 & 0xFFFF); };
    const Float grey =
        lerp(lerp(left(upper), right(upper), wp), lerp(left(lower), right(lower), wp), wq);
    intensity = hit ? grey * (1.F / 65535.F) : simd::splat(0.F);
    depth = hit ? rays.t : simd::splat(0.F);
}

}  // namespace

VoxelRenderer::VoxelRenderer(const TexturedOcTree& map, UnknownPolicy unknown) {
    VoxelGridBuilder(map, unknown, grid_);
}

void VoxelRenderer::render(const Camera& camera, const Pose& T_c_w, View& view) const {
    if (!T_c_w.matrix().allFinite()) {
        throw std::invalid_argument("VoxelRenderer: the pose is not finite");
    }
    view.intensity.resize(camera.height, camera.width);
    view.depth.resize(camera.height, camera.width);
    const PacketTracer tracer(grid_, camera, T_c_w);
    if (!tracer.inReach()) {
        view.intensity = 0.F;
        view.depth = 0.F;
        return;
    }
    for (unsigned v = 0; v < camera.height; ++v) {
        constexpr unsigned kPixels = PacketTracer::kPackets * simd::kWidth;
        for (unsigned u = 0; u < camera.width; u += kPixels) {
            std::array<Float, PacketTracer::kPackets> depth, intensity;
            tracer.render(u, v, depth, intensity);
            const std::size_t bytes = sizeof(float) * std::min(kPixels, camera.width - u);
            std::memcpy(view.depth[v] + u, depth.data(), bytes);
            std::memcpy(view.intensity[v] + u, intensity.data(), bytes);
        }
    }
    applyPointSpread(view);
}

}  // namespace photonav
