// SPDX-License-Identifier: BSD-3-Clause
// Makes planners by name.
#pragma once

#include <memory>
#include <string>

#include "planners/belief_planner.hpp"
#include "planners/belief_rrt_star.hpp"
#include "planners/planner_traits.hpp"

namespace photonav {

/// The alpha of the cost that a planner minimises: 1 if it uses no views, else `alpha`.
/// @throws std::invalid_argument for an unknown name
double alphaOf(const std::string& planner, double alpha);

/// Makes a planner without a problem definition.
/// @param model model of costs and beliefs; a planner that uses no views gets a copy with alpha = 1
/// @param search options of belief_rrt_star; other planners ignore them
/// @throws std::invalid_argument for an unknown name
std::shared_ptr<BeliefPlanner> makePlanner(const std::string& name,
                                           const ompl::base::SpaceInformationPtr& si,
                                           const std::shared_ptr<BeliefModel>& model,
                                           const SearchOptions& search = {},
                                           const GrowthOptions& growth = {});

}  // namespace photonav
