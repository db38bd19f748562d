// SPDX-License-Identifier: BSD-3-Clause
#include "map_fusion.hpp"

#include <bit>
#include <cmath>
#include <limits>
#include <stdexcept>

namespace photonav {
namespace {

using Eigen::Array3i;
using Eigen::Vector3d;

constexpr int kKeyOfZero = 32768;     // OctoMap's key of the cell that begins at the origin
constexpr double kMaxBricks = 6.4e7;  // 4^3 cells each: 1.5 GB of scratch memory
constexpr std::int32_t kNoPixels = -1;

/// What the pixels that end in a cell have seen.
struct CellPixels {
    double greySum = 0.;
    unsigned count = 0;
};

/// The cells in view, in bricks of 4 x 4 x 4 that match the octree's: which were crossed by a ray,
/// which were hit and what was seen there. Coordinates are in cells, OctoMap's keys less
/// kKeyOfZero.
class Scan {
  public:
    Scan(const Eigen::AlignedBox3d& cells)
        : first_(cells.min().array().floor().cast<int>() / 4 * 4 - 4),
          bricks_((cells.max().array().floor().cast<int>() - first_) / 4 + 2),
          crossed_(size(), 0),
          hit_(size(), 0),
          pixelsOf_(size(), kNoPixels) {}

    static double bricksNeeded(const Eigen::AlignedBox3d& cells) {
        return (cells.sizes().array() / 4. + 3.).prod();
    }

    /// @returns whether the cell was hit for the first time
    bool addPixel(const Array3i& cell, float grey) {
        const auto [brick, bit] = locate(cell);
        if (pixelsOf_[brick] == kNoPixels) {
            pixelsOf_[brick] = static_cast<std::int32_t>(pixels_.size());
            pixels_.emplace_back();
        }
        CellPixels& seen = pixels_[pixelsOf_[brick]][bit];
        seen.greySum += grey;
        hit_[brick] |= 1ULL << bit;
        return seen.count++ == 0;
    }

    bool isCrossed(const Array3i& cell) const {
        const auto [brick, bit] = locate(cell);
        return (crossed_[brick] >> bit & 1U) != 0;
    }

    bool isHit(const Array3i& cell) const {
        const auto [brick, bit] = locate(cell);
        return (hit_[brick] >> bit & 1U) != 0;
    }

    void cross(const Array3i& cell) {
        const auto [brick, bit] = locate(cell);
        crossed_[brick] |= 1ULL << bit;
    }

    void apply(TexturedOcTree& map, const Vector3d& eye) const;

  private:
    struct Place {
        std::size_t brick;
        unsigned bit;
    };
    Place locate(const Array3i& cell) const {
        const Array3i c = cell - first_;
        return {(std::size_t(c.z() >> 2) * bricks_.y() + (c.y() >> 2)) * bricks_.x() + (c.x() >> 2),
                brickBit(c.x(), c.y(), c.z())};
    }
    std::size_t size() const { return std::size_t(bricks_.x()) * bricks_.y() * bricks_.z(); }
    void observeFaces(TexturedOcTreeNode& node, const Array3i& cell, const CellPixels& seen,
                      const Vector3d& eye) const;

