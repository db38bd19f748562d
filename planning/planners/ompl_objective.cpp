// SPDX-License-Identifier: BSD-3-Clause
#include "planners/ompl_objective.hpp"

#include <fmt/format.h>

namespace photonav {
namespace ob = ompl::base;

OmplObjective::OmplObjective(const ob::SpaceInformationPtr& si,
                             std::shared_ptr<const BeliefModel> model)
    : ob::OptimizationObjective(si), model_(std::move(model)) {
    const BeliefOptions& options = model_->options();
    description_ = fmt::format(
        "{} * length + {} * {}", options.alpha, (1. - options.alpha) * options.kappa,
        options.cost == CostRule::integral ? "integral of the trace" : "trace at the vertices");
}

ob::Cost OmplObjective::motionCost(const ob::State* from, const ob::State* to) const {
    return ob::Cost(model_->lowerBound(si_->distance(from, to)));
}

}  // namespace photonav
