// SPDX-License-Identifier: BSD-3-Clause
#include "render/packet_tracer.hpp"

#include <array>
#include <cstring>

#include "render/surface_intersection.hpp"
#include "render/voxel_boxes.hpp"
#include "render/voxel_rays.hpp"

namespace photonav {
namespace {

using simd::Float;
using simd::Int;

// Planes of neighbouring cells do not meet exactly. A ray that enters a cell behind the plane that
// faces it went through such a gap: it meets the plane up to this far before the cell [cells].
constexpr float kGap = 0.5F;

/// Traces rays of one camera pose to the first surfaces that they meet, and shades these. The cells
/// that a ray visits do not depend on how empty space is divided into boxes: of two planes that it
/// crosses at the same time, the one across the first axis comes first.
class PacketTracer {
  public:
    PacketTracer(const VoxelGrid& grid, const Camera& camera, const Pose& T_c_w)
        : grid_(grid), camera_(camera), frame_(grid, T_c_w) {
        for (int a = 0; a < 3; ++a) {
            low_[a] = grid.box.low[a] - frame_.eye[a];
            high_[a] = grid.box.high[a] - frame_.eye[a];
        }
        if (!frame_.inReach || !grid.box.contains({frame_.eye, frame_.eye + 1})) return;
        const CellBox box = emptyBoxOf(grid, frame_.eye / 4);
        if (!box.contains({frame_.eye, frame_.eye + 1})) return;
        eyeIsInBox_ = true;
        eyeBox_ = {box.low - frame_.eye, box.high - frame_.eye};
    }

    bool inReach() const { return frame_.inReach; }

    static constexpr int kPackets = 2;  ///< traced at once: each waits for memory most of the time
    using Packets = std::array<Rays, kPackets>;

