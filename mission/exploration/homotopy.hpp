// SPDX-License-Identifier: BSD-3-Clause
// On which sides of the obstacles a way leads, and when a flight has decided it.
#pragma once

#include <Eigen/Geometry>
#include <functional>
#include <vector>

#include "exploration/exploration.hpp"

namespace photonav {

/// A way seen from above, as a polygonal line [m].
using GroundTrack = std::vector<Eigen::Vector2d>;

/// The homotopy classes of ways in a known world, seen from above: two ways with common ends are in
/// the same class if one can be moved to the other without crossing an obstacle. (What can be flown
/// over or under separates no ways.) They are told apart by winding numbers around each place of an
/// obstacle. This is exact but for ways that wind around several obstacles to and fro.
class HomotopyClasses {
  public:
    /// @param clearance distance to the nearest obstacle, 0 or less inside [m]
    /// @param radius that the robot needs [m]
    /// @param bounds_w of the robot's position
    HomotopyClasses(const std::function<double(const Eigen::Vector3d& p_w)>& clearance,
                    double radius, const Eigen::AlignedBox3d& bounds_w);

    /// Ends that differ are joined by straight lines.
    bool areSame(const GroundTrack& a, const GroundTrack& b) const;

  private:
    std::vector<Eigen::Vector2d> obstacles_w_;  // places on a grid
};

/// The metres that a flight had flown when it chose the homotopy class of its way: all plans from
/// then on that lead to the goal are in the class of the way flown.
/// @param flight to the goal; plans[i] was made by updates[i]
/// @param T_b_c pose of the camera on the body
/// @return NaN if no plan was in this class [m]
double flownUntilDecided(const ExplorationResult& flight, const Pose& T_b_c,
                         const HomotopyClasses& classes);

}  // namespace photonav
