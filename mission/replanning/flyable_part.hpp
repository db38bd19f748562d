// SPDX-License-Identifier: BSD-3-Clause
// The first part of a plan, which may be flown before the map is updated again.
#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "control/route.hpp"

namespace photonav {

/// The robot's present information about the space around it.
struct SpaceAhead {
    std::function<double(const Eigen::Vector3d& p_w)> clearance;  ///< in the present map [m]
    /// Whether a place was observed (OnlineMap::isSeen()).
    std::function<bool(const Eigen::Vector3d& p_w)> isSeen;
    double radius = 0.;  ///< radius around the body that must stay free [m]
    /// Radius around the robot that a tilted camera does not observe [m]. A robot that cannot turn
    /// its camera there may fly there without observation.
    double hidden = 0.;
    bool canLook = false;  ///< the camera looks ahead and is turned by the robot's heading
    /// A place is in view if the heading differs by less from its direction [rad]. None: the robot
    /// turns to a place only where it stands (LookAhead::stopped).
    std::optional<double> inView = {};
    double turnPerMetre = 0.;  ///< how far the robot turns on a metre at full speed [rad/m]
};

struct FlyablePart {
    std::vector<PlannedView> plan;  ///< at least two views; equal poses: the robot hovers
    bool isWhole = false;           ///< the part is the whole plan
    bool isStopped = false;         ///< the obstacle is right ahead: the robot hovers
    /// The robot only turns, to look at what it has not seen on its plan or beside it.
    bool isLook = false;
    bool isBlind = false;  ///< the part leads into space that could not be observed before
};

/// The part of a plan up to unobserved space or to an obstacle. If the space right ahead, or right
/// beside it, was not observed, the robot first turns its camera there. If it cannot (the camera
/// looks down, or the heading is fixed), it makes a short blind step, from which it observes the
/// next one. If SpaceAhead::inView is given, it turns its camera already on the way to unobserved
/// space; the covariances of such views remain those of the planned headings.
/// @param plan from the robot's position on, at least two views
FlyablePart flyablePart(const std::vector<PlannedView>& plan, const SpaceAhead& space);

/// The rest of a plan for a robot that has flown on along another one since the plan was made: from
/// its pose to the nearest position of the plan, as far as the robot may have come, and along the
/// plan. A plan without a motion (to hover, to turn) is executed where the robot is.
/// @param plan at least two views
std::vector<PlannedView> continuedFrom(const Pose& T_w_b, const std::vector<PlannedView>& plan);

/// A plan to hover at a pose: two equal views.
std::vector<PlannedView> hovering(const Pose& T_w_b, const Matrix6& covariance);

}  // namespace photonav
