// SPDX-License-Identifier: BSD-3-Clause
#include "distance_map.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <vector>

namespace photonav {

/// The cells in which obstacles count: those to answer for, and `reach` more on every side.
struct ObstacleCells {
    double resolution;
    int reach;  ///< cells; anything this far is beyond maxDistance
    Eigen::Array3i
        first;  ///< index of the first cell to answer for; its centre is at first + offset
    Eigen::Array3i inner;  ///< number of cells to answer for
    double offset;
    std::vector<std::uint8_t> obstacle;  ///< 1 or 0, of the `outer` cells, x fastest

    Eigen::Array3i outer() const { return inner + 2 * reach; }
    std::uint8_t* row(int y, int z) {
        const auto n = outer();
        return obstacle.data() + (std::size_t(z) * n.y() + y) * n.x();
    }
};

namespace {

constexpr double kMaxBytes = 2e9;
constexpr int kMaxReach = 180;  // 2 * 180^2 still fits 16 bits

/// @param offset centre of the cell with index 0, in cells
ObstacleCells makeCells(const Eigen::AlignedBox3d& bounds, double resolution, double offset,
                        double maxDistance, std::uint8_t value) {
    if (!(resolution > 0.)) throw std::invalid_argument("distance map: resolution not positive");
    if (!(maxDistance > 0.)) throw std::invalid_argument("distance map: maxDistance not positive");
    if (bounds.isEmpty()) throw std::invalid_argument("distance map: empty bounds");
    const auto bytes = [&](double cell) {
        const double margin = 2. * (maxDistance + 2. * cell);
        const Eigen::Array3d inner = bounds.sizes().array() / cell + 2.;
        return 4. * inner.prod() + (inner + margin / cell).prod();
    };
    if (!(bytes(resolution) <= kMaxBytes)) {
        double fits = resolution;
        while (bytes(fits) > kMaxBytes && std::isfinite(fits)) fits *= 1.1;
        throw std::invalid_argument(
            fmt::format("distance map: {:.1f} GB at a resolution of {} m; {:.2g} m would fit, or "
                        "smaller bounds",
                        1e-9 * bytes(resolution), resolution, std::ceil(fits * 100.) / 100.));
    }
    if (maxDistance / resolution > kMaxReach - 1) {
        throw std::invalid_argument(fmt::format(
            "distance map: maxDistance {} m is more than {} cells", maxDistance, kMaxReach - 1));
    }
    ObstacleCells cells;
    cells.resolution = resolution;
    cells.reach = static_cast<int>(std::ceil(maxDistance / resolution + 0.87));  // half a diagonal
    cells.offset = offset;
    const auto cellBelow = [&](const Eigen::Vector3d& p) -> Eigen::Array3i {
        return (p.array() / resolution - offset).floor().cast<int>();
    };
    cells.first = cellBelow(bounds.min());
    cells.inner = cellBelow(bounds.max()) + 2 - cells.first;
    const Eigen::Array3i n = cells.outer();
    cells.obstacle.assign(std::size_t(n.x()) * n.y() * n.z(), value);
    return cells;
}

/// Distance along y to the nearest obstacle of the same column, capped at reach, in place. Two
/// sweeps, each vectorised over x.
void distanceAlongY(ObstacleCells& cells) {
    const Eigen::Array3i n = cells.outer();
    const auto cap = static_cast<std::uint8_t>(cells.reach);
    const auto relax = [&](std::uint8_t* row, const std::uint8_t* neighbour) {
        for (int x = 0; x < n.x(); ++x) {
            const auto viaNeighbour = static_cast<std::uint8_t>(neighbour[x] + 1);
            row[x] = std::min(row[x], viaNeighbour);
        }
    };
    for (int z = 0; z < n.z(); ++z) {
        std::uint8_t* slab = cells.row(0, z);
        const std::ptrdiff_t slabSize = std::ptrdiff_t(n.x()) * n.y();
        for (std::ptrdiff_t i = 0; i < slabSize; ++i) slab[i] = slab[i] != 0 ? 0 : cap;
        for (int y = 1; y < n.y(); ++y) relax(cells.row(y, z), cells.row(y - 1, z));
        for (int y = n.y() - 2; y >= 0; --y) relax(cells.row(y, z), cells.row(y + 1, z));
    }
}

constexpr int kBlock = 64;

/// out[x] = min over |k| < reach of in[x + k * stride] + k^2 for one block of x: the lower envelope
/// of parabolas of Felzenszwalb and Huttenlocher (Distance Transforms of Sampled Functions, 2012),
/// which for a small cap is fastest by trying all. Stops when no further k can improve.
void lowerEnvelope(const std::uint16_t* in, std::ptrdiff_t stride, int reach, std::uint16_t* out) {
    std::uint16_t best[kBlock];
    std::copy_n(in, kBlock, best);
    for (int k = 1; k < reach; ++k) {
        const auto square = static_cast<std::uint16_t>(k * k);
        const std::uint16_t* below = in - k * stride;
        const std::uint16_t* above = in + k * stride;
        std::uint16_t worst = 0;
        for (int x = 0; x < kBlock; ++x) {
            const auto near = std::min(below[x], above[x]);
            best[x] = std::min(best[x], static_cast<std::uint16_t>(near + square));
            worst = std::max(worst, best[x]);
        }
        if (worst <= (k + 1) * (k + 1)) break;
    }
    std::copy_n(best, kBlock, out);
}

int roundedUp(int n) { return (n + kBlock - 1) / kBlock * kBlock; }

/// A lower bound of the distance from a cell's centre to all obstacle cells, by the squared
/// distance to the nearest obstacle's centre, all in cells. That square does not say where the cell
/// lies: the least is taken over the cells at this or any larger distance between centres.
std::vector<float> leastDistances(int reach) {
    const int most = reach + 2;  // beyond, every cell is farther than what is asked for
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

/// Squared distances of one x-z plane: reads column distances, writes clearances.
class PlaneTransform {
  public:
    PlaneTransform(const ObstacleCells& cells, double maxDistance)
        : reach_(cells.reach),
          inner_(cells.inner),
          pitch_(roundedUp(cells.inner.x()) + 2 * cells.reach + kBlock),
          squares_(std::size_t(pitch_) * cells.outer().z(), cap()),
          row_(pitch_, cap()),
          clearance_(cap() + 1) {
        const std::vector<float> least = leastDistances(reach_);
        for (std::size_t i = 0; i < clearance_.size(); ++i) {
            clearance_[i] = static_cast<float>(std::min(least[i] * cells.resolution, maxDistance));
        }
    }

    /// @param y row among the outer cells; fills row y - reach of the grid
    void run(ObstacleCells& cells, int y, std::vector<float>& grid) {
        const Eigen::Array3i outer = cells.outer();
        for (int z = 0; z < outer.z(); ++z) {
            const std::uint8_t* distance = cells.row(y, z);
            std::uint16_t* squares = squares_.data() + std::size_t(z) * pitch_;
            for (int x = 0; x < outer.x(); ++x) {
                squares[x] = static_cast<std::uint16_t>(distance[x] * distance[x]);
            }
        }
        std::uint16_t out[kBlock];
        for (int z = 0; z < inner_.z(); ++z) {
            const std::uint16_t* centre = squares_.data() + std::size_t(z + reach_) * pitch_;
            for (int x = 0; x < outer.x(); x += kBlock) {
                lowerEnvelope(centre + x, pitch_, reach_, row_.data() + x);
            }
            float* result = grid.data() + (std::size_t(z) * inner_.y() + (y - reach_)) * inner_.x();
            for (int x = 0; x < inner_.x(); x += kBlock) {
                lowerEnvelope(row_.data() + reach_ + x, 1, reach_, out);
                const int n = std::min(kBlock, inner_.x() - x);
                for (int i = 0; i < n; ++i) result[x + i] = clearance_[std::min(out[i], cap())];
            }
        }
    }

  private:
    std::uint16_t cap() const { return static_cast<std::uint16_t>(reach_ * reach_); }

    int reach_;
    Eigen::Array3i inner_;
    int pitch_;                           ///< row length with room for whole blocks
    std::vector<std::uint16_t> squares_;  ///< rows of constant z
    std::vector<std::uint16_t> row_;
    std::vector<float> clearance_;  ///< by squared distance in cells
};

std::vector<float> clearanceGrid(ObstacleCells& cells, double maxDistance) {
    if (std::find(cells.obstacle.begin(), cells.obstacle.end(), 1) == cells.obstacle.end()) {
        return {};
    }
    distanceAlongY(cells);
    std::vector<float> grid(std::size_t(cells.inner.x()) * cells.inner.y() * cells.inner.z());
    PlaneTransform plane(cells, maxDistance);
    for (int y = 0; y < cells.inner.y(); ++y) plane.run(cells, y + cells.reach, grid);
    return grid;
}

/// Sets the part of [first, last) (cell indices) that lies within the outer cells.
void fillBox(ObstacleCells& cells, const Eigen::Array3i& first, const Eigen::Array3i& last,
             std::uint8_t value) {
    const Eigen::Array3i origin = cells.first - cells.reach;
    const Eigen::Array3i from = (first - origin).max(0);
    const Eigen::Array3i to = (last - origin).min(cells.outer());
    if ((from >= to).any()) return;
    for (int z = from.z(); z < to.z(); ++z) {
        for (int y = from.y(); y < to.y(); ++y) {
            std::fill(cells.row(y, z) + from.x(), cells.row(y, z) + to.x(), value);
        }
    }
}

/// Marks the leaves below a node whose first cell is `first`, at a height above the finest level.
void markNode(const TexturedOcTree& map, const TexturedOcTreeNode* node,
              const Eigen::Array3i& first, int height, ObstacleCells& cells) {
    const int size = 1 << height;
    const Eigen::Array3i origin = cells.first - cells.reach;
    if ((first + size <= origin).any() || (first >= origin + cells.outer()).any()) return;
    if (!map.nodeHasChildren(node)) {
        fillBox(cells, first, first + size, map.isNodeOccupied(node) ? 1 : 0);
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
void markTriangle(const std::array<Eigen::Vector3d, 3>& corners, ObstacleCells& cells) {
    const Eigen::Vector3d normal = (corners[1] - corners[0]).cross(corners[2] - corners[0]);
    int w = 0;
    normal.cwiseAbs().maxCoeff(&w);
    const int u = (w + 1) % 3;
    const int v = (w + 2) % 3;
    const Eigen::Array3i origin = cells.first - cells.reach;
    Eigen::Array3d low = corners[0];
    Eigen::Array3d high = corners[0];
    for (const auto& corner : corners) {
        low = low.min(corner.array());
        high = high.max(corner.array());
    }
    const Eigen::Array3d outerEnd = (origin + cells.outer()).cast<double>();
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
            fillBox(cells, first, last, 1);
        }
    }
}

/// Whether p lies in a convex polygon.
bool isInside(const Eigen::Vector2d& p, const std::vector<Eigen::Vector2d>& polygon) {
    bool left = false, right = false;
    for (std::size_t i = 0; i < polygon.size(); ++i) {
        const Eigen::Vector2d side = polygon[(i + 1) % polygon.size()] - polygon[i];
        const Eigen::Vector2d to = p - polygon[i];
        const double area = side.x() * to.y() - side.y() * to.x();
        left = left || area > 0.;
        right = right || area < 0.;
    }
    return !(left && right);
}

/// Marks the cells whose centre is in a prism; cell i has its centre at i times the resolution.
void markPrism(const Prism& prism, ObstacleCells& cells) {
    Eigen::AlignedBox2d around;
    for (const auto& corner : prism.footprint) around.extend(corner);
    const auto firstAt = [&](double x) {
        return static_cast<int>(std::ceil(std::clamp(x / cells.resolution, -1e9, 1e9)));
    };
    const Eigen::Array3i origin = cells.first - cells.reach;
    const Eigen::Array3i end = origin + cells.outer();
    const int lowest = firstAt(prism.low), above = firstAt(prism.high);
    for (int y = std::max(firstAt(around.min().y()), origin.y());
         y < end.y() && y * cells.resolution <= around.max().y(); ++y) {
        for (int x = std::max(firstAt(around.min().x()), origin.x());
             x < end.x() && x * cells.resolution <= around.max().x(); ++x) {
            if (!isInside({x * cells.resolution, y * cells.resolution}, prism.footprint)) continue;
            fillBox(cells, {x, y, lowest}, {x + 1, y + 1, above}, 1);
        }
    }
}

}  // namespace

DistanceMap::DistanceMap(const TexturedOcTree& map, const Eigen::AlignedBox3d& bounds,
                         const Options& options)
    : maxDistance_(options.maxDistance) {
    const bool unknownIsObstacle = options.unknown == UnknownPolicy::occupied;
    ObstacleCells cells =
        makeCells(bounds, map.getResolution(), 0.5, maxDistance_, unknownIsObstacle ? 1 : 0);
    const int height = static_cast<int>(map.getTreeDepth());
    const Eigen::Array3i first = Eigen::Array3i::Constant(-(1 << (height - 1)));
    if (map.getRoot() != nullptr) markNode(map, map.getRoot(), first, height, cells);
    compute(cells);
}

DistanceMap::DistanceMap(const Scene& scene, double resolution, const Eigen::AlignedBox3d& bounds,
                         const Options& options)
    : maxDistance_(options.maxDistance) {
    ObstacleCells cells = makeCells(bounds, resolution, 0., maxDistance_, 0);
    for (const auto& triangle : scene.triangles) {
        std::array<Eigen::Vector3d, 3> corners;  // in cells; cell i is [i, i + 1)
        for (int k = 0; k < 3; ++k) {
            corners[k] = triangle.corners[k].cast<double>() / resolution;
            corners[k].array() += 0.5;
        }
        markTriangle(corners, cells);
    }
    for (const Prism& solid : scene.solids) markPrism(solid, cells);
    compute(cells);
}

void DistanceMap::compute(ObstacleCells& cells) {
    const double resolution = cells.resolution;
    inverseResolution_ = 1. / resolution;
    firstCentre_ = (cells.first.cast<double>() + cells.offset) * resolution;
    lastCorner_ = (cells.inner - 2).cast<double>();
    size_ = cells.inner;
    grid_ = clearanceGrid(cells, maxDistance_);
}

}  // namespace photonav
