// SPDX-License-Identifier: BSD-3-Clause
// The planners' cost as an OMPL objective. The cost itself is computed in belief/belief.hpp.
#pragma once

#include <ompl/base/OptimizationObjective.h>

#include <memory>

#include "belief/belief.hpp"

namespace photonav {

/// J = alpha * length + (1 - alpha) * kappa * integral of the trace, as an OMPL objective for
/// comparing, printing and stopping at solutions. The cost of a motion depends on the belief before
/// the motion, which OMPL's interface does not pass. motionCost() is therefore a lower bound for
/// any belief, alpha times the length. The sum over a path (ompl::base::Path::cost) is a lower
/// bound as well, exact for alpha = 1.
class OmplObjective : public ompl::base::OptimizationObjective {
  public:
    OmplObjective(const ompl::base::SpaceInformationPtr& si,
                  std::shared_ptr<const BeliefModel> model);

    ompl::base::Cost stateCost(const ompl::base::State*) const override {
        return ompl::base::Cost(0.);
    }
    ompl::base::Cost motionCost(const ompl::base::State* from,
                                const ompl::base::State* to) const override;
    ompl::base::Cost motionCostHeuristic(const ompl::base::State* from,
                                         const ompl::base::State* to) const override {
        return motionCost(from, to);
    }

  private:
    std::shared_ptr<const BeliefModel> model_;
};

}  // namespace photonav