    Array3i first_, bricks_;
    std::vector<std::uint64_t> crossed_, hit_;
    std::vector<std::int32_t> pixelsOf_;
    std::vector<std::array<CellPixels, 64>> pixels_;
};

/// Marks the cells from the eye up to, not including, the one that holds `end` (Amanatides & Woo).
void castRay(Scan& scan, const Vector3d& eye, const Vector3d& end) {
    Array3i cell = eye.array().floor().cast<int>();
    const Array3i last = end.array().floor().cast<int>();
    const Vector3d d = end - eye;
    Array3i step;
    Vector3d next, delta;
    for (int a = 0; a < 3; ++a) {
        step[a] = d[a] < 0. ? -1 : 1;
        delta[a] = d[a] == 0. ? std::numeric_limits<double>::infinity() : 1. / std::abs(d[a]);
        const double gap = d[a] < 0. ? eye[a] - cell[a] : cell[a] + 1. - eye[a];
        next[a] = d[a] == 0. ? delta[a] : gap * delta[a];
    }
    for (int n = (last - cell).abs().sum(); n > 0; --n) {
        scan.cross(cell);
        int axis = 0;
        if (next[1] < next[axis]) axis = 1;
        if (next[2] < next[axis]) axis = 2;
        cell[axis] += step[axis];
        next[axis] += delta[axis];
    }
}

void Scan::observeFaces(TexturedOcTreeNode& node, const Array3i& cell, const CellPixels& seen,
                        const Vector3d& eye) const {
    const auto grey = static_cast<float>(seen.greySum / seen.count);
    const Vector3d d = (cell.cast<double>() + 0.5).matrix() - eye;
    const double pixelsPerLength = seen.count / d.norm();
    for (int a = 0; a < 3; ++a) {
        const int side = eye[a] > cell[a] + 1 ? 1 : eye[a] < cell[a] ? -1 : 0;
        Array3i front = cell;
        front[a] += side;
        if (side == 0 || isHit(front)) continue;
        node.faces[2 * a + (side > 0)].observe(
            grey, static_cast<float>(std::abs(d[a]) * pixelsPerLength));
    }
}

void Scan::apply(TexturedOcTree& map, const Vector3d& eye) const {
    std::size_t brick = 0;
    Array3i corner;
    const auto texture = [&](TexturedOcTreeNode& node, unsigned bit) {
        const Array3i inside((bit & 1U) | (bit >> 2U & 2U), (bit >> 1U & 1U) | (bit >> 3U & 2U),
                             (bit >> 2U & 1U) | (bit >> 4U & 2U));
        observeFaces(node, corner + inside, pixels_[pixelsOf_[brick]][bit], eye);
    };
    for (int z = 0; z < bricks_.z(); ++z) {
        for (int y = 0; y < bricks_.y(); ++y) {
            for (int x = 0; x < bricks_.x(); ++x, ++brick) {
                if ((crossed_[brick] | hit_[brick]) == 0) continue;
                corner = first_ + 4 * Array3i(x, y, z);
                const auto key = (corner + kKeyOfZero).cast<octomap::key_type>().eval();
                map.updateBrick({key.x(), key.y(), key.z()}, crossed_[brick], hit_[brick], texture);
            }
        }
    }
}

/// Whether inverse depth bends here: it is linear in the image on a plane.
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
        return eye + R * (z * Vector3d((u - camera.cx()) / camera.fx(),
                                       (v - camera.cy()) / camera.fy(), 1.));
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

}  // namespace

void fuse(TexturedOcTree& map, const View& observed, const Camera& camera, const Pose& T_c_w,
          const FusionOptions& options) {
    checkInput(observed, camera, T_c_w);
    const CellFrame frame(camera, T_c_w, map.getResolution());
    const Eigen::AlignedBox3d box = frame.frustum(farthest(observed.depth, options.maxRange));
    if (!(Scan::bricksNeeded(box) < kMaxBricks) ||
        !(box.min().minCoeff() > 8 - kKeyOfZero && box.max().maxCoeff() < kKeyOfZero - 8)) {
        throw std::invalid_argument("fuse: the space in view is too large for the map's cells");
    }
    Scan scan(box);
    for (unsigned v = 0; v < camera.height; ++v) {
        for (unsigned u = 0; u < camera.width; ++u) {
            const double z = observed.depth[v][u];
            if (!(z > 0. && z >= options.minRange)) continue;
            if (atDepthEdge(observed.depth, v, u, options.depthJump)) continue;
            const Vector3d end = frame.point(u, v, std::min(z, options.maxRange));
            const Array3i cell = end.array().floor().cast<int>();
            const bool first = z > options.maxRange ? !scan.isCrossed(cell)
                                                    : scan.addPixel(cell, observed.intensity[v][u]);
            if (first) castRay(scan, frame.eye, end);
        }
    }
    scan.apply(map, frame.eye);
}

}  // namespace photonav
