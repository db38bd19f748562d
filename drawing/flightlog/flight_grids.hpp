// SPDX-License-Identifier: BSD-3-Clause
// Horizontal grids of obstacles and of the information of views at the robot's height, in the
// robot's own map.
#pragma once

#include <vector>

#include "exploration/exploration.hpp"
#include "flightlog/flight_log.hpp"

namespace photonav {

/// The part of an area that was observed so far.
class SeenGround {
  public:
    /// @param area x and y in the world frame [m]
    explicit SeenGround(const Eigen::AlignedBox2d& area) : area_(area) {}

    /// Marks the columns in which the occupancy of the map changed below a height.
    /// @param change everything that changed in the map since the last call
    /// @param height height of the robot [m]
    void update(const MapChange& change, double height);

    /// Whether anything below the robot's height was observed at a place. Places are distinguished
    /// by columns of four by four cells of the map.
    bool isSeen(const Eigen::Vector2d& p_w) const;

  private:
    Eigen::Array2i columnOf(const Eigen::Vector2d& p_w) const;

    Eigen::AlignedBox2d area_;
    double edge_ = 0.;                               // edge of a column of bricks [m]
    Eigen::Array2i first_ = Eigen::Array2i::Zero();  // index of the first column
    Eigen::Array2i size_ = Eigen::Array2i::Zero();   // numbers of columns
    std::vector<bool> seen_;                         // by column, x fastest
};

/// A picture of `area` with the ObstacleLevel at the robot's height; first row at the largest y.
vpImage<unsigned char> obstacleGrid(const ExplorationMoment& moment, const SeenGround& seen,
                                    const Eigen::AlignedBox2d& area);

/// A picture of `area` with the informationLevel() of views from the robot's height with its
/// present heading; first row at the largest y. To save time, views have half the camera's width
/// and height; their information is scaled to the information of full-size views.
vpImage<unsigned char> informationGrid(const ExplorationMoment& moment, const SeenGround& seen,
                                       const Eigen::AlignedBox2d& area);

}  // namespace photonav
