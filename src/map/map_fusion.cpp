// SPDX-License-Identifier: BSD-3-Clause
#include "map/map_fusion.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <stdexcept>
#include <utility>

namespace photonav {
namespace {

using Eigen::Array3i;
using Eigen::Vector3d;

// Cells in the box of one observation. Each takes a byte of scratch memory, and about 18 bytes with
// the map if all are observed: less than 16 GB.
constexpr double kMaxCells = 8.5e8;
constexpr std::int32_t kNoPixels = -1;

/// Sums over the pixels whose surface point lies in a cell.
struct CellPixels {
    double greySum = 0.;
    unsigned count = 0;
};

/// The cells in view: which of them were crossed by a ray, which were hit, and the grey values
/// observed there. A dense box, x fastest, that begins and ends at bricks of 4 x 4 x 4 cells of the
/// octree. Coordinates are in cells, OctoMap's keys less kKeyOfZero.
class Scan {
  public:
    explicit Scan(const Eigen::AlignedBox3d& cells)
        : first_(cells.min().array().floor().cast<int>() / 4 * 4 - 4),
          bricks_((cells.max().array().floor().cast<int>() - first_) / 4 + 2),
          stride_{1, std::ptrdiff_t{4} * bricks_.x(),
                  std::ptrdiff_t{16} * bricks_.x() * bricks_.y()},
          crossed_(64 * bricks_.cast<std::size_t>().prod(), 0),
          pixelsOf_(bricks_.cast<std::size_t>().prod(), kNoPixels) {}

    static double cellsNeeded(const Eigen::AlignedBox3d& cells) {
        return (cells.sizes().array() + 12.).prod();
    }

    /// @returns whether the cell was hit for the first time
    bool addPixel(const Array3i& cell, float grey) {
        std::int32_t& index = pixelsOf_[brickOf(cell)];
        if (index == kNoPixels) {
            index = static_cast<std::int32_t>(pixels_.size());
            pixels_.emplace_back();
        }
        CellPixels& seen = pixels_[index][bitOf(cell)];
        seen.greySum += grey;
        return seen.count++ == 0;
    }

    /// @returns whether the cell was crossed for the first time
    bool cross(const Array3i& cell) { return std::exchange(crossed_[place(cell)], 1) == 0; }

    void addRay(const Vector3d& end) { rayEnds_.push_back(end); }

    /// Crosses the cells from the eye up to, not including, those that hold the ends of the rays.
    void castRays(const Vector3d& eye);

    /// @param eye without one, surfaces are seen from all sides
    MapChange apply(TexturedOcTree& map, const std::optional<Vector3d>& eye,
                    const FusionOptions& options) const;

  private:
    bool isHit(const Array3i& cell) const {
        const std::int32_t index = pixelsOf_[brickOf(cell)];
        return index != kNoPixels && pixels_[index][bitOf(cell)].count > 0;
    }
    std::size_t brickOf(const Array3i& cell) const {
        const Array3i c = cell - first_;
        return (std::size_t(c.z() >> 2) * bricks_.y() + (c.y() >> 2)) * bricks_.x() + (c.x() >> 2);
    }
    unsigned bitOf(const Array3i& cell) const {  // first_ is a multiple of 4
        return brickBit(cell.x(), cell.y(), cell.z());
    }
    std::ptrdiff_t place(const Array3i& cell) const {
        const Array3i c = cell - first_;
        return c.x() + c.y() * stride_[1] + c.z() * stride_[2];
    }
    std::uint64_t crossedInBrick(const Array3i& corner) const;
    std::uint64_t hitInBrick(std::int32_t index) const;
    void observeFaces(TexturedOcTreeNode& node, const Array3i& cell, const CellPixels& seen,
                      const std::optional<Vector3d>& eye, float maxWeight) const;

