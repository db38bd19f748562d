// SPDX-License-Identifier: BSD-3-Clause
// The part of a path that may be flown at once.
#pragma once

#include <functional>
#include <vector>

#include "belief/belief.hpp"
#include "control/route.hpp"

namespace photonav {

/// What is known of the space ahead.
struct SpaceAhead {
    std::function<double(const Eigen::Vector3d& p_w)> clearance;  ///< in the present map [m]
    std::function<bool(const Eigen::Vector3d& p_w)> isSeen;       ///< there or below
    double radius = 0.;                                           ///< that must stay free [m]
    double hidden = 0.;    ///< around the robot, that its tilted camera does not see: a robot that
                           ///< cannot look there flies there all the same [m]
    bool canLook = false;  ///< the robot turns its camera ahead by its heading
};

struct FlyablePart {
    std::vector<PlannedView> plan;  ///< at least two views; the robot stays where they are equal
    bool isWhole = false;           ///< it leads to the end of the path
    bool isBlocked = false;         ///< by an obstacle: the path is out of date
    bool isStopped = false;         ///< the obstacle is right ahead: the robot stays
    bool isBlind = false;           ///< into space that was not seen and cannot be looked at first
};

/// The path up to what was not seen, or up to an obstacle. Where nothing ahead was seen, the robot
/// first turns to look there; a camera that cannot be turned there (it looks down, or the heading
/// is fixed) sees the next step from a short one.
/// @param path from the robot on
FlyablePart flyablePart(const std::vector<BeliefPoint>& path, const SpaceAhead& space);

/// The plan of staying at a pose.
std::vector<PlannedView> hovering(const Pose& T_w_b, const Matrix6& covariance);

}  // namespace photonav
