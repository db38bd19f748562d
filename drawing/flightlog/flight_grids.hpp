// SPDX-License-Identifier: BSD-3-Clause
// What is free and what informs of the pose at the height of a robot, in the map that it makes.
#pragma once

#include <vector>

#include "exploration/exploration.hpp"
#include "flightlog/flight_log.hpp"

namespace photonav {

/// Follows what has been seen of an area as the map grows.
class SeenGround {
  public:
    /// @param area in x and y [m]
    explicit SeenGround(const Eigen::AlignedBox2d& area) : area_(area) {}

    /// @param change all that changed in the map; @param height of the robot [m]
    void update(const MapChange& change, double height);

    /// Whether anything below the robot's height was seen, within four cells of the map.
    bool isSeen(const Eigen::Vector2d& p_w) const;

  private:
    Eigen::Array2i columnOf(const Eigen::Vector2d& p_w) const;

    Eigen::AlignedBox2d area_;
    double edge_ = 0.;                               // of a column of bricks [m]
    Eigen::Array2i first_ = Eigen::Array2i::Zero();  // column
    Eigen::Array2i size_ = Eigen::Array2i::Zero();   // columns
    std::vector<bool> seen_;                         // columns, x fastest
};

/// ObstacleLevel at the height of the robot, for a picture of `area`.
vpImage<unsigned char> obstacleGrid(const ExplorationMoment& moment, const SeenGround& seen,
                                    const Eigen::AlignedBox2d& area);

/// informationLevel() of views from the robot's height with its present heading. Views are of a
/// quarter of the camera's size, and count as those of the whole camera.
vpImage<unsigned char> informationGrid(const ExplorationMoment& moment, const SeenGround& seen,
                                       const Eigen::AlignedBox2d& area);

}  // namespace photonav
