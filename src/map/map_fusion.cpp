// SPDX-License-Identifier: BSD-3-Clause
#include "map/map_fusion.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <stdexcept>

#include "map/cell_scan.hpp"
#include "map/depth_normals.hpp"

namespace photonav {
namespace {

using Eigen::Array3i;
using Eigen::Vector3d;

// Cells in the box of one observation. Each takes a byte of scratch memory, and about 18 bytes with
// the map if all are observed: less than 16 GB.
constexpr double kMaxCells = 8.5e8;

constexpr double kLeastReach = 0.025;  // of the differences for normals [m]
constexpr double kMostBetween = 16.;   // cells from a pixel to the next, to fill those between

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
    Eigen::Matrix3d R;         ///< camera to world, metres to cells
    Eigen::Matrix3d toCamera;  ///< its inverse
    Vector3d eye;
    const Camera& camera;
    double resolution;
    double longestRay = 1.;                  ///< to depth 1 [m]
    std::vector<Vector3d> columnDirections;  ///< of rays at depth 1, to be added to rowDirection()

    CellFrame(const Camera& cam, const Pose& T_c_w, double cellSize)
        : R(T_c_w.linear().transpose() / cellSize),
          toCamera(cellSize * T_c_w.linear()),
          eye(-R * T_c_w.translation()),
          camera(cam),
          resolution(cellSize) {
        for (const double u : {0., camera.width - 1.}) {
            for (const double v : {0., camera.height - 1.}) {
                longestRay = std::max(longestRay, camera.unproject(u, v).norm());
            }
        }
        for (unsigned u = 0; u < camera.width; ++u) {
            columnDirections.emplace_back((u - camera.cx()) / camera.fx() * R.col(0));
        }
    }

    /// A point in the camera frame [m].
    Vector3d inCamera(const Vector3d& p) const { return toCamera * (p - eye); }

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
bool remains(const ImageF& depth, const CellFrame& frame, double depthNoise,
             const Vector3d& point) {
    const Vector3d p_c = frame.inCamera(point);
    if (p_c.z() <= 0.) return true;
    const Eigen::Vector2d pixel = frame.camera.project(p_c);
    const auto u = std::lround(pixel.x()), v = std::lround(pixel.y());
    if (u < 1 || v < 1 || u + 1 >= depth.getWidth() || v + 1 >= depth.getHeight()) return true;
    const double noise = std::max(0.5 * frame.resolution, 3. * depthNoise * p_c.z() * p_c.z());
    for (long j = v - 1; j <= v + 1; ++j) {
        for (long i = u - 1; i <= u + 1; ++i) {
            const float z = depth[static_cast<unsigned>(j)][static_cast<unsigned>(i)];
            if (!(z > p_c.z() + noise)) return true;
        }
    }
    return false;
}

/// Whether the pixel nearest to the projection of a point shows something farther away.
bool seesThrough(const ImageF& depth, const CellFrame& frame, const Vector3d& point) {
    const Vector3d p_c = frame.inCamera(point);
    if (p_c.z() <= 0.) return false;
    const Eigen::Array2d last(depth.getWidth() - 1., depth.getHeight() - 1.);
    const Eigen::Array2d pixel = frame.camera.project(p_c).array().max(0.).min(last);
    const Eigen::Array2<unsigned> nearest = (pixel + 0.5).cast<unsigned>();
    return depth[nearest.y()][nearest.x()] > p_c.z();
}

/// The surface between a pixel and the three next to it, right and below.
struct Quad {
    std::array<double, 4> inverseDepth;  ///< of (u, v), (u + 1, v), (u, v + 1), (u + 1, v + 1)
    std::array<double, 4> grey;
    int columns, rows;  ///< points that leave no cell out