    Array3i first_, bricks_;
    std::array<std::ptrdiff_t, 3> stride_;
    std::vector<std::uint8_t> crossed_;   // per cell; bytes, because setting single bits is slower
    std::vector<std::int32_t> pixelsOf_;  // per brick: index into pixels_
    std::vector<std::array<CellPixels, 64>> pixels_;
    std::vector<Vector3d> rayEnds_;
};

/// Amanatides and Woo's traversal, without branches, because the next axis cannot be predicted.
/// Four rays at a time, because each step of a ray depends on the step before.
void Scan::castRays(const Vector3d& eye) {
    constexpr int kLanes = 4;
    using Doubles [[gnu::vector_size(kLanes * 8)]] = double;
    using Places [[gnu::vector_size(kLanes * 8)]] = std::int64_t;
    const Array3i from = eye.array().floor().cast<int>();
    for (std::size_t first = 0; first < rayEnds_.size(); first += kLanes) {
        std::array<Doubles, 3> next{}, delta{};  // in parts of the ray, per axis
        std::array<Places, 3> step{};
        Places left{};  // steps to the cell that holds the end
        const std::size_t rays = std::min<std::size_t>(kLanes, rayEnds_.size() - first);
        for (std::size_t i = 0; i < rays; ++i) {
            const Vector3d& end = rayEnds_[first + i];
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
            for (std::size_t i = 0; i < kLanes; ++i) crossed_[at[i]] = 1;
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

void Scan::observeFaces(TexturedOcTreeNode& node, const Array3i& cell, const CellPixels& seen,
                        const std::optional<Vector3d>& eye, float maxWeight) const {
    const auto grey = static_cast<float>(seen.greySum / seen.count);
    Vector3d d = Vector3d::Ones();
    if (eye) d = (cell.cast<double>() + 0.5).matrix() - *eye;
    const double pixelsPerLength = seen.count / d.norm();
    for (int face = 0; face < 6; ++face) {
        const int a = face / 2;
        const int side = face % 2 == 0 ? -1 : 1;
        const bool looksAway = eye && !(side > 0 ? (*eye)[a] > cell[a] + 1 : (*eye)[a] < cell[a]);
        Array3i front = cell;
        front[a] += side;
        if (looksAway || isHit(front)) continue;
        const auto weight = static_cast<float>(std::abs(d[a]) * pixelsPerLength);
        node.faces[face].observe(grey, weight, maxWeight);
    }
}

std::uint64_t Scan::crossedInBrick(const Array3i& corner) const {
    std::uint64_t bits = 0;
    for (unsigned z = 0; z < 4; ++z) {
        for (unsigned y = 0; y < 4; ++y) {
            std::uint32_t row = 0;  // four cells along x
            std::memcpy(&row, &crossed_[place(corner) + y * stride_[1] + z * stride_[2]], 4);
            const std::uint64_t spread =
                (row & 1U) | (row >> 7U & 2U) | (row >> 8U & 0x100U) | (row >> 15U & 0x200U);
            bits |= spread << brickBit(0, y, z);
        }
    }
    return bits;
}

std::uint64_t Scan::hitInBrick(std::int32_t index) const {
    std::uint64_t bits = 0;
    for (unsigned bit = 0; index != kNoPixels && bit < 64; ++bit) {
        bits |= std::uint64_t{pixels_[index][bit].count > 0} << bit;
    }
    return bits;
}

MapChange Scan::apply(TexturedOcTree& map, const std::optional<Vector3d>& eye,
                      const FusionOptions& options) const {
    MapChange change;
    change.resolution = map.getResolution();
    std::size_t brick = 0;
    Array3i corner;
    const auto texture = [&](TexturedOcTreeNode& node, unsigned bit) {
        const int b = static_cast<int>(bit);
        const Array3i inside((b & 1) | (b >> 2 & 2), (b >> 1 & 1) | (b >> 3 & 2),
                             (b >> 2 & 1) | (b >> 4 & 2));
        observeFaces(node, corner + inside, pixels_[pixelsOf_[brick]][bit], eye,
                     static_cast<float>(options.maxFaceWeight));
    };
    for (int z = 0; z < bricks_.z(); ++z) {
        for (int y = 0; y < bricks_.y(); ++y) {
            for (int x = 0; x < bricks_.x(); ++x, ++brick) {
                corner = first_ + 4 * Array3i(x, y, z);
                const std::uint64_t crossed = crossedInBrick(corner);
                const std::uint64_t hit = hitInBrick(pixelsOf_[brick]);
                if ((crossed | hit) == 0) continue;
                const auto at = (corner + kKeyOfZero).cast<octomap::key_type>().eval();
                const octomap::OcTreeKey key(at.x(), at.y(), at.z());
                const BrickChange changed = map.updateBrick(key, crossed, hit, texture);
                if (changed.occupancy) change.occupancy.push_back(corner / 4);
                if (!changed.texture) continue;
                change.anyTexture.push_back(corner / 4);
                const auto tolerance = static_cast<float>(options.greyTolerance);
                if (map.accumulateDrift(key, changed.greyChange, tolerance)) {
                    change.texture.push_back(corner / 4);
                }
            }
        }
    }
    return change;
}

/// Whether the pixel is at a depth edge: on a plane, inverse depth is linear in the image.
bool atDepthEdge(const ImageF& depth, unsigned v, unsigned u, double jump) {
    const float z = depth[v][u];
    const auto bends = [&](float before, float after) {
        return before > 0.F && after > 0.F && std::abs(2.F - z / before - z / after) > jump;
    };
    return (u > 0 && u + 1 < depth.getWidth() && bends(depth[v][u - 1], depth[v][u + 1])) ||
           (v > 0 && v + 1 < depth.getHeight() && bends(depth[v - 1][u], depth[v + 1][u]));
}

/// Rays and points of a pinhole camera in units of cells.
struct CellFrame {
    Eigen::Matrix3d R;  ///< camera to world, metres to cells
    Vector3d eye;
    const Camera& camera;

    CellFrame(const Camera& cam, const Pose& T_c_w, double resolution)
        : R(T_c_w.linear().transpose() / resolution), eye(-R * T_c_w.translation()), camera(cam) {}

    Vector3d point(double u, double v, double z) const {
        return eye + R * camera.unproject(u, v, z);
    }

    Eigen::AlignedBox3d frustum(double range) const {
        Eigen::AlignedBox3d box(eye);
        for (const double u : {-0.5, camera.width - 0.5}) {
            for (const double v : {-0.5, camera.height - 0.5}) box.extend(point(u, v, range));
        }
        return box;
    }
};

void checkInput(const View& observed, const Camera& camera, const Pose& T_c_w) {
    for (const ImageF* image : {&observed.intensity, &observed.depth}) {
        if (image->getWidth() != camera.width || image->getHeight() != camera.height) {
            throw std::invalid_argument("fuse: image, depth and camera differ in size");
        }
    }
    if (!T_c_w.matrix().allFinite()) throw std::invalid_argument("fuse: the pose is not finite");
}

double farthest(const ImageF& depth, double maxRange) {
    double range = 0.;
    for (unsigned i = 0; i < depth.getSize(); ++i) {
        if (depth.bitmap[i] > range) range = depth.bitmap[i];
    }
    return std::min(range, maxRange);
}

void checkFits(const Eigen::AlignedBox3d& cells) {
    if (Scan::cellsNeeded(cells) < kMaxCells && cells.min().minCoeff() > 8 - kKeyOfZero &&
        cells.max().maxCoeff() < kKeyOfZero - 8) {
        return;
    }
    throw std::invalid_argument("fuse: the space in view is too large for the map's cells");
}

}  // namespace

MapChange fuse(TexturedOcTree& map, const View& observed, const Camera& camera, const Pose& T_c_w,
               const FusionOptions& options) {
    checkInput(observed, camera, T_c_w);
    const CellFrame frame(camera, T_c_w, map.getResolution());
    const Eigen::AlignedBox3d box = frame.frustum(farthest(observed.depth, options.maxRange));
    checkFits(box);
    Scan scan(box);
    for (unsigned v = 0; v < camera.height; ++v) {
        for (unsigned u = 0; u < camera.width; ++u) {
            const double z = observed.depth[v][u];
            if (!(z > 0. && z >= options.minRange)) continue;
            if (atDepthEdge(observed.depth, v, u, options.depthJump)) continue;
            const Vector3d end = frame.point(u, v, std::min(z, options.maxRange));
            const Array3i cell = end.array().floor().cast<int>();
            const bool first = z > options.maxRange ? scan.cross(cell)
                                                    : scan.addPixel(cell, observed.intensity[v][u]);
            if (first) scan.addRay(end);
        }
    }
    scan.castRays(frame.eye);
    return scan.apply(map, frame.eye, options);
}

MapChange fuseScan(TexturedOcTree& map, const ScanPoints& points,
                   const std::optional<Vector3d>& scanner, double maxRange) {
    const double toCells = 1. / map.getResolution();
    const auto visitEnds = [&](const auto& visit) {
        points([&](const ScanPoint& point) {
            Vector3d ray = Vector3d::Zero();
            if (scanner) ray = point.p_w - *scanner;
            const double range = ray.norm();
            if (range <= maxRange)
                visit(Vector3d(toCells * point.p_w), point.grey, true);
            else
                visit(Vector3d(toCells * (*scanner + ray * (maxRange / range))), 0.F, false);
        });
    };
    std::optional<Vector3d> eye;
    if (scanner) eye = toCells * *scanner;
    Eigen::AlignedBox3d box;
    if (eye) box.extend(*eye);
    visitEnds([&](const Vector3d& end, float, bool) { box.extend(end); });
    checkFits(box);

    Scan scan(box);
    visitEnds([&](const Vector3d& end, float grey, bool isSurface) {
        const Array3i cell = end.array().floor().cast<int>();
        const bool first = isSurface ? scan.addPixel(cell, grey) : scan.cross(cell);
        if (first && eye) scan.addRay(end);
    });
    if (eye) scan.castRays(*eye);
    return scan.apply(map, eye, {});
}

}  // namespace photonav
