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

    /// Renders simd::kWidth pixels from (u, v) to the right.
    void render(unsigned u, unsigned v, Float& depth, Float& intensity) const {
        Rays rays = start(u, v);
        const Int hit = march(rays);
        shade(rays, hit, depth, intensity);
    }

  private:
    Rays start(unsigned u, unsigned v) const;
    Int march(Rays& rays) const;
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

/// @returns the lanes that ended at a cell
Int PacketTracer::march(Rays& rays) const {
    const int strideY = grid_.size.x(), strideZ = grid_.size.x() * grid_.size.y();
    const auto base = static_cast<int>(frame_.eye.x() + std::int64_t(frame_.eye.y()) * strideY +
                                       std::int64_t(frame_.eye.z()) * strideZ);
    Int hit = simd::splat(0);
    while (simd::any(rays.active)) {
        const Int index = base + rays.cell.x + rays.cell.y * strideY + rays.cell.z * strideZ;
        const Int radius = simd::gather<1>(grid_.distance.data(), index & rays.active) & 0xFF;
        const Int ended = rays.active & (radius == 0);
        hit |= ended;
        rays.active &= ~ended;
        advance(rays, radius, frame_.offset);
    }
    return hit;
}

void PacketTracer::shade(const Rays& rays, Int hit, Float& depth, Float& intensity) const {
    hit &= rays.axis != kNoFace;
    const Int onX = rays.axis == 0, onZ = rays.axis == 2;
    const auto inCell = [&](const Float& direction, const Int& cell, int a) {
        const Float at = frame_.offset[a] + rays.t * direction - simd::toFloat(cell);
        return simd::clamp(at, 0.F, 1.F);
    };
    const Float fx = inCell(rays.direction.x, rays.cell.x, 0);
    const Float fy = inCell(rays.direction.y, rays.cell.y, 1);
    const Float fz = inCell(rays.direction.z, rays.cell.z, 2);
    const Int x = (rays.cell.x + frame_.eye.x()) & hit, y = (rays.cell.y + frame_.eye.y()) & hit,
              z = (rays.cell.z + frame_.eye.z()) & hit;

    // Face, its plane's coordinates p and q, and its layer in the brick.
    const Float along = onX ? rays.direction.x : (onZ ? rays.direction.z : rays.direction.y);
    const Int face = 2 * rays.axis - (along < 0.F);  // a ray that goes down hits an upper face
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
        for (unsigned u = 0; u < camera.width; u += simd::kWidth) {
            Float depth, intensity;
            tracer.render(u, v, depth, intensity);
            const std::size_t bytes =
                sizeof(float) * std::min<std::size_t>(simd::kWidth, camera.width - u);
            std::memcpy(view.depth[v] + u, &depth, bytes);
            std::memcpy(view.intensity[v] + u, &intensity, bytes);
        }
    }
    applyPointSpread(view);
}

}  // namespace photonav