    static double mean(const std::array<double, 4>& at, double x, double y) {
        return (1. - y) * ((1. - x) * at[0] + x * at[1]) + y * ((1. - x) * at[2] + x * at[3]);
    }
};

/// Where neighbouring pixels of one surface are farther apart than the map's cells; else nothing.
std::optional<Quad> sparseQuad(const View& seen, const CellFrame& frame,
                               const FusionOptions& options, unsigned u, unsigned v) {
    const float z = seen.depth[v][u], right = seen.depth[v][u + 1], below = seen.depth[v + 1][u];
    if (!(z >= options.minRange && z <= options.maxRange)) return {};
    // No more than the distance along the rays and that across them.
    const double across = z / std::min(frame.camera.fx(), frame.camera.fy());
    const double along = std::max(std::abs(right - z), std::abs(below - z));
    if (frame.longestRay * along + across < frame.resolution) return {};
    Quad quad{};
    for (unsigned k = 0; k < 4; ++k) {
        const unsigned column = u + k % 2, row = v + k / 2;
        const float depth = seen.depth[row][column];
        if (!(depth >= options.minRange && depth <= options.maxRange)) return {};
        if (atDepthEdge(seen.depth, row, column, options.depthJump)) return {};
        quad.inverseDepth[k] = 1. / depth;
        quad.grey[k] = seen.intensity[row][column];
    }
    const Vector3d point = frame.point(u, v, z);
    const double toRight = (frame.point(u + 1., v, right) - point).norm();
    const double toBelow = (frame.point(u, v + 1., below) - point).norm();
    if (std::max(toRight, toBelow) > kMostBetween) return {};
    quad.columns = static_cast<int>(std::ceil(toRight));
    quad.rows = static_cast<int>(std::ceil(toBelow));
    return quad;
}

/// Cells that no pixel shows, since pixels of one surface are farther apart than cells, are hit by
/// the surface between the pixels. Far away, and at grazing angles, the surface would otherwise
/// have holes.
void fillBetween(CellScan& scan, const View& seen, const CellFrame& frame,
                 const FusionOptions& options, DepthNormals& normals) {
    for (unsigned v = 1; v + 2 < frame.camera.height; ++v) {
        throwIfStopped(options.isStopped);
        bool hasNormals = false;
        for (unsigned u = 1; u + 2 < frame.camera.width; ++u) {
            const auto quad = sparseQuad(seen, frame, options, u, v);
            if (!quad) continue;
            if (options.surfaces && !hasNormals) normals.computeRow(v);
            hasNormals = true;
            for (int k = 1; k < quad->columns * quad->rows; ++k) {
                const int column = k % quad->columns, row = k / quad->columns;
                const double x = double(column) / quad->columns, y = double(row) / quad->rows;
                const Vector3d end =
                    frame.point(u + x, v + y, 1. / Quad::mean(quad->inverseDepth, x, y));
                const Array3i cell = end.array().floor().cast<int>();
                CellPixels& pixels = scan.obtain(cell);
                if (pixels.count > 0 && !pixels.isBetween) continue;
                if (pixels.count == 0) scan.addRay(end);
                pixels.isBetween = true;
                const auto grey = static_cast<float>(Quad::mean(quad->grey, x, y));
                pixels.add(grey);
                if (!options.surfaces) continue;
                const Vector3d fromCentre = end - (cell.cast<double>() + 0.5).matrix();
                pixels.addSurface(fromCentre.cast<float>(), normals.at(u), grey);
            }
        }
    }
}

double farthest(const ImageF& depth, double maxRange) {
    double range = 0.;
    for (unsigned i = 0; i < depth.getSize(); ++i) {
        if (depth.bitmap[i] > range) range = depth.bitmap[i];
    }
    return std::min(range, maxRange);
}

void checkFits(const Eigen::AlignedBox3d& cells) {
    if (CellScan::cellsNeeded(cells) < kMaxCells && cells.min().minCoeff() > 8 - kKeyOfZero &&
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
    CellScan scan(box, map.getResolution());
    const double reach = std::max(0.5 * map.getResolution(), kLeastReach);
    DepthNormals normals(observed.depth, camera, T_c_w.linear().transpose().cast<float>(), reach,
                         options.depthJump);
    Array3i cell = Array3i::Constant(std::numeric_limits<int>::max());
    CellPixels* pixels = nullptr;  // of the cell: neighbouring pixels often share it
    for (unsigned v = 0; v < camera.height; ++v) {
        throwIfStopped(options.isStopped);
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
    fillBetween(scan, observed, frame, options, normals);
    scan.castRays(frame.eye);
    const auto surfaceRemains = [&](const Vector3d& point) {
        return remains(observed.depth, frame, options.depthNoise, point);
    };
    const auto isFree = [&](const Vector3d& centre) {
        return seesThrough(observed.depth, frame, centre);
    };
    return scan.apply(map, frame.eye, options, {surfaceRemains, isFree});
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

    CellScan scan(box, map.getResolution());
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
