// SPDX-License-Identifier: BSD-3-Clause
// All planners by name.
#pragma once

#include <memory>
#include <string>

#include "planners/belief_planner.hpp"
#include "planners/belief_rrt_star.hpp"
#include "planners/planner_traits.hpp"

namespace photonav {

/// The weight of the length in the cost that this planner minimises, where `alpha` is that of the
/// others: 1 for those that use no views.
/// @throws std::invalid_argument for an unknown name
double alphaOf(const std::string& planner, double alpha);

/// A planner, without a problem definition yet.
/// @param model of costs and beliefs; a planner that uses no views takes its own, with alpha = 1
/// @param search for belief_rrt_star
/// @throws std::invalid_argument for an unknown name
std::shared_ptr<BeliefPlanner> makePlanner(const std::string& name,
                                           const ompl::base::SpaceInformationPtr& si,
                                           const std::shared_ptr<BeliefModel>& model,
                                           const SearchOptions& search = {},
                                           const GrowthOptions& growth = {});

}  // namespace photonav
