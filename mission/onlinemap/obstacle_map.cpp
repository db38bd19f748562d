// SPDX-License-Identifier: BSD-3-Clause
#include "onlinemap/obstacle_map.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "geometry/segment.hpp"
#include "map/brick_leaves.hpp"
#include "onlinemap/cell_states.hpp"
#include "onlinemap/obstacles_in_view.hpp"

namespace photonav {
namespace {

constexpr int kEdge = MapChange::kBrickEdge;
constexpr double kBelow = 3., kAbove = 1.;  // heights outside the bounds that matter [m]

/// The wall in a column of cells, from below up to the last cell that was added.
class WallInColumn {
  public:
    /// How many cells make a wall, and how many free ones in a row do not end it: a ray to a place
    /// beside it clears some, at its top where the view ends as well.
    struct Sizes {
        int wall, hole;
        explicit Sizes(double cell)
            : wall(wallCells(cell)), hole(cellsOver(kSurfaceBeside, cell)) {}
    };

    void add(CellState state, const Sizes& sizes) {
        if (state == CellState::free) ++free_;
        if (state != CellState::occupied) return;
        if (free_ > sizes.hole) cells_ = 0;
        free_ = 0;
        ++cells_;
    }
    /// Whether unknown cells right above belong to it.
    bool goesOn(const Sizes& sizes) const { return free_ <= sizes.hole && cells_ >= sizes.wall; }

