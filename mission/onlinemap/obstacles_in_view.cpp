// SPDX-License-Identifier: BSD-3-Clause
#include "onlinemap/obstacles_in_view.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <map>
#include <unordered_map>

#include "geometry/constants.hpp"
#include "onlinemap/obstacle_map.hpp"

namespace photonav {
namespace {

constexpr double kLeastDepth = 0.2;   // depths below are not trusted, as in fusion [m]
constexpr double kPixelShare = 0.25;  // of the pixels of a cell that faces the camera
constexpr std::size_t kFewCells = 3;  // as many are an obstacle
constexpr double kWaySlack = 0.02;    // of clearances along a way [m]

using octomap::OcTreeKey;

Eigen::Vector3d middleOf(const TexturedOcTree& map, const OcTreeKey& key) {
    const octomap::point3d middle = map.keyToCoord(key);
    return {middle.x(), middle.y(), middle.z()};
}

/// Cells that contain a quarter as many surface points as one that faces the camera.
std::vector<OcTreeKey> cellsHit(const ImageF& depth, const Camera& camera, const Pose& T_c_w,
                                const TexturedOcTree& map, double range) {
    std::unordered_map<OcTreeKey, double, OcTreeKey::KeyHash> shares;
    const Pose T_w_c = T_c_w.inverse();
    const double edge = map.getResolution() * std::sqrt(camera.fx() * camera.fy());
    for (unsigned v = 0; v < depth.getHeight(); ++v) {
        for (unsigned u = 0; u < depth.getWidth(); ++u) {
            const double z = depth[v][u];
            if (!(z >= kLeastDepth)) continue;
            const Eigen::Vector3d p_w = T_w_c * camera.unproject(u, v, z);
            if ((p_w - T_w_c.translation()).head<2>().norm() > range) continue;
            OcTreeKey key;
            if (!map.coordToKeyChecked(p_w.x(), p_w.y(), p_w.z(), key)) continue;
            shares[key] += std::min(1., z * z / (edge * edge));
        }
    }
    std::vector<OcTreeKey> hit;
    for (const auto& [key, share] : shares) {
        if (share >= kPixelShare) hit.push_back(key);
    }
    return hit;
}

/// Whether the map shows a cell free, and no surface right beside it, where errors of depth or
/// pose would show it.
bool isFreeAround(const CellStates& cells, const OcTreeKey& key) {
    if (!cells.isFree(key)) return false;
    const int reach = cellsOver(kSurfaceBeside, cells.grid().getResolution());
    const int side = 2 * reach + 1;
    for (int i = 0; i < side * side * side; ++i) {
        OcTreeKey beside = key;
        beside[0] = static_cast<octomap::key_type>(beside[0] + i % side - reach);
        beside[1] = static_cast<octomap::key_type>(beside[1] + i / side % side - reach);
        beside[2] = static_cast<octomap::key_type>(beside[2] + i / (side * side) - reach);
        if (cells.isOccupied(beside)) return false;
    }
    return true;
}

bool isHigher(const OcTreeKey& a, const OcTreeKey& b) { return a[2] < b[2]; }

/// Whether the cells of a column that an image hits are a wall. Pixels may be farther apart than
/// cells: the height counts, not the number of cells.
bool isWall(const std::vector<OcTreeKey>& hit, double cell) {
    if (std::ssize(hit) < kLeastWallCells) return false;
    const auto [lowest, highest] = std::minmax_element(hit.begin(), hit.end(), isHigher);
    return (*highest)[2] - (*lowest)[2] + 1 >= wallCells(cell);
}

}  // namespace

bool isSeenThrough(const Eigen::Vector3d& p_w, const ImageF& depth, const Camera& camera,
                   const Pose& T_c_w, double margin) {
    const Eigen::Vector3d p_c = T_c_w * p_w;
    if (!(p_c.z() > 0.)) return false;
    const Eigen::Vector2d pixel = camera.project(p_c);
    const auto u = std::lround(pixel.x()), v = std::lround(pixel.y());
    if (u < 0 || v < 0 || u >= depth.getWidth() || v >= depth.getHeight()) return false;
    return depth[static_cast<unsigned>(v)][static_cast<unsigned>(u)] > p_c.z() + margin;
}

ObstaclesInView::ObstaclesInView(const ImageF& depth, const Camera& camera, const Pose& T_c_w,
                                 const CellStates& cells, const ObstacleRange& range)
    : cell_(cells.grid().getResolution()) {
    const TexturedOcTree& map = cells.grid();
    const auto add = [&](const OcTreeKey& key) {
        const Eigen::Vector3d p_w = middleOf(map, key);
        if (p_w.z() >= range.lowest && p_w.z() <= range.highest) occupied_.push_back(p_w);
    };
    std::map<std::pair<int, int>, std::vector<OcTreeKey>> columns;
    for (const OcTreeKey& key : cellsHit(depth, camera, T_c_w, map, range.distance)) {
        add(key);
        columns[{key[0], key[1]}].push_back(key);
    }
    const auto isFree = [&](const OcTreeKey& key) {
        return isSeenThrough(middleOf(map, key), depth, camera, T_c_w, cell_);
    };
    const auto isNew = [&](const OcTreeKey& key) {
        return (T_c_w * middleOf(map, key)).z() <= range.precise && isFreeAround(cells, key);
    };
    for (auto& [column, keys] : columns) {
        if (!isWall(keys, cell_)) continue;
        std::erase_if(keys, [&](const OcTreeKey& key) { return !isNew(key); });
        if (!isWall(keys, cell_)) continue;
        newWalls_.push_back(middleOf(map, keys.front()));
        OcTreeKey above = *std::max_element(keys.begin(), keys.end(), isHigher);
        while (++above[2], middleOf(map, above).z() <= range.highest && !isFree(above)) {
            add(above);
            above_.push_back(above);
        }
    }
}

double ObstaclesInView::clearance(const Eigen::Vector3d& p_w) const {
    std::array<double, kFewCells> nearest;
    nearest.fill(kInfinity);
    for (const Eigen::Vector3d& middle : occupied_) {
        const double square = (middle - p_w).squaredNorm();
        if (square >= nearest.back()) continue;
        nearest.back() = square;
        std::sort(nearest.begin(), nearest.end());
    }
    return std::sqrt(nearest.back()) - 0.5 * cell_;
}

bool ObstaclesInView::isOn(const std::vector<Eigen::Vector3d>& way, double radius) const {
    if (occupied_.empty() || way.empty()) return false;
    double least = std::min(radius, clearance(way.front())) - kWaySlack;
    for (std::size_t i = 1; i < way.size(); ++i) {
        const Eigen::Vector3d leg = way[i] - way[i - 1];
        const int steps = 1 + static_cast<int>(leg.norm() / cell_);
        for (int k = 1; k <= steps; ++k) {
            const double now = clearance(way[i - 1] + static_cast<double>(k) / steps * leg);
            if (now < least) return true;
            least = std::max(least, std::min(radius, now) - kWaySlack);
        }
    }
    return false;
}

}  // namespace photonav
