// SPDX-License-Identifier: BSD-3-Clause
// Smoothed paths of planners that look at nothing.
#pragma once

#include <ompl/base/PlannerTerminationCondition.h>
#include <ompl/base/SpaceInformation.h>

#include <memory>
#include <vector>

#include "space/flight_space.hpp"

namespace photonav {

/// Shortens a path by the changes that PathDescent tries, as paths of belief_rrt_star are improved;
/// here only the length counts, in the metric of the space. RRT* leaves corners that depend on its
/// samples: a rival should not lose by them.
/// @param path at least one state; motions are free
/// @param changes tried, about
/// @return the new states, from the same start to the same end; the motions are free
std::vector<std::shared_ptr<ompl::base::State>> shortened(
    const ompl::base::SpaceInformationPtr& si, const FlightSpace& space,
    const std::vector<const ompl::base::State*>& path, unsigned changes,
    const ompl::base::PlannerTerminationCondition& ptc);

}  // namespace photonav