  private:
    int cells_ = 0;  // that are occupied, with no more than a hole between two
    int free_ = 0;   // above the last of them
};

/// Whether a cell has to be set to become occupied or free. With optimistic plans an unknown cell
/// counts as free and stays unknown.
bool differs(CellState before, bool isOccupied, UnknownSpace unknown) {
    if (before != CellState::unknown) return (before == CellState::occupied) != isOccupied;
    return isOccupied || unknown == UnknownSpace::pessimistic;
}

octomap::OcTreeKey keyOfCell(int x, int y, int z) {
    const auto key = [](int index) { return static_cast<octomap::key_type>(index + kKeyOfZero); };
    return {key(x), key(y), key(z)};
}

/// Height of the lowest surfaces in view: a twentieth of the pixels is lower [m].
double floorOf(const View& image, const Camera& camera, const Pose& T_w_c) {
    constexpr unsigned kPixelStep = 4;
    std::vector<double> heights;
    for (unsigned v = 0; v < camera.height; v += kPixelStep) {
        for (unsigned u = 0; u < camera.width; u += kPixelStep) {
            const float z = image.depth[v][u];
            if (z > 0.F) heights.push_back((T_w_c * camera.unproject(u, v, z)).z());
        }
    }
    if (heights.empty()) return T_w_c.translation().z();
    const auto low = heights.begin() + static_cast<std::ptrdiff_t>(heights.size() / 20);
    std::nth_element(heights.begin(), low, heights.end());
    return *low;
}

/// Whether a point is in the image, and a surface is seen in front of it.
bool isHidden(const View& image, const Camera& camera, const Eigen::Vector3d& p_c, double margin) {
    if (p_c.z() <= margin) return false;
    const Eigen::Vector2d pixel = camera.project(p_c);
    if (!(pixel.x() >= 0. && pixel.y() >= 0. && pixel.x() <= camera.width - 1. &&
          pixel.y() <= camera.height - 1.)) {
        return false;
    }
    const auto u = static_cast<unsigned>(std::lround(pixel.x()));
    const auto v = static_cast<unsigned>(std::lround(pixel.y()));
    const float z = image.depth[v][u];
    return z > 0.F && z < p_c.z() - margin;
}

}  // namespace

ObstacleMap::ObstacleMap(double resolution, const Eigen::AlignedBox3d& bounds, UnknownSpace unknown)
    : cells_(std::make_shared<TexturedOcTree>(resolution)), unknown_(unknown) {
    const double brick = kEdge * resolution;
    lowest_ = static_cast<int>(std::floor((bounds.min().z() - kBelow) / brick));
    highest_ = static_cast<int>(std::floor((bounds.max().z() + kAbove) / brick));
}

/// @return whether this changed anything
bool ObstacleMap::set(const octomap::OcTreeKey& key, bool isOccupied) {
    const CellStates::Brick before = CellStates::brickOf(*cells_, brickOf(key));
    if (!differs(before.at(key), isOccupied, unknown_)) return false;
    store(key, isOccupied);
    return true;
}

void ObstacleMap::store(const octomap::OcTreeKey& key, bool isOccupied) {
    const float value =
        isOccupied ? cells_->getClampingThresMaxLog() : cells_->getClampingThresMinLog();
    cells_->setNodeValue(key, value, true);
}

/// All heights of the 4 x 4 columns of cells of a column of bricks.
void ObstacleMap::updateColumn(const TexturedOcTree& map, const Eigen::Array2i& column,
                               MapChange& changed) {
    const WallInColumn::Sizes sizes(map.getResolution());
    std::array<WallInColumn, kEdge * kEdge> walls;
    for (int height = lowest_; height <= highest_; ++height) {
        const Eigen::Array3i brick(column.x(), column.y(), height);
        const CellStates::Brick inMap = CellStates::brickOf(map, brick);
        const CellStates::Brick before = CellStates::brickOf(*cells_, brick);
        bool hasChanged = false;
        for (int i = 0; i < kEdge * kEdge * kEdge; ++i) {
            const octomap::OcTreeKey key =
                keyOfCell(kEdge * brick.x() + i % kEdge, kEdge * brick.y() + i / kEdge % kEdge,
                          kEdge * brick.z() + i / (kEdge * kEdge));
            CellState state = inMap.at(key);
            if (state == CellState::free && forgotten_.contains(key)) state = CellState::unknown;
            WallInColumn& wall = walls[i % (kEdge * kEdge)];
            wall.add(state, sizes);
            const bool isUnknown = state == CellState::unknown;
            if (isUnknown && unknown_ == UnknownSpace::pessimistic) continue;
            const bool isOccupied =
                state == CellState::occupied || (isUnknown && wall.goesOn(sizes));
            if (!differs(before.at(key), isOccupied, unknown_)) continue;
            store(key, isOccupied);
            hasChanged = true;
        }
        if (hasChanged) changed.occupancy.push_back(brick);
    }
}

MapChange ObstacleMap::update(const TexturedOcTree& map, const MapChange& change) {
    std::vector<std::pair<int, int>> columns;
    columns.reserve(change.occupancy.size());
    for (const Eigen::Array3i& brick : change.occupancy) columns.emplace_back(brick.x(), brick.y());
    std::sort(columns.begin(), columns.end());
    columns.erase(std::unique(columns.begin(), columns.end()), columns.end());
    MapChange changed;
    changed.resolution = cells_->getResolution();
    for (const auto& [x, y] : columns) updateColumn(map, {x, y}, changed);
    changed.normalize();
    return changed;
}

MapChange ObstacleMap::forget(const TexturedOcTree& map,
                              const std::vector<octomap::OcTreeKey>& cells) {
    MapChange changed;
    for (const octomap::OcTreeKey& key : cells) {
        if (forgotten_.insert(key).second) changed.occupancy.push_back(brickOf(key));
    }
    return update(map, changed);
}

MapChange ObstacleMap::remember(const TexturedOcTree& map, const ImageF& depth,
                                const Camera& camera, const Pose& T_c_w) {
    MapChange changed;
    std::erase_if(forgotten_, [&](const octomap::OcTreeKey& key) {
        const octomap::point3d p_w = map.keyToCoord(key);
        const bool isFree =
            isSeenThrough({p_w.x(), p_w.y(), p_w.z()}, depth, camera, T_c_w, map.getResolution());
        if (isFree) changed.occupancy.push_back(brickOf(key));
        return isFree;
    });
    return update(map, changed);
}

MapChange ObstacleMap::addHidden(const TexturedOcTree& map, const View& image, const Camera& camera,
                                 const Pose& T_c_w, double radius) {
    MapChange changed;
    changed.resolution = cells_->getResolution();
    const double cell = changed.resolution;
    const Pose T_w_c = T_c_w.inverse();
    const Eigen::Vector3d eye = T_w_c.translation();
    const double floor = floorOf(image, camera, T_w_c);
    const int top = (highest_ + 1) * kEdge, side = 2 * cellsOver(kSurfaceBeside, cell) + 1;
    const auto indexOf = [&](double x) { return static_cast<int>(std::floor(x / cell)); };
    const auto isKnown = [&](int x, int y) {
        for (int z = indexOf(eye.z()); z >= indexOf(floor); --z) {
            if (map.search(keyOfCell(x, y, z)) != nullptr) return true;
        }
        return false;
    };
    for (int y = indexOf(eye.y() - radius); y <= indexOf(eye.y() + radius); ++y) {
        for (int x = indexOf(eye.x() - radius); x <= indexOf(eye.x() + radius); ++x) {
            const Eigen::Vector3d onFloor(cell * (x + 0.5), cell * (y + 0.5), floor);
            if (!isHidden(image, camera, T_c_w * onFloor, 2. * cell) || isKnown(x, y)) continue;
            for (int i = 0; i < side * side; ++i) {  // the surface that hides it is beside it
                const int beside = x + i % side - side / 2, before = y + i / side - side / 2;
                for (int z = indexOf(eye.z() - radius); z < top; ++z) {
                    if (!set(keyOfCell(beside, before, z), true)) continue;
                    changed.occupancy.emplace_back(
                        (Eigen::Array3d(beside, before, z) / kEdge).floor().cast<int>());
                }
            }
        }
    }
    changed.normalize();
    return changed;
}

MapChange ObstacleMap::addBody(const TexturedOcTree& map, const Eigen::Vector3d& body_w,
                               const Eigen::Vector3d& ahead_w, double radius) {
    MapChange changed;
    changed.resolution = cells_->getResolution();
    if (unknown_ == UnknownSpace::optimistic) return changed;
    const double cell = changed.resolution;
    const Eigen::Array3d least = body_w.cwiseMin(ahead_w), most = body_w.cwiseMax(ahead_w);
    const Eigen::Array3i low = ((least - radius) / cell).floor().cast<int>();
    const Eigen::Array3i high = ((most + radius) / cell).floor().cast<int>();
    for (int z = low.z(); z <= high.z(); ++z) {
        for (int y = low.y(); y <= high.y(); ++y) {
            for (int x = low.x(); x <= high.x(); ++x) {
                const Eigen::Array3i at(x, y, z);
                const Eigen::Vector3d middle = cell * (at.cast<double>() + 0.5);
                if (distanceToSegment(middle, body_w, ahead_w) > radius + 2. * cell) continue;
                const octomap::OcTreeKey key = keyOfCell(x, y, z);
                if (map.search(key) != nullptr || !set(key, false)) continue;
                changed.occupancy.emplace_back((at.cast<double>() / kEdge).floor().cast<int>());
            }
        }
    }
    changed.normalize();
    return changed;
}

}  // namespace photonav
