// SPDX-License-Identifier: BSD-3-Clause
// Headings by a fixed rule, as baselines for planned headings.
#pragma once

#include <ompl/base/SpaceInformation.h>

#include <memory>
#include <vector>

#include "space/flight_space.hpp"

namespace photonav {

enum class Headings {
    fixed,   ///< the heading of the first state on the whole path
    forward  ///< along the motion: the robot turns on the spot at every waypoint
};

/// Replaces the headings of a path. RRT* minimises the length, so that its headings are random
/// samples; robots without planned headings follow one of these rules instead. A vertical leg, or
/// one shorter than 0.1 m, keeps the heading of the leg before it.
/// @param path at least one state; the first one is the present pose of the robot and is not
///        changed
/// @return the new states; a turn on the spot is a motion of its own
/// @throws std::invalid_argument unless the space is StateKind::positionYaw
std::vector<std::shared_ptr<ompl::base::State>> replaceHeadings(
    const ompl::base::SpaceInformationPtr& si, const FlightSpace& space,
    const std::vector<const ompl::base::State*>& path, Headings headings);

}  // namespace photonav
