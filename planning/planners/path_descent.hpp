// SPDX-License-Identifier: BSD-3-Clause
// Local descent on a path: shortcuts and shifted vertices, evaluated by the beliefs along it.
#pragma once

#include <ompl/base/PlannerTerminationCondition.h>
#include <ompl/base/SpaceInformation.h>
#include <ompl/base/StateSampler.h>

#include <limits>
#include <memory>
#include <optional>
#include <vector>

#include "belief/belief.hpp"

namespace photonav {

struct DescentOptions {
    unsigned moves = 3000;   ///< changes tried, about
    double firstStep = 3.;   ///< of the coarsest shifts [m, rad]
    double lastStep = 0.02;  ///< of the finest ones
    std::uint32_t seed = 1;  ///< of the directions that vertices are shifted in
};

/// Lowers the cost of a path in its neighbourhood by random changes: a vertex left out, a vertex
/// shifted, a leg bent at a new vertex or shifted, a corner cut. The cost is that of the planners,
/// with the integral and the views. It is not a smooth function of the path, so no derivatives are
/// used. Only the beliefs behind a change are propagated again. The path stays free of collision
/// and keeps its ends. Deterministic for a seed.
class PathDescent {
  public:
    PathDescent(ompl::base::SpaceInformationPtr si, std::shared_ptr<BeliefModel> model,
                const DescentOptions& options = {});

    /// Starts from a path (at least one state) whose motions are free. The states are copied.
    void begin(const std::vector<const ompl::base::State*>& path);
    /// The same with a given belief at the first state, instead of BeliefModel::root().
    void begin(const std::vector<const ompl::base::State*>& path, const Belief& root);

    /// Descends until the moves since begin() are used up (those of the options, or fewer) or the
    /// condition holds. Continues where the last call ended.
    void descend(const ompl::base::PlannerTerminationCondition& ptc,
                 unsigned moves = std::numeric_limits<unsigned>::max());

    double cost() const { return nodes_.back().belief.cost; }
    std::vector<const ompl::base::State*> path() const;  ///< owned by this object
    unsigned tried() const { return tried_; }            ///< changes since begin()
    unsigned accepted() const { return accepted_; }      ///< of them, those that lowered the cost

  private:
    using StatePtr = std::shared_ptr<ompl::base::State>;
    struct Node {
        StatePtr state;
        Motion arrival;  // from the node before
        Belief belief;
        std::optional<double> leastRest = {};  // see leastRest()
    };

    void removeVertices();
    void shiftVertices(double step);
    void shiftLegs(double step);
    void bendLegs(double step);
    void cutCorners();
    bool tryBothWays(std::size_t first, std::size_t last, StatePtr centre, StatePtr follower,
                     double step);
    bool tryReplace(std::size_t first, std::size_t last, const std::vector<StatePtr>& between);
    bool propagateRest(std::size_t last, Belief belief, std::vector<Belief>& beliefs);
    double leastRest(std::size_t i);

    StatePtr parallel(const ompl::base::State& from, const ompl::base::State& to,
                      const ompl::base::State& follower) const;
    StatePtr between(const ompl::base::State* from, const ompl::base::State* to, double t) const;
    bool isOver() const { return tried_ >= lastMove_ || (*ptc_)(); }

    ompl::base::SpaceInformationPtr si_;
    std::shared_ptr<BeliefModel> model_;
    DescentOptions options_;
    ompl::base::StateSamplerPtr sampler_;
    const ompl::base::PlannerTerminationCondition* ptc_ = nullptr;
    std::vector<Node> nodes_;
    double step_ = 0.;       // of the round of shifts that comes next
    unsigned lastMove_ = 0;  // of this call of descend()
    unsigned tried_ = 0;
    unsigned accepted_ = 0;
};

}  // namespace photonav
