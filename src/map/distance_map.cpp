// SPDX-License-Identifier: BSD-3-Clause
#include "map/distance_map.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <vector>

#include "geometry/convex_polygon.hpp"
#include "map/brick_leaves.hpp"

namespace photonav {

/// The cells in which obstacles matter: the inner cells, whose clearance is computed, and `reach`
/// more cells on every side.
struct ObstacleLayout {
    double resolution;
    double offset;         ///< centre of the cell with index 0, in cells
    int reach;             ///< cells; anything this far is beyond maxDistance
    Eigen::Array3i first;  ///< index of the first inner cell
    Eigen::Array3i inner;  ///< number of inner cells

    Eigen::Array3i origin() const { return first - reach; }  ///< of the outer cells
    Eigen::Array3i outer() const { return inner + 2 * reach; }
};

namespace {

constexpr double kMaxBytes = 3e9;
constexpr int kMaxReach = 180;  // 2 * 180^2 still fits 16 bits

/// Sets obstacles by the index of their cell.
struct ObstacleCells {
    ObstacleLayout layout;
    DistanceTransform& transform;

    void fill(const Eigen::Array3i& from, const Eigen::Array3i& to, bool isObstacle) const {
        transform.set(from - layout.origin(), to - layout.origin(), isObstacle);
    }
};

ObstacleLayout layOutCells(const Eigen::AlignedBox3d& bounds, double resolution, double offset,
                           double maxDistance) {
    if (!(resolution > 0.)) throw std::invalid_argument("distance map: resolution not positive");
    if (!(maxDistance > 0.)) throw std::invalid_argument("distance map: maxDistance not positive");
    if (bounds.isEmpty()) throw std::invalid_argument("distance map: empty bounds");
    const auto bytes = [&](double cell) {
        const Eigen::Array3d inner = bounds.sizes().array() / cell + 2.;
        return 4. * inner.prod() + DistanceTransform::bytes(inner, maxDistance / cell + 2.);
    };
    if (!(bytes(resolution) <= kMaxBytes)) {
        double fits = resolution;
        while (bytes(fits) > kMaxBytes && std::isfinite(fits)) fits *= 1.1;
        throw std::invalid_argument(
            fmt::format("distance map: {:.3g} GB at a resolution of {} m; {:.2g} m would fit, "
                        "or smaller bounds",
                        1e-9 * bytes(resolution), resolution, std::ceil(fits * 100.) / 100.));
    }
    if (maxDistance / resolution > kMaxReach - 1) {
        throw std::invalid_argument(fmt::format(
            "distance map: maxDistance {} m is more than {} cells", maxDistance, kMaxReach - 1));
    }
    ObstacleLayout layout;
    layout.resolution = resolution;
    layout.offset = offset;
    layout.reach = static_cast<int>(std::ceil(maxDistance / resolution + 0.87));  // half a diagonal
    const auto cellBelow = [&](const Eigen::Vector3d& p) -> Eigen::Array3i {
        return (p.array() / resolution - offset).floor().cast<int>();
    };
    layout.first = cellBelow(bounds.min());
    layout.inner = cellBelow(bounds.max()) + 2 - layout.first;
    return layout;
}

/// Lower bound of the distance from a cell centre to the obstacle cells, by the squared distance to
/// the nearest obstacle cell's centre; all in cells. The squared distance does not determine the
/// direction to the obstacle, so that the result is the minimum over all cells whose centres are at
/// this distance or farther.
std::vector<float> minDistances(int reach) {
    const int most = reach + 2;  // cells beyond are farther than the cap
    std::vector<float> least(std::size_t(most) * most + 1, static_cast<float>(reach + 1));
    const auto gap = [](int k) { return std::max(k - 0.5, 0.); };
    for (int x = 1; x <= most; ++x) {
        for (int y = 0; y <= x && x * x + y * y <= most * most; ++y) {
            for (int z = 0; z <= y && x * x + y * y + z * z <= most * most; ++z) {
                float& known = least[x * x + y * y + z * z];
                known = std::min(known, static_cast<float>(std::hypot(gap(x), gap(y), gap(z))));
            }
        }
    }
    for (std::size_t i = least.size() - 1; i > 1; --i)
        least[i - 1] = std::min(least[i - 1], least[i]);
    least[0] = -0.5F;
    return least;
}

/// Clearance [m] by squared distance in cells, the result of a DistanceTransform.
std::vector<float> clearances(const ObstacleLayout& layout, double maxDistance) {
    const std::vector<float> least = minDistances(layout.reach);
    std::vector<float> clearance(std::size_t(layout.reach) * layout.reach + 1);
    for (std::size_t i = 0; i < clearance.size(); ++i) {
        clearance[i] = static_cast<float>(std::min(least[i] * layout.resolution, maxDistance));
    }
    return clearance;
}

/// Marks the leaves below a node whose first cell is `first`, at a height above the finest level.
void markNode(const TexturedOcTree& map, const TexturedOcTreeNode* node,
              const Eigen::Array3i& first, int height, const ObstacleCells& cells) {
    const int size = 1 << height;
    const Eigen::Array3i origin = cells.layout.origin();
    if ((first + size <= origin).any() || (first >= origin + cells.layout.outer()).any()) return;
    if (!map.nodeHasChildren(node)) {
        cells.fill(first, first + size, map.isNodeOccupied(node));
        return;
    }
    for (int i = 0; i < 8; ++i) {
        if (!map.nodeChildExists(node, i)) continue;
        const Eigen::Array3i half(i & 1, (i >> 1) & 1, i >> 2);
        markNode(map, map.getNodeChild(node, i), first + half * (size / 2), height - 1, cells);
    }
}

/// Marks the cells a triangle touches: for every column of cells along the axis closest to the
/// normal whose square overlaps the triangle's outline, the cells its plane crosses in that square
/// (Schwarz and Seidel, "Fast Parallel Surface and Solid Voxelization on GPUs", 2010). In cells.
void markTriangle(const std::array<Eigen::Vector3d, 3>& corners, const ObstacleCells& cells) {
    const Eigen::Vector3d normal = (corners[1] - corners[0]).cross(corners[2] - corners[0]);
    int w = 0;
    normal.cwiseAbs().maxCoeff(&w);
    const int u = (w + 1) % 3;
    const int v = (w + 2) % 3;
    const Eigen::Array3i origin = cells.layout.origin();
    Eigen::Array3d low = corners[0];
    Eigen::Array3d high = corners[0];
    for (const auto& corner : corners) {
        low = low.min(corner.array());
        high = high.max(corner.array());
    }
    const Eigen::Array3d outerEnd = (origin + cells.layout.outer()).cast<double>();
    if ((high < origin.cast<double>()).any() || (low >= outerEnd).any()) return;
    const Eigen::Array3i from = low.max(origin.cast<double>()).floor().cast<int>();
    const Eigen::Array3i to = high.min(outerEnd - 1.).floor().cast<int>();
    const double flip = normal[w] < 0. ? -1. : 1.;

    const auto outside = [&](double a, double b) {  // the square from (a, b) to (a + 1, b + 1)
        for (int e = 0; e < 3; ++e) {
            const Eigen::Vector3d& p = corners[e];
            const Eigen::Vector3d d = flip * (corners[(e + 1) % 3] - p);
            const double atCorner = d[u] * (b - p[v]) - d[v] * (a - p[u]);
            if (atCorner + std::max(d[u], 0.) + std::max(-d[v], 0.) < 0.) return true;
        }
        return false;
    };
    const bool flat = normal[w] == 0.;  // no area: its box, sampled below as one column range
    const double slopeU = flat ? 0. : -normal[u] / normal[w];
    const double slopeV = flat ? 0. : -normal[v] / normal[w];
    for (int b = from[v]; b <= to[v]; ++b) {
        for (int a = from[u]; a <= to[u]; ++a) {
            if (outside(a, b)) continue;
            double least = low[w];
            double most = high[w];
            if (!flat) {
                const double plane =
                    corners[0][w] + slopeU * (a - corners[0][u]) + slopeV * (b - corners[0][v]);
                least = std::max(least, plane + std::min(slopeU, 0.) + std::min(slopeV, 0.));
                most = std::min(most, plane + std::max(slopeU, 0.) + std::max(slopeV, 0.));
            }
            Eigen::Array3i first;
            first[u] = a;
            first[v] = b;
            first[w] = static_cast<int>(std::floor(std::max(least, origin[w] - 1.)));
            Eigen::Array3i last = first + 1;
            last[w] = static_cast<int>(std::floor(std::min(most, outerEnd[w]))) + 1;
            cells.fill(first, last, true);
        }
    }
}

/// Marks the cells whose centre is in a prism; cell i has its centre at i times the resolution.
void markPrism(const Prism& prism, const ObstacleCells& cells) {
    Eigen::AlignedBox2d around;
    for (const auto& corner : prism.footprint) around.extend(corner);
    const auto firstAt = [&](double x) {
        return static_cast<int>(std::ceil(std::clamp(x / cells.layout.resolution, -1e9, 1e9)));
    };
    const Eigen::Array3i origin = cells.layout.origin();
    const Eigen::Array3i end = origin + cells.layout.outer();
    const int lowest = firstAt(prism.low), above = firstAt(prism.high);
    for (int y = std::max(firstAt(around.min().y()), origin.y());
         y < end.y() && y * cells.layout.resolution <= around.max().y(); ++y) {
        for (int x = std::max(firstAt(around.min().x()), origin.x());
             x < end.x() && x * cells.layout.resolution <= around.max().x(); ++x) {
            const Eigen::Vector2d centre(x * cells.layout.resolution, y * cells.layout.resolution);
            if (!isInConvexPolygon(centre, prism.footprint)) continue;
            cells.fill({x, y, lowest}, {x + 1, y + 1, above}, true);
        }
    }
}

}  // namespace

DistanceMap::DistanceMap(const TexturedOcTree& map, const Eigen::AlignedBox3d& bounds,
                         const Options& options)
    : maxDistance_(options.maxDistance),
      unknownIsObstacle_(options.unknown == UnknownPolicy::occupied) {
    const ObstacleLayout layout = layOutCells(bounds, map.getResolution(), 0.5, maxDistance_);
    begin(layout);
    const ObstacleCells cells{layout, transform_};
    if (unknownIsObstacle_) cells.fill(layout.origin(), layout.origin() + layout.outer(), true);
    const int height = static_cast<int>(map.getTreeDepth());
    const Eigen::Array3i first = Eigen::Array3i::Constant(-(1 << (height - 1)));
    if (map.getRoot() != nullptr) markNode(map, map.getRoot(), first, height, cells);
    compute();
}

DistanceMap::DistanceMap(const Scene& scene, double resolution, const Eigen::AlignedBox3d& bounds,
                         const Options& options)
    : maxDistance_(options.maxDistance) {
    const ObstacleLayout layout = layOutCells(bounds, resolution, 0., maxDistance_);
    begin(layout);
    const ObstacleCells cells{layout, transform_};
    for (const auto& triangle : scene.triangles) {
        std::array<Eigen::Vector3d, 3> corners;  // in cells; cell i is [i, i + 1)
        for (int k = 0; k < 3; ++k) {
            corners[k] = triangle.corners[k].cast<double>() / resolution;
            corners[k].array() += 0.5;
        }
        markTriangle(corners, cells);
    }
    for (const Prism& solid : scene.solids) markPrism(solid, cells);
    if (!compute()) grid_ = {};
    transform_ = {};
}

void DistanceMap::begin(const ObstacleLayout& layout) {
    resolution_ = layout.resolution;
    inverseResolution_ = 1. / layout.resolution;
    firstCentre_ = (layout.first.cast<double>() + layout.offset) * layout.resolution;
    lastCorner_ = (layout.inner - 2).cast<double>();
    firstOuter_ = layout.origin();
    size_ = layout.inner;
    transform_ = DistanceTransform(layout.inner, layout.reach);
    clearanceOf_ = clearances(layout, maxDistance_);
    grid_.assign(std::size_t(size_.x()) * size_.y() * size_.z(), clearanceOf_.back());
}

void DistanceMap::update(const TexturedOcTree& map, const MapChange& change) {
    if (transform_.empty()) throw std::invalid_argument("distance map: was not made from a map");
    if (change.occupancy.empty()) return;
    if (change.resolution != map.getResolution() || map.getResolution() != resolution_) {
        throw std::invalid_argument("distance map: the change is of a map of another resolution");
    }
    for (const Eigen::Array3i& brick : change.occupancy) {
        const Eigen::Array3i corner = MapChange::kBrickEdge * brick - firstOuter_;
        if ((corner >= transform_.outer()).any()) continue;
        if ((corner + MapChange::kBrickEdge <= 0).any()) continue;
        std::array<bool, 64> isObstacle;
        isObstacle.fill(unknownIsObstacle_);
        const TexturedOcTreeNode* node = findBrick(map, brick);
        const auto read = [&](const auto& leaf, const Eigen::Array3i& lowest, int edge) {
            const bool isOccupied = map.isNodeOccupied(leaf);
            visitCells(lowest, edge,
                       [&](int x, int y, int z) { isObstacle[16 * z + 4 * y + x] = isOccupied; });
        };
        if (node != nullptr) visitLeaves(map, *node, read);
        transform_.setBlock(corner, isObstacle);
    }
    compute();
}

/// @returns whether any cell changed
bool DistanceMap::compute() {
    bool changed = false;
    transform_.update([&](int x, int y, int z, int n, const std::uint16_t* squares) {
        changed = true;
        float* out = grid_.data() + (std::size_t(z) * size_.y() + y) * size_.x() + x;
        for (int i = 0; i < n; ++i) out[i] = clearanceOf_[squares[i]];
    });
    return changed;
}

}  // namespace photonav
