// SPDX-License-Identifier: BSD-3-Clause
#include "map/cell_scan.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <span>

#include "map/brick_leaves.hpp"

namespace photonav {
namespace {

using Eigen::Array3i;
using Eigen::Vector3d;

// Faces with a smaller share of their cell's pixels get no surface: scatter of the normals.
constexpr float kLeastShare = 0.15F;

/// Of the variance of a surface point: what all pixels of a view share, the error of the pose [m].
constexpr double kPoseNoise = 3e-3;
// Least weight of the past: about as many views of full weight.
constexpr float kMostSurfaceWeight = 50.F / (kPoseNoise * kPoseNoise);

/// Means of neighbouring cells that are nearer than this along the normal are of one surface
/// [standard deviations of depth].
constexpr double kSameSurface = 3.;
constexpr int kMostAcross = 3;  // cells; less than the margin of the scan's box

constexpr std::size_t kBricksAtOnce = 1 << 16;  // between two looks at FusionOptions::isStopped

/// A change in parts of what is tolerated.
float share(float change, double tolerance) {
    if (change == 0.F) return 0.F;
    return change / std::max(static_cast<float>(tolerance), 1e-30F);
}

/// @param depthNoise standard deviation of a pixel's depth [m]
void observeSurface(FaceSurface& surface, const CellPixels::Sums& sums, double depthNoise) {
    const CellPixels::Sums mean = sums / sums[0];
    const double variance = depthNoise * depthNoise / sums[0] + kPoseNoise * kPoseNoise;
    surface.observe({mean[2], mean[3], mean[4]}, {mean[5], mean[6], mean[7]},
                    static_cast<float>(1. / variance), kMostSurfaceWeight);
}

}  // namespace

/// Amanatides and Woo's traversal, without branches, because the next axis cannot be predicted.
/// Four rays at a time, because each step of a ray depends on the step before.
void CellScan::castRays(const Vector3d& eye) {
    constexpr int kLanes = 4;
    using Doubles [[gnu::vector_size(kLanes * 8)]] = double;
    using Places [[gnu::vector_size(kLanes * 8)]] = std::int64_t;
    const Array3i from = eye.array().floor().cast<int>();
    for (std::size_t first = 0; first < memory_.rayEnds.size(); first += kLanes) {
        std::array<Doubles, 3> next{}, delta{};  // in parts of the ray, per axis
        std::array<Places, 3> step{};
        Places left{};  // steps to the cell that holds the end
        const std::size_t rays = std::min<std::size_t>(kLanes, memory_.rayEnds.size() - first);
        for (std::size_t i = 0; i < rays; ++i) {
            const Vector3d& end = memory_.rayEnds[first + i];
            const Vector3d d = end - eye;
            for (int a = 0; a < 3; ++a) {
                const double gap = d[a] < 0. ? eye[a] - from[a] : from[a] + 1. - eye[a];
                delta[a][i] = 1. / std::max(std::abs(d[a]), 1e-9);
                next[a][i] = gap * delta[a][i];
                step[a][i] = d[a] < 0. ? -stride_[a] : stride_[a];
            }
            left[i] = (end.array().floor().cast<int>() - from).abs().sum();
        }
        const Places start = Places{} + place(from);  // finished rays stay here
        Places at = start;
        for (auto n = std::max({left[0], left[1], left[2], left[3]}); n > 0; --n) {
            for (std::size_t i = 0; i < kLanes; ++i) memory_.crossed[at[i]] = 1;
            auto& [x, y, z] = next;
            const Places xFirst = (x <= y) & (x <= z), yFirst = ~xFirst & (y <= z);
            const Places zFirst = ~(xFirst | yFirst);
            left -= 1;
            at = left > 0 ? at + ((xFirst & step[0]) | (yFirst & step[1]) | (zFirst & step[2]))
                          : start;
            x += xFirst ? delta[0] : Doubles{};
            y += yFirst ? delta[1] : Doubles{};
            z += zFirst ? delta[2] : Doubles{};
        }
    }
}

void CellScan::observeFaces(TexturedOcTreeNode& node, const Array3i& cell, const CellPixels& seen,
                            const std::optional<Vector3d>& eye,
                            const FusionOptions& options) const {
    const auto grey = static_cast<float>(seen.greySum / seen.count);
    Vector3d d = Vector3d::Ones();
    if (eye) d = (cell.cast<double>() + 0.5).matrix() - *eye;
    const double range = d.norm();
    const double depthNoise = options.depthNoise * std::pow(range * resolution_, 2);
    const auto maxWeight = static_cast<float>(options.maxFaceWeight);
    const double pixelsPerLength = seen.count / range;
    const float surfaceWeight = seen.surfaceWeight();
    for (int face = 0; face < 6; ++face) {
        const int a = face / 2;
        const int side = face % 2 == 0 ? -1 : 1;
        const CellPixels::Sums& sums = seen.faces[face];
        if (eye && sums[0] > kLeastShare * surfaceWeight) {
            const auto weight = static_cast<float>(std::abs(d[a]) * sums[0] / range) + 1e-6F;
            node.faces[face].observe(seen.firstGrey + sums[1] / sums[0], weight, maxWeight);
            observeSurface(node.surfaces.obtain(face), acrossCells(cell, face, depthNoise),
                           depthNoise);
            continue;
        }
        const bool looksAway = eye && !(side > 0 ? (*eye)[a] > cell[a] + 1 : (*eye)[a] < cell[a]);
        Array3i front = cell;
        front[a] += side;
        if (looksAway || isHit(front)) continue;
        const auto weight = static_cast<float>(std::abs(d[a]) * pixelsPerLength);
        node.faces[face].observe(grey, weight, maxWeight);
    }
    node.surfaces.refreshShown();
}

/// The sums of a face together with those of the cells before and behind it that show the same
/// surface. Noise of depth spreads the points of a surface near the border of two cells over both.
/// The mean of the points in one of them would be displaced to its side.
/// @param depthNoise standard deviation [m]
CellPixels::Sums CellScan::acrossCells(const Array3i& cell, int face, double depthNoise) const {
    const int a = face / 2;
    const auto most = static_cast<float>(kSameSurface * depthNoise / resolution_);
    CellPixels::Sums sum = pixelsOf(cell)->faces[face];
    const CellPixels::Sums own = sum / sum[0];
    for (const int step : {-1, 1}) {
        Array3i other = cell;
        for (int n = 1; n <= kMostAcross; ++n) {
            other[a] += step;
            const CellPixels* pixels = pixelsOf(other);
            if (pixels == nullptr || pixels->faces[face][0] == 0.F) break;
            CellPixels::Sums beside = pixels->faces[face];
            beside[2 + a] += static_cast<float>(step * n) * beside[0];  // from the cell's centre
            const float distance =                                      // along the normal
                own[5] * (beside[2] / beside[0] - own[2]) +
                own[6] * (beside[3] / beside[0] - own[3]) +
                own[7] * (beside[4] / beside[0] - own[4]);
            if (std::abs(distance) > most) break;
            sum += beside;
        }
    }
    return sum;
}

std::uint64_t CellScan::crossedInBrick(const Array3i& corner) const {
    std::uint64_t bits = 0;
    for (unsigned z = 0; z < 4; ++z) {
        for (unsigned y = 0; y < 4; ++y) {
            std::uint32_t row = 0;  // four cells along x
            std::memcpy(&row, &memory_.crossed[place(corner) + y * stride_[1] + z * stride_[2]], 4);
            const std::uint64_t spread =
                (row & 1U) | (row >> 7U & 2U) | (row >> 8U & 0x100U) | (row >> 15U & 0x200U);
            bits |= spread << brickBit(0, y, z);
        }
    }
    return bits;
}

/// Sorted by z, then y, then x.
std::vector<BrickObservation> CellScan::observedBricks() const {
    std::vector<BrickObservation> observed;
    std::size_t brick = 0;
    for (int z = 0; z < bricks_.z(); ++z) {
        for (int y = 0; y < bricks_.y(); ++y) {
            for (int x = 0; x < bricks_.x(); ++x, ++brick) {
                const Array3i corner = first_ + 4 * Array3i(x, y, z);
                const std::uint64_t missed = crossedInBrick(corner), hit = hitInBrick(brick);
                if ((missed | hit) == 0) continue;
                const auto at = (corner + kKeyOfZero).cast<octomap::key_type>().eval();
                observed.push_back({{at.x(), at.y(), at.z()}, missed & ~hit, hit});
            }
        }
    }
    return observed;
}

/// In the index of CellScan, where keys have no offset.
Array3i CellScan::cellAt(const BrickObservation& brick, unsigned bit) {
    const int b = static_cast<int>(bit);
    return Array3i(brick.corner[0], brick.corner[1], brick.corner[2]) - kKeyOfZero +
           Array3i((b & 1) | (b >> 2 & 2), (b >> 1 & 1) | (b >> 3 & 2),
                   (b >> 2 & 1) | (b >> 4 & 2));
}

/// Leaves unknown cells unknown whose centres are not seen through. Of a cell with a surface inside
/// rays cross the part in front, and errors of the pose show the surface a little inside the next
/// cells.
void CellScan::keepUnknown(const TexturedOcTree& map, const PointCheck& seesThrough,
                           std::vector<BrickObservation>& bricks) {
    for (BrickObservation& brick : bricks) {
        if (brick.missed == 0) continue;
        const std::uint64_t known = knownCells(map, cellAt(brick, 0) / 4);
        for (std::uint64_t rest = brick.missed & ~known; rest != 0; rest &= rest - 1) {
            const auto bit = static_cast<unsigned>(std::countr_zero(rest));
            if (seesThrough(cellAt(brick, bit).cast<double>() + 0.5)) continue;
            brick.missed &= ~(std::uint64_t{1} << bit);
        }
    }
}

MapChange CellScan::apply(TexturedOcTree& map, const std::optional<Vector3d>& eye,
                          const FusionOptions& options, const DepthChecks& depth) const {
    std::vector<BrickObservation> bricks = observedBricks();
    if (depth.seesThrough) keepUnknown(map, depth.seesThrough, bricks);
    const auto texture = [&](TexturedOcTreeNode& node, const BrickObservation& brick,
                             unsigned bit) {
        const Array3i cell = cellAt(brick, bit);
        observeFaces(node, cell, *pixelsOf(cell), eye, options);
    };
    const auto keep = [&](const TexturedOcTreeNode& node, const BrickObservation& brick,
                          unsigned bit) {
        const Vector3d centre = cellAt(brick, bit).cast<double>() + 0.5;
        for (unsigned f = 0; depth.remains && f < 6; ++f) {
            const FaceSurface& surface = node.surfaces[f];
            if (!surface.observed()) continue;
            if (depth.remains(centre + surface.meanPoint().cast<double>())) return true;
        }
        return false;
    };
    for (std::span<BrickObservation> rest = bricks; !rest.empty();) {
        throwIfStopped(options.isStopped);
        const std::size_t count = std::min(kBricksAtOnce, rest.size());
        map.updateBricks(rest.first(count), texture, keep);
        rest = rest.subspan(count);
    }

    MapChange change;
    change.resolution = map.getResolution();
    for (const BrickObservation& brick : bricks) {
        const Array3i index = cellAt(brick, 0) / 4;
        const BrickChange& changed = brick.change;
        if (changed.occupancy) change.occupancy.push_back(index);
        if (!changed.texture) continue;
        change.anyTexture.push_back(index);
        const float drift = std::max(share(changed.greyChange, options.greyTolerance),
                                     share(changed.surfaceMotion, options.surfaceTolerance));
        if (map.accumulateDrift(brick.corner, drift)) change.texture.push_back(index);
    }
    return change;
}

}  // namespace photonav
