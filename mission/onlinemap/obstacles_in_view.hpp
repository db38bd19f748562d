// SPDX-License-Identifier: BSD-3-Clause
// Obstacles in a single depth image, for safety before the map shows them.
#pragma once

#include <vector>

#include "onlinemap/cell_states.hpp"
#include "photometry/view.hpp"

namespace photonav {

/// The region in which obstacles are considered.
struct ObstacleRange {
    double distance = 0.;  ///< largest horizontal distance from the camera [m]
    /// Largest depth at which a new wall can be distinguished from a known wall beside it
    /// (kSurfaceBeside, at least a cell) [m]; it follows from the noise of depth.
    double precise = 0.;
    double lowest = 0., highest = 0.;  ///< heights in the world frame [m]
};

/// The obstacles in one depth image, as cells of the map's size: cells that contain surface points,
/// and cells above new walls. A wall is new if cells of a column contain surface points
/// over the height of a wall (wallCells()), but are free in the map, with no surface beside. The
/// cells above a new wall, which the map may show as free, too, count as occupied up to the first
/// one that the image shows to be free: a camera that looks down does not observe how high the wall
/// is.
///
/// The map needs several images before a free cell becomes occupied. This class needs one image.
class ObstaclesInView {
  public:
    ObstaclesInView() = default;  ///< no obstacles
    /// @param depth depth image [m]; 0: not measured
    /// @param cells those of the map before this image is fused
    ObstaclesInView(const ImageF& depth, const Camera& camera, const Pose& T_c_w,
                    const CellStates& cells, const ObstacleRange& range);

    /// Distance from a place to the obstacles [m]. It is measured to the third nearest cell,
    /// because single cells may be errors of the sensor. Infinite with fewer than three cells.
    double clearance(const Eigen::Vector3d& p_w) const;

    /// Whether a body on a path would come nearer to an obstacle than `radius` [m]. If the path
    /// begins nearer than that, whether the body would come nearer than it is at the beginning.
    /// @param way corners of the path, world frame [m]
    bool isOn(const std::vector<Eigen::Vector3d>& way, double radius) const;

    /// Points on new walls, one per column, world frame [m].
    const std::vector<Eigen::Vector3d>& newWalls() const { return newWalls_; }
    /// The cells above new walls that count as occupied.
    const std::vector<octomap::OcTreeKey>& aboveNewWalls() const { return above_; }

  private:
    double cell_ = 0.;                       // edge [m]
    std::vector<Eigen::Vector3d> occupied_;  // centres of cells, world frame [m]
    std::vector<Eigen::Vector3d> newWalls_;
    std::vector<octomap::OcTreeKey> above_;
};

/// Whether a depth image shows a surface more than `margin` [m] behind a place, along the optical
/// axis. False for places outside of the image and for pixels without depth.
bool isSeenThrough(const Eigen::Vector3d& p_w, const ImageF& depth, const Camera& camera,
                   const Pose& T_c_w, double margin);

}  // namespace photonav
