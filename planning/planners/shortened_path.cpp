// SPDX-License-Identifier: BSD-3-Clause
#include "planners/shortened_path.hpp"

#include "planners/path_descent.hpp"

namespace photonav {
namespace ob = ompl::base;

std::vector<std::shared_ptr<ob::State>> shortenPath(const ob::SpaceInformationPtr& si,
                                                    const FlightSpace& space,
                                                    const std::vector<const ob::State*>& path,
                                                    unsigned changes,
                                                    const ob::PlannerTerminationCondition& ptc) {
    const auto blind = std::make_shared<InformationField>(InformationFormula{}, Pose::Identity(),
                                                          InformationField::Options{});
    BeliefOptions byLength;
    byLength.alpha = 1.;
    byLength.order = PropagationOrder::second;
    PathDescent descent(si, std::make_shared<BeliefModel>(space, blind, byLength),
                        {.moves = changes});
    descent.begin(path, Belief{});
    descent.descend(ptc);
    std::vector<std::shared_ptr<ob::State>> states;
    for (const ob::State* state : descent.path()) {
        states.emplace_back(si->cloneState(state), [si](ob::State* copy) { si->freeState(copy); });
    }
    return states;
}

}  // namespace photonav
