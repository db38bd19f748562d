// SPDX-License-Identifier: BSD-3-Clause
// A world whose walls and textures change, and problems in it.
#pragma once

#include "map/distance_map.hpp"
#include "planning/fixture.hpp"
#include "render/voxel_renderer.hpp"

namespace photonav::test {

/// Walls in a textured octree, and the clearance between them.
class ChangingWorld {
  public:
    explicit ChangingWorld(const Eigen::AlignedBox3d& bounds) : bounds_(bounds) {}

    /// Makes all cells in a box occupied or free.
    MapChange fill(const Eigen::AlignedBox3d& box, bool isOccupied) {
        MapChange change{.resolution = map_.getResolution()};
        const double cell = map_.getResolution();
        for (double z = box.min().z() + cell / 2; z < box.max().z(); z += cell) {
            for (double y = box.min().y() + cell / 2; y < box.max().y(); y += cell) {
                for (double x = box.min().x() + cell / 2; x < box.max().x(); x += cell) {
                    const octomap::OcTreeKey key = map_.coordToKey(x, y, z);
                    const auto* node = map_.search(key);
                    if (node != nullptr && map_.isNodeOccupied(node) == isOccupied) continue;
                    map_.setNodeValue(key, isOccupied ? 1.F : -1.F);
                    change.occupancy.push_back(brickOf(key));
                }
            }
        }
        change.normalize();
        clearance_ = freshClearance();
        return change;
    }

    /// Paints cells of the floor: random greys, or one grey for all.
    template <typename Grey>
    MapChange paintFloor(const Eigen::AlignedBox2d& area, const Grey& grey) {
        MapChange change{.resolution = map_.getResolution()};
        const double cell = map_.getResolution();
        for (double y = area.min().y() + cell / 2; y < area.max().y(); y += cell) {
            for (double x = area.min().x() + cell / 2; x < area.max().x(); x += cell) {
                const octomap::OcTreeKey key = map_.coordToKey(x, y, -cell / 2);
                map_.setNodeValue(key, 1.F, true)->faces[5] = {grey(), 1.F};
                change.texture.push_back(brickOf(key));
            }
        }
        map_.updateInnerOccupancy();
        change.normalize();
        change.anyTexture = change.texture;
        return change;
    }

    std::shared_ptr<const ViewSource> freshViews() const {
        return std::make_shared<VoxelRenderer>(map_, UnknownPolicy::free);
    }

    DistanceMap freshClearance() const {
        return {map_, bounds_, {.maxDistance = 1., .unknown = UnknownPolicy::free}};
    }

    /// Reads the clearance of the map as it is when it is asked.
    Clearance clearance() const {
        return [this](const Eigen::Vector3d& p) { return clearance_.clearance(p); };
    }

  private:
    static Eigen::Array3i brickOf(const octomap::OcTreeKey& key) {
        const Eigen::Array3i cell(key[0], key[1], key[2]);
        return (cell - kKeyOfZero).unaryExpr([](int i) { return i >> 2; });
    }

    Eigen::AlignedBox3d bounds_;
    TexturedOcTree map_{0.2};
    DistanceMap clearance_;
};

enum class SceneKind { flat, withHeading, overTexture };

inline const Eigen::AlignedBox2d kFloor(Eigen::Vector2d(-2., -2.), Eigen::Vector2d(10., 10.));

inline Problem problemIn(SceneKind scene) {
    Problem problem;
    problem.start = {1., 1., 2.};
    problem.goal = {6.6, 7., 2.};
    problem.bounds = box({0, 0, 2}, {8, 8, 2});
    if (scene == SceneKind::withHeading) {
        problem.kind = StateKind::positionYaw;
        problem.bounds = box({0, 0, 1}, {8, 8, 3});
    }
    return problem;
}

}  // namespace photonav::test
