// SPDX-License-Identifier: BSD-3-Clause
#include "planners/shortened_path.hpp"

#include "planners/path_descent.hpp"

namespace photonav {
namespace ob = ompl::base;

ompl::geometric::PathGeometric shortenPath(const ob::SpaceInformationPtr& si,
                                           const FlightSpace& space,
                                           const std::vector<ob::State*>& path, unsigned changes,
                                           const ob::PlannerTerminationCondition& ptc) {
    const auto blind = std::make_shared<InformationField>(InformationFormula{}, Pose::Identity(),
                                                          InformationField::Options{});
    BeliefOptions byLength;
    byLength.alpha = 1.;
    byLength.order = PropagationOrder::second;
    PathDescent descent(si, std::make_shared<BeliefModel>(space, blind, byLength),
                        {.moves = changes});
    descent.begin({path.begin(), path.end()}, Belief{});
    descent.descend(ptc);
    ompl::geometric::PathGeometric shortened(si);
    for (const ob::State* state : descent.path()) shortened.append(state);
    return shortened;
}

}  // namespace photonav
