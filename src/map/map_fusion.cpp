// SPDX-License-Identifier: BSD-3-Clause
#include "map/map_fusion.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <stdexcept>
#include <utility>

#include "map/depth_normals.hpp"

namespace photonav {
namespace {

using Eigen::Array3i;
using Eigen::Vector3d;

// Cells in the box of one observation. Each takes a byte of scratch memory, and about 18 bytes with
// the map if all are observed: less than 16 GB.
constexpr double kMaxCells = 8.5e8;
constexpr std::int32_t kNoPixels = -1;
constexpr std::size_t kUsualCells = 8192;  // that one view hits

constexpr double kLeastReach = 0.025;  // of the differences for normals [m]

// Faces with a smaller share of their cell's pixels get no surface: scatter of the normals.
constexpr float kLeastShare = 0.15F;
constexpr float kLeastPixel = 0.05F;  // a pixel's share of one face: less is not summed

/// Of the variance of a surface point: of a pixel's depth, as a structured-light or stereo camera
/// has it, and of what all pixels of a view share, the error of the pose.
constexpr double kDepthNoise = 1.5e-3;  // [1/m], times the depth squared
constexpr double kPoseNoise = 3e-3;     // [m]
// Least weight of the past: about as many views of full weight.
constexpr float kMostSurfaceWeight = 50.F / (kPoseNoise * kPoseNoise);

/// The end cell of pixels: their grey values, and sums by the face that their normals point to.
struct CellPixels {
    /// Weight, grey less the first pixel's (what is constant stays so to the bit), point (3),
    /// normal (3).
    using Sums [[gnu::vector_size(32)]] = float;

    double greySum = 0.;
    unsigned count = 0;
    float firstGrey = 0.F;
    std::array<Sums, 6> faces{};

    void add(float grey) {
        if (count == 0) firstGrey = grey;
        greySum += grey;
        ++count;
    }

    /// @param p the pixel's point, from the cell's centre @param n its normal
    void addSurface(const Eigen::Vector3f& p, const Eigen::Vector3f& n, float grey) {
        const Sums pixel{1.F, grey - firstGrey, p.x(), p.y(), p.z(), n.x(), n.y(), n.z()};
        for (int a = 0; a < 3; ++a) {
            const float weight = n[a] * n[a];
            if (weight > kLeastPixel) faces[2 * a + (n[a] > 0.F ? 1 : 0)] += weight * pixel;
        }
    }

    float surfaceWeight() const {
        float sum = 0.F;
        for (const Sums& face : faces) sum += face[0];
        return sum;
    }
};

/// The cells in view: which of them were crossed by a ray, which were hit, and the grey values
/// observed there. A dense box, x fastest, that begins and ends at bricks of 4 x 4 x 4 cells of the
/// octree. Coordinates are in cells, OctoMap's keys less kKeyOfZero.
class Scan {
  public:
    Scan(const Eigen::AlignedBox3d& cells, double resolution)
        : resolution_(resolution),
          first_(cells.min().array().floor().cast<int>() / 4 * 4 - 4),
          bricks_((cells.max().array().floor().cast<int>() - first_) / 4 + 2),
          stride_{1, std::ptrdiff_t{4} * bricks_.x(),
                  std::ptrdiff_t{16} * bricks_.x() * bricks_.y()},
          crossed_(64 * bricks_.cast<std::size_t>().prod(), 0),
          brickPixels_(bricks_.cast<std::size_t>().prod(), kNoPixels) {
        pixels_.reserve(kUsualCells);
    }

    static double cellsNeeded(const Eigen::AlignedBox3d& cells) {
        return (cells.sizes().array() + 12.).prod();
    }

