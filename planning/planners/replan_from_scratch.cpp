// SPDX-License-Identifier: BSD-3-Clause
#include "planners/replan_from_scratch.hpp"

#include <chrono>

namespace photonav {

ReplanFromScratch::ReplanFromScratch(PlannerFactory makePlanner)
    : makePlanner_(std::move(makePlanner)) {}

ompl::base::PlannerStatus ReplanFromScratch::replan(
    const ompl::base::PlannerTerminationCondition& ptc) {
    const auto begin = std::chrono::steady_clock::now();
    planner_.reset();
    planner_ = makePlanner_();
    const ompl::base::PlannerStatus status = planner_->solve(ptc);
    ++effort_.plans;
    effort_.vertices += planner_->vertices();
    effort_.views += planner_->model().field().views();
    effort_.seconds +=
        std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    return status;
}

}  // namespace photonav
