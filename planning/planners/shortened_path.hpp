// SPDX-License-Identifier: BSD-3-Clause
// Shortens the paths of planners that use no views.
#pragma once

#include <ompl/base/PlannerTerminationCondition.h>
#include <ompl/base/SpaceInformation.h>
#include <ompl/geometric/PathGeometric.h>

#include <vector>

#include "space/flight_space.hpp"

namespace photonav {

/// Shortens a path by PathDescent, as belief_rrt_star improves its paths, but with the length in
/// the metric of the space as the only cost. Paths of RRT* have corners that depend on its samples.
/// Without them, a comparison with belief_rrt_star is fair.
/// @param path at least one state; the motions must be free
/// @param changes approximate number of changes that are tried
/// @return copies of the states, from the same start to the same end; the motions are free
ompl::geometric::PathGeometric shortenPath(const ompl::base::SpaceInformationPtr& si,
                                           const FlightSpace& space,
                                           const std::vector<ompl::base::State*>& path,
                                           unsigned changes,
                                           const ompl::base::PlannerTerminationCondition& ptc);

}  // namespace photonav