    /// The pixels of an end cell, valid until the next call.
    CellPixels& obtain(const Array3i& cell) {
        std::int32_t& brick = brickPixels_[brickOf(cell)];
        if (brick == kNoPixels) {
            brick = static_cast<std::int32_t>(bricksHit_.size());
            bricksHit_.emplace_back();
        }
        BrickPixels& seen = bricksHit_[brick];
        const unsigned bit = bitOf(cell);
        if ((seen.hit >> bit & 1U) == 0) {
            seen.hit |= 1ULL << bit;
            seen.cells[bit] = static_cast<std::int32_t>(pixels_.size());
            pixels_.emplace_back();
        }
        return pixels_[seen.cells[bit]];
    }

    /// @returns whether the cell was crossed for the first time
    bool cross(const Array3i& cell) { return std::exchange(crossed_[place(cell)], 1) == 0; }

    void addRay(const Vector3d& end) { rayEnds_.push_back(end); }

    /// Crosses the cells from the eye up to, not including, those that hold the ends of the rays.
    void castRays(const Vector3d& eye);

    /// Whether a surface point that rays passed by is where it was, as far as they tell.
    using SurfaceCheck = std::function<bool(const Vector3d& point)>;

    /// @param eye without one, surfaces are seen from all sides
    /// @param remains may be missing: no surface does
    MapChange apply(TexturedOcTree& map, const std::optional<Vector3d>& eye,
                    const FusionOptions& options, const SurfaceCheck& remains = {}) const;

  private:
    struct BrickPixels {
        std::uint64_t hit = 0;
        std::array<std::int32_t, 64> cells;  // index into pixels_ of those that were hit
    };