    /// Renders kPackets * simd::kWidth pixels from (u, v) to the right.
    void render(unsigned u, unsigned v, std::array<Float, kPackets>& depth,
                std::array<Float, kPackets>& intensity) const {
        Packets packets;
        for (int i = 0; i < kPackets; ++i) {
            packets[i] = start(u + i * simd::kWidth, v);
            if (eyeIsInBox_) advance(packets[i], planesAhead(packets[i]));
        }
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
    Vector3<Int> planesAhead(const Rays& rays) const;
    std::array<Int, kPackets> march(Packets& packets) const;
    std::array<Int, kPackets> marchToCells(Packets& packets) const;
    Vector3<Int> emptyBoxes(Rays& rays, Int& hit) const;
    Int endsAt(const Rays& rays, const Int& wanted) const;
    void advance(Rays& rays, const Vector3<Int>& planes) const;
    Vector3<Int> gridCells(const Rays& rays) const;
    Int bricksAt(const Vector3<Int>& cells) const;
    Int enterCells(Rays& rays, Int& inside) const;
    Intersection meetSurfaces(const Rays& rays, const Int& planes, const Exit& exit) const;
    Int planesOf(const Rays& rays, const Int& wanted) const;
    Vector3<Float> fromCentre(const Rays& rays) const;
    Exit exitOf(const Rays& rays) const;
    static Int leaveCells(Rays& rays, const Int& leaving, const Exit& exit);
    void shade(const Rays& rays, Int hit, Float& depth, Float& intensity) const;
    void enterAxis(Rays& rays, const Float& direction, const Float& inverse, int a) const;

    const VoxelGrid& grid_;
    const Camera& camera_;
    RayFrame frame_;
    std::array<int, 3> low_, high_;  ///< the map's bounding box, relative to the eye's cell
    bool eyeIsInBox_ = false;
    CellBox eyeBox_;  ///< around the eye, relative to its cell: all rays leave it first
};

inline void PacketTracer::enterAxis(Rays& rays, const Float& direction, const Float& inverse,
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

inline Rays PacketTracer::start(unsigned u, unsigned v) const {
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
    rays.axis = simd::splat(Rays::kNoAxis);
    enterAxis(rays, rays.direction.x, rays.inverse.x, 0);
    enterAxis(rays, rays.direction.y, rays.inverse.y, 1);
    enterAxis(rays, rays.direction.z, rays.inverse.z, 2);
    rays.active = rays.t < rays.tExit;
    const auto cell = [&](const Float& direction, const Float& inverse, int a) {
        const Int within =
            simd::clamp(cellAt(rays.t, direction, inverse, frame_.offset[a], rays.axis > a),
                        simd::splat(low_[a]), simd::splat(high_[a] - 1));
        const Int border = direction > 0.F ? simd::splat(low_[a]) : simd::splat(high_[a] - 1);
        const Int entered = rays.axis == a ? border : within;
        return rays.axis == Rays::kNoAxis ? simd::splat(0) : entered;
    };
    rays.cell = {cell(rays.direction.x, rays.inverse.x, 0),
                 cell(rays.direction.y, rays.inverse.y, 1),
                 cell(rays.direction.z, rays.inverse.z, 2)};
    return rays;
}

/// The planes through which rays leave the empty box around the eye.
inline Vector3<Int> PacketTracer::planesAhead(const Rays& rays) const {
    const auto plane = [&](const Float& direction, int a) {
        const Int forward = direction > 0.F;
        return forward ? simd::splat(eyeBox_.high[a]) : simd::splat(eyeBox_.low[a]);
    };
    return {plane(rays.direction.x, 0), plane(rays.direction.y, 1), plane(rays.direction.z, 2)};
}

inline Vector3<Int> PacketTracer::gridCells(const Rays& rays) const {
    return {rays.cell.x + frame_.eye.x(), rays.cell.y + frame_.eye.y(),
            rays.cell.z + frame_.eye.z()};
}

inline Int PacketTracer::bricksAt(const Vector3<Int>& cells) const {
    return ((cells.z >> 2) * grid_.bricks.y() + (cells.y >> 2)) * grid_.bricks.x() + (cells.x >> 2);
}

/// Bit x + 4 y + 16 z of cells in their bricks.
inline Int bitsOf(const Vector3<Int>& cells) {
    return (cells.x & 3) + 4 * (cells.y & 3) + 16 * (cells.z & 3);
}

/// Which of the wanted rays end in their cells.
inline Int PacketTracer::endsAt(const Rays& rays, const Int& wanted) const {
    const Vector3<Int> cells = gridCells(rays);
    const Int bits = bitsOf(cells), word = 2 * bricksAt(cells) + (bits >> 5);
    const Int ends = simd::gather<4>(grid_.ends.data(), word & wanted);
    return wanted & ((ends >> (bits & 31) & 1) != 0);
}

/// The planes, one per axis, through which active rays leave the empty boxes around them, or their
/// cells. Rays that end in their cells become hits, and inactive.
inline Vector3<Int> PacketTracer::emptyBoxes(Rays& rays, Int& hit) const {
    const Vector3<Int> cells = gridCells(rays);
    Int before, after;
    simd::gatherPairs(grid_.boxes.data(), bricksAt(cells) & rays.active, before, after);
    const Int x = cells.x & 3, y = cells.y & 3, z = cells.z & 3;
    // Cells of the box on both sides of the ray's; negative: it is outside.
    const Vector3<Int> back{(before & 0xFF) + x - 3, (before >> 8 & 0xFF) + y - 3,
                            (before >> 16 & 0xFF) + z - 3};
    const Vector3<Int> ahead{(after & 0xFF) - x - 1, (after >> 8 & 0xFF) - y - 1,
                             (after >> 16) - z - 1};
    const Int outside =
        rays.active & ((back.x | back.y | back.z | ahead.x | ahead.y | ahead.z) < 0);
    Int ended = outside & before;  // EmptyBox::restEnds is the sign
    ended = ended < 0;
    if (simd::any(outside & ~ended)) ended |= endsAt(rays, outside & ~ended);
    hit |= ended;
    rays.active &= ~ended;
    const auto plane = [&](const Int& cell, const Float& direction, const Int& b, const Int& a) {
        const Int forward = direction > 0.F;
        return cell + ((forward ? a : -b) & ~outside) - forward;
    };
    return {plane(rays.cell.x, rays.direction.x, back.x, ahead.x),
            plane(rays.cell.y, rays.direction.y, back.y, ahead.y),
            plane(rays.cell.z, rays.direction.z, back.z, ahead.z)};
}

/// Moves active rays into the cells behind the first of three planes that they cross.
inline void PacketTracer::advance(Rays& rays, const Vector3<Int>& planes) const {
    const auto& d = rays.direction;
    const auto& inverse = rays.inverse;
    const Eigen::Vector3f& offset = frame_.offset;
    const Float tx = (simd::toFloat(planes.x) - offset.x()) * inverse.x;
    const Float ty = (simd::toFloat(planes.y) - offset.y()) * inverse.y;
    const Float tz = (simd::toFloat(planes.z) - offset.z()) * inverse.z;
    const Int xFirst = (tx <= ty) & (tx <= tz), yFirst = ~xFirst & (ty <= tz);
    const Int zFirst = ~xFirst & ~yFirst;
    const Float t = xFirst ? tx : (yFirst ? ty : tz);
    rays.active &= t < rays.tExit;  // behind, there are no cells
    const auto move = [&](Int& cell, const Float& direction, const Int& plane, const Int& crossed,
                          const Int& within) {
        const Int behind = plane + (direction < 0.F);
        cell = rays.active ? (crossed ? behind : within) : cell;
    };
    move(rays.cell.x, d.x, planes.x, xFirst,
         cellAt(t, d.x, inverse.x, offset.x(), simd::splat(-1)));
    move(rays.cell.y, d.y, planes.y, yFirst, cellAt(t, d.y, inverse.y, offset.y(), zFirst));
    move(rays.cell.z, d.z, planes.z, zFirst, cellAt(t, d.z, inverse.z, offset.z(), simd::splat(0)));
    const Int axis = (yFirst & 1) + (zFirst & 2);
    rays.axis = rays.active ? axis : rays.axis;
    rays.t = rays.active ? t : rays.t;
}

/// Moves active rays to the cells where they end. @returns those that reached one
std::array<Int, PacketTracer::kPackets> PacketTracer::marchToCells(Packets& packets) const {
    std::array<Int, kPackets> hit{};
    while (simd::any(packets[0].active | packets[1].active)) {
        for (int i = 0; i < kPackets; ++i) {
            const Vector3<Int> planes = emptyBoxes(packets[i], hit[i]);
            if (simd::any(packets[i].active)) advance(packets[i], planes);
        }
    }
    return hit;
}

inline Vector3<Float> PacketTracer::fromCentre(const Rays& rays) const {
    const auto along = [&](const Float& direction, const Int& cell, float offset) {
        return offset + rays.t * direction - simd::toFloat(cell) - 0.5F;
    };
    return {along(rays.direction.x, rays.cell.x, frame_.offset.x()),
            along(rays.direction.y, rays.cell.y, frame_.offset.y()),
            along(rays.direction.z, rays.cell.z, frame_.offset.z())};
}

/// Where rays leave their cells.
inline PacketTracer::Exit PacketTracer::exitOf(const Rays& rays) const {
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
inline Int PacketTracer::leaveCells(Rays& rays, const Int& leaving, const Exit& exit) {
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
inline Int PacketTracer::planesOf(const Rays& rays, const Int& wanted) const {
    const Vector3<Int> cells = gridCells(rays);
    const Int textures = simd::gather<4>(grid_.brickTextures.data(), bricksAt(cells) & wanted);
    const Int entry = textures * VoxelGrid::kCellsPerBrick + bitsOf(cells);
    return simd::gather<4>(grid_.planes.data(), entry & wanted) & wanted;
}

/// Where rays in cells with these planes meet the surface.
Intersection PacketTracer::meetSurfaces(const Rays& rays, const Int& planes,
                                        const Exit& exit) const {
    const auto& d = rays.direction;
    const Vector3<Float> at = fromCentre(rays);
    const auto& inverse = rays.inverse;  // the least one is the time to cross a cell
    const Float back = kGap * simd::min(simd::min(simd::abs(inverse.x), simd::abs(inverse.y)),
                                        simd::abs(inverse.z));
    const Float toExit = exit.t - rays.t;
    const Int several = (planes >> 29 & 7) == static_cast<int>(SurfacePlane::kSeveral);
    if (!simd::any(several)) return intersectPlane(viewPlane(planes, at, d), toExit, back);
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
    const Intersection meeting = meetSurfaces(rays, planes, exit);
    const Int met = inside & ((planes == 0) | meeting.met);
    const Int moved = met & (planes != 0) & (meeting.face >= 0);
    rays.t = moved ? rays.t + meeting.after : rays.t;
    rays.face = moved ? meeting.face : rays.face;
    inside = leaveCells(rays, inside & ~met, exit);
    const Int ends = endsAt(rays, inside);
    rays.active |= inside & ~ends;
    inside &= ends;
    return met;
}

/// @returns the lanes that ended at a surface
std::array<Int, PacketTracer::kPackets> PacketTracer::march(Packets& packets) const {
    std::array<Int, kPackets> hit{};
    for (Rays& rays : packets) rays.face = simd::splat(Rays::kNoPlane);
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
    hit &= rays.face >= 0 ? rays.t > 0.F : rays.axis != Rays::kNoAxis;
    const Float along =
        rays.axis == 0 ? rays.direction.x : (rays.axis == 2 ? rays.direction.z : rays.direction.y);
    const Int faceOfCell = 2 * rays.axis - (along < 0.F);  // a ray down hits an upper face
    const Int face = rays.face >= 0 ? rays.face : faceOfCell;
    const Int onX = face <= 1, onZ = face >= 4;
    const auto inCell = [&](const Float& direction, const Int& cell, int a) {
        const Float at = frame_.offset[a] + rays.t * direction - simd::toFloat(cell);
        return simd::clamp(at, -0.5F,
                           1.499F);  // up to the neighbouring faces' centres
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

    const Int textures = simd::gather<4>(grid_.brickTextures.data(), bricksAt({x, y, z}));
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

void tracePackets(const VoxelGrid& grid, const Camera& camera, const Pose& T_c_w, View& view) {
    const PacketTracer tracer(grid, camera, T_c_w);
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
}

}  // namespace photonav
