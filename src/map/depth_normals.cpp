// SPDX-License-Identifier: BSD-3-Clause
#include "map/depth_normals.hpp"

#include <cmath>

#include "photometry/simd.hpp"

namespace photonav {
namespace {

using simd::Float;
using simd::Int;

constexpr int kMostPixels = 16;  // to each side

/// The two ends of a difference across a pixel: z-depths, and how many pixels they are off it.
struct Ends {
    Float before, after;
    Float pixelsBefore, pixelsAfter;
    Int exist;
};

Ends endsOf(const Float& z, const Float& before, const Float& after, const Int& pixels,
            float jump) {
    const Int hasBefore = before > 0.F, hasAfter = after > 0.F;
    const Float one = simd::splat(1.F), none = simd::splat(0.F);
    const Float bend = 2.F - z / (hasBefore ? before : one) - z / (hasAfter ? after : one);
    const Int both = hasBefore & hasAfter & (simd::abs(bend) < jump);
    const Int isAfterNearer = simd::abs(after - z) < simd::abs(before - z);
    const Int useAfter = both | (hasAfter & (~hasBefore | isAfterNearer));
    const Int useBefore = both | ~useAfter;
    const Float k = simd::toFloat(pixels);
    return {useBefore ? before : z, useAfter ? after : z, useBefore ? k : none, useAfter ? k : none,
            hasBefore | hasAfter};
}

Float inverseRoot(const Float& square) {
    Float result;
    for (int i = 0; i < simd::kWidth; ++i) result[i] = 1.F / std::sqrt(square[i]);
    return result;
}

}  // namespace

DepthNormals::DepthNormals(const ImageF& depth, const Camera& camera, const Eigen::Matrix3f& R,
                           double reach, double depthJump)
    : depth_(depth),
      camera_(camera),
      R_(R),
      reach_(static_cast<float>(reach * camera.fx())),
      jump_(static_cast<float>(depthJump)) {
    const std::size_t packets = (camera.width + simd::kWidth - 1) / simd::kWidth;
    for (auto& component : row_) component.resize(packets * simd::kWidth);
}

void DepthNormals::computeRow(unsigned v) {
    for (unsigned u = 0; u < camera_.width; u += simd::kWidth) {
        computePacket(static_cast<int>(u), static_cast<int>(v));
    }
}

void DepthNormals::computePacket(int u, int v) {
    const int width = static_cast<int>(camera_.width), height = static_cast<int>(camera_.height);
    const Int column = u + simd::toInt(simd::ramp());
    const auto depthAt = [&](const Int& x, const Int& y) {
        const Int inside = (x >= 0) & (x < width) & (y >= 0) & (y < height);
        const Int bits = simd::gather<4>(depth_.bitmap, (y * width + x) & inside);
        return inside ? reinterpret_cast<Float>(bits) : simd::splat(0.F);
    };
    const Float z = depthAt(column, simd::splat(v));
    const Int known = z > 0.F;
    const Float spread = reach_ / (known ? z : simd::splat(1.F));
    const Int k = simd::toInt(simd::clamp(spread + 0.5F, 1.F, static_cast<float>(kMostPixels)));
    const Int row = simd::splat(v);
    const Ends across = endsOf(z, depthAt(column - k, row), depthAt(column + k, row), k, jump_);
    const Ends down = endsOf(z, depthAt(column, row - k), depthAt(column, row + k), k, jump_);

    // Differences of the points (x z, y z, z).
    const auto dx = static_cast<float>(1. / camera_.fx()),
               dy = static_cast<float>(1. / camera_.fy());
    const Float x =
        (simd::ramp() + (static_cast<float>(u) - static_cast<float>(camera_.cx()))) * dx;
    const float y = (static_cast<float>(v) - static_cast<float>(camera_.cy())) * dy;
    const Float az = across.after - across.before, bz = down.after - down.before;
    const Float ax =
        x * az + dx * (across.pixelsAfter * across.after + across.pixelsBefore * across.before);
    const Float by =
        y * bz + dy * (down.pixelsAfter * down.after + down.pixelsBefore * down.before);
    const Float ay = y * az, bx = x * bz;

    // Down times across points to the camera.
    const Float nx = by * az - bz * ay, ny = bz * ax - bx * az, nz = bx * ay - by * ax;
    const Float square = nx * nx + ny * ny + nz * nz;
    const Int valid = known & across.exist & down.exist & (square > 1e-30F);
    Float scale = inverseRoot(valid ? square : simd::splat(1.F));
    scale = nx * x + ny * y + nz > 0.F ? -scale : scale;
    for (int a = 0; a < 3; ++a) {
        const Float n = scale * (R_(a, 0) * nx + R_(a, 1) * ny + R_(a, 2) * nz);
        simd::store(row_[a].data() + u, valid ? n : simd::splat(0.F));
    }
}

}  // namespace photonav