    std::uint64_t hitInBrick(std::size_t brick) const {
        const std::int32_t index = brickPixels_[brick];
        return index != kNoPixels ? bricksHit_[index].hit : 0;
    }
    bool isHit(const Array3i& cell) const {
        return (hitInBrick(brickOf(cell)) >> bitOf(cell) & 1U) != 0;
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
    void observeFaces(TexturedOcTreeNode& node, const Array3i& cell, const CellPixels& seen,
                      const std::optional<Vector3d>& eye, float maxWeight) const;
    void observeSurface(FaceSurface& surface, const CellPixels::Sums& sums, double range) const;

    double resolution_;
    Array3i first_, bricks_;
    std::array<std::ptrdiff_t, 3> stride_;
    std::vector<std::uint8_t> crossed_;  // per cell; bytes, because setting single bits is slower
    std::vector<std::int32_t> brickPixels_;  // per brick: index into bricksHit_
    std::vector<BrickPixels> bricksHit_;
    std::vector<CellPixels> pixels_;
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
    const float surfaceWeight = seen.surfaceWeight();
    for (int face = 0; face < 6; ++face) {
        const int a = face / 2;
        const int side = face % 2 == 0 ? -1 : 1;
        const CellPixels::Sums& sums = seen.faces[face];
        if (eye && sums[0] > kLeastShare * surfaceWeight) {
            const double range = d.norm();
            const auto weight = static_cast<float>(std::abs(d[a]) * sums[0] / range) + 1e-6F;
            node.faces[face].observe(seen.firstGrey + sums[1] / sums[0], weight, maxWeight);
            observeSurface(node.surfaces.obtain(face), sums, range * resolution_);
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

/// @param range of the cell from the camera [m]
void Scan::observeSurface(FaceSurface& surface, const CellPixels::Sums& sums, double range) const {
    const CellPixels::Sums mean = sums / sums[0];
    const double depthNoise = kDepthNoise * range * range;
    const double variance = depthNoise * depthNoise / sums[0] + kPoseNoise * kPoseNoise;
    surface.observe({mean[2], mean[3], mean[4]}, {mean[5], mean[6], mean[7]},
                    static_cast<float>(1. / variance), kMostSurfaceWeight);
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

/// A change in parts of what is tolerated.
float share(float change, double tolerance) {
    if (change == 0.F) return 0.F;
    return change / std::max(static_cast<float>(tolerance), 1e-30F);
}

MapChange Scan::apply(TexturedOcTree& map, const std::optional<Vector3d>& eye,
                      const FusionOptions& options, const SurfaceCheck& remains) const {
    MapChange change;
    change.resolution = map.getResolution();
    std::size_t brick = 0;
    Array3i corner;
    const auto cellAt = [&](unsigned bit) -> Array3i {
        const int b = static_cast<int>(bit);
        return corner + Array3i((b & 1) | (b >> 2 & 2), (b >> 1 & 1) | (b >> 3 & 2),
                                (b >> 2 & 1) | (b >> 4 & 2));
    };
    const auto texture = [&](TexturedOcTreeNode& node, unsigned bit) {
        const CellPixels& seen = pixels_[bricksHit_[brickPixels_[brick]].cells[bit]];
        observeFaces(node, cellAt(bit), seen, eye, static_cast<float>(options.maxFaceWeight));
    };
    const auto keep = [&](const TexturedOcTreeNode& node, unsigned bit) {
        const Vector3d centre = cellAt(bit).cast<double>() + 0.5;
        for (unsigned f = 0; remains && f < 6; ++f) {
            const FaceSurface& surface = node.surfaces[f];
            if (!surface.observed()) continue;
            if (remains(centre + surface.meanPoint().cast<double>())) return true;
        }
        return false;
    };
    for (int z = 0; z < bricks_.z(); ++z) {
        for (int y = 0; y < bricks_.y(); ++y) {
            for (int x = 0; x < bricks_.x(); ++x, ++brick) {
                corner = first_ + 4 * Array3i(x, y, z);
                const std::uint64_t crossed = crossedInBrick(corner);
                const std::uint64_t hit = hitInBrick(brick);
                if ((crossed | hit) == 0) continue;
                const auto at = (corner + kKeyOfZero).cast<octomap::key_type>().eval();
                const octomap::OcTreeKey key(at.x(), at.y(), at.z());
                const BrickChange changed = map.updateBrick(key, crossed, hit, texture, keep);
                if (changed.occupancy) change.occupancy.push_back(corner / 4);
                if (!changed.texture) continue;
                change.anyTexture.push_back(corner / 4);
                const float drift =
                    std::max(share(changed.greyChange, options.greyTolerance),
                             share(changed.surfaceMotion, options.surfaceTolerance));
                if (map.accumulateDrift(key, drift)) {
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
        const float product = before * after;  // 2 - z / before - z / after, times this
        return before > 0.F && after > 0.F &&
               std::abs(2.F * product - z * (before + after)) > static_cast<float>(jump) * product;
    };
    return (u > 0 && u + 1 < depth.getWidth() && bends(depth[v][u - 1], depth[v][u + 1])) ||
           (v > 0 && v + 1 < depth.getHeight() && bends(depth[v - 1][u], depth[v + 1][u]));
}

/// Rays and points of a pinhole camera in units of cells.
struct CellFrame {
    Eigen::Matrix3d R;  ///< camera to world, metres to cells
    Vector3d eye;
    const Camera& camera;
    double resolution;
    std::vector<Vector3d> columnDirections;  ///< of rays at depth 1, to be added to rowDirection()

    CellFrame(const Camera& cam, const Pose& T_c_w, double cellSize)
        : R(T_c_w.linear().transpose() / cellSize),
          eye(-R * T_c_w.translation()),
          camera(cam),
          resolution(cellSize) {
        for (unsigned u = 0; u < camera.width; ++u) {
            columnDirections.emplace_back((u - camera.cx()) / camera.fx() * R.col(0));
        }
    }

    /// A point in the camera frame [m].
    Vector3d inCamera(const Vector3d& p) const {
        return resolution * resolution * R.transpose() * (p - eye);
    }

    Vector3d rowDirection(unsigned v) const {
        return (v - camera.cy()) / camera.fy() * R.col(1) + R.col(2);
    }

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

/// Whether a surface point is not seen through: in or beside the pixel that it is projected to,
/// some depth is not larger than its own by more than noise, or there is none. (Beside it, since
/// along an outline the pixel may show what is behind, and at a grazing angle depth changes by more
/// than its noise from pixel to pixel.)
bool remains(const ImageF& depth, const CellFrame& frame, const Vector3d& point) {
    const Vector3d p_c = frame.inCamera(point);
    if (p_c.z() <= 0.) return true;
    const Eigen::Vector2d pixel = frame.camera.project(p_c);
    const auto u = std::lround(pixel.x()), v = std::lround(pixel.y());
    if (u < 1 || v < 1 || u + 1 >= depth.getWidth() || v + 1 >= depth.getHeight()) return true;
    const double noise = std::max(0.5 * frame.resolution, 3. * kDepthNoise * p_c.z() * p_c.z());
    for (long j = v - 1; j <= v + 1; ++j) {
        for (long i = u - 1; i <= u + 1; ++i) {
            const float z = depth[static_cast<unsigned>(j)][static_cast<unsigned>(i)];
            if (!(z > p_c.z() + noise)) return true;
        }
    }
    return false;
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
    Scan scan(box, map.getResolution());
    const double reach = std::max(0.5 * map.getResolution(), kLeastReach);
    DepthNormals normals(observed.depth, camera, T_c_w.linear().transpose().cast<float>(), reach,
                         options.depthJump);
    Array3i cell = Array3i::Constant(std::numeric_limits<int>::max());
    CellPixels* pixels = nullptr;  // of the cell: neighbouring pixels often share it
    for (unsigned v = 0; v < camera.height; ++v) {
        if (options.surfaces) normals.computeRow(v);
        const Vector3d row = frame.rowDirection(v);
        for (unsigned u = 0; u < camera.width; ++u) {
            const double z = observed.depth[v][u];
            if (!(z > 0. && z >= options.minRange)) continue;
            if (atDepthEdge(observed.depth, v, u, options.depthJump)) continue;
            const Vector3d ray = frame.columnDirections[u] + row;
            if (z > options.maxRange) {
                const Vector3d end = frame.eye + options.maxRange * ray;
                if (scan.cross(end.array().floor().cast<int>())) scan.addRay(end);
                continue;
            }
            const Vector3d end = frame.eye + z * ray;
            const Array3i endCell = end.array().floor().cast<int>();
            if (pixels == nullptr || (endCell != cell).any()) {
                cell = endCell;
                pixels = &scan.obtain(cell);
                if (pixels->count == 0) scan.addRay(end);
            }
            pixels->add(observed.intensity[v][u]);
            if (options.surfaces) {
                const Vector3d fromCentre = end - (cell.cast<double>() + 0.5).matrix();
                pixels->addSurface(fromCentre.cast<float>(), normals.at(u),
                                   observed.intensity[v][u]);
            }
        }
    }
    scan.castRays(frame.eye);
    return scan.apply(map, frame.eye, options,
                      [&](const Vector3d& point) { return remains(observed.depth, frame, point); });
}

MapChange fuseScan(TexturedOcTree& map, const ScanPoints& points,
                   const std::optional<Vector3d>& scanner, double maxRange) {
    const double toCells = 1. / map.getResolution();
    const auto visitEnds = [&](const auto& visit) {
        points([&](const ScanPoint& point) {
            Vector3d ray = Vector3d::Zero();
            if (scanner) ray = point.p_w - *scanner;
            const double range = ray.norm();
            if (!std::isfinite(range)) throw std::invalid_argument("fuse: a point is too far");
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

    Scan scan(box, map.getResolution());
    visitEnds([&](const Vector3d& end, float grey, bool isSurface) {
        const Array3i cell = end.array().floor().cast<int>();
        bool isFirst = false;
        if (isSurface) {
            CellPixels& pixels = scan.obtain(cell);
            isFirst = pixels.count == 0;
            pixels.add(grey);
        } else {
            isFirst = scan.cross(cell);
        }
        if (isFirst && eye) scan.addRay(end);
    });
    if (eye) scan.castRays(*eye);
    return scan.apply(map, eye, {});
}

}  // namespace photonav
