// SPDX-License-Identifier: BSD-3-Clause
// Headings that need no planner: rivals of planned ones.
#pragma once

#include <ompl/base/SpaceInformation.h>

#include <memory>
#include <vector>

#include "space/flight_space.hpp"

namespace photonav {

enum class Headings {
    fixed,   ///< that of the first state, all the way
    forward  ///< along the motion: the robot turns on the spot at every waypoint
};

/// The positions of a path with other headings. RRT*, which minimises the length, leaves headings
/// as they were drawn; these are what robots do that have none planned.
/// @param path at least one state, of a space with a heading; the first one is where the robot is
/// and
///        how it is turned, and stays as it is. Legs that are vertical keep the heading before.
/// @return the new states; a turn on the spot is a motion of its own
/// @throws std::invalid_argument unless the space is StateKind::positionYaw
std::vector<std::shared_ptr<ompl::base::State>> withHeadings(
    const ompl::base::SpaceInformationPtr& si, const FlightSpace& space,
    const std::vector<const ompl::base::State*>& path, Headings headings);

}  // namespace photonav
