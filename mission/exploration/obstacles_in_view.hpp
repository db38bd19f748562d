// SPDX-License-Identifier: BSD-3-Clause
// What one depth image shows to be in the way, whatever the map says.
#pragma once

#include <vector>

#include "map/textured_octree.hpp"
#include "photometry/view.hpp"

namespace photonav {

/// Which obstacles matter.
struct ObstacleRange {
    double distance = 0.;  ///< from the camera, horizontal [m]
    double precise = 0.;   ///< depth that is measured well enough to tell new walls from known ones
                           ///< beside them [m]
    double lowest = 0., highest = 0.;  ///< heights in the world [m]
};

/// Obstacles of one depth image, in cells of the map's size: cells that contain surface points, and
/// those above new walls. A wall is new where the map shows free space for at least four occupied
/// cells of a column, one above the other. The cells above, which the map may know to be free as
/// well, then count as occupied until one that this image shows to be free: a camera that looks
/// down does not see how high the wall is.
///
/// The map needs several images before a free cell becomes occupied; this needs one.
class ObstaclesInView {
  public:
    ObstaclesInView() = default;  ///< none
    /// @param depth [m]; 0: not measured; empty: no obstacles
    /// @param map before this image was fused
    ObstaclesInView(const ImageF& depth, const Camera& camera, const Pose& T_c_w,
                    const TexturedOcTree& map, const ObstacleRange& range);

    /// Distance of a place to the obstacles [m]: to the nearest cell but two, as single cells may
    /// be errors of the sensor; infinite without any.
    double clearance(const Eigen::Vector3d& p_w) const;

    /// Whether a body on a way would come nearer to an obstacle than `radius`, or, where it is
    /// nearer already, than it is.
    bool isOn(const std::vector<Eigen::Vector3d>& way, double radius) const;

    /// Places on new walls, one of each column.
    const std::vector<Eigen::Vector3d>& newWalls() const { return newWalls_; }
    /// The cells above new walls.
    const std::vector<octomap::OcTreeKey>& aboveNewWalls() const { return above_; }

  private:
    double cell_ = 0.;                       // edge [m]
    std::vector<Eigen::Vector3d> occupied_;  // middles of cells in w
    std::vector<Eigen::Vector3d> newWalls_;
    std::vector<octomap::OcTreeKey> above_;
};

/// Whether a depth image shows a surface behind a place.
bool isSeenThrough(const Eigen::Vector3d& p_w, const ImageF& depth, const Camera& camera,
                   const Pose& T_c_w, double margin);

}  // namespace photonav
