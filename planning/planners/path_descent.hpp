// SPDX-License-Identifier: BSD-3-Clause
// Local descent on a path: shortcuts and shifts of vertices, evaluated by the beliefs along the
// path.
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
    unsigned moves = 3000;   ///< approximate number of changes that are tried
    double firstStep = 3.;   ///< length of the first, coarsest shifts, metric of the space [m]
    double lastStep = 0.02;  ///< length of the finest shifts, metric of the space [m]
    std::uint32_t seed = 1;  ///< seed of the directions of shifts
};

/// Lowers the cost of a path by random local changes: a vertex is removed or shifted, a leg is
/// shifted or bent at a new vertex, a corner is cut. A change is accepted if it lowers the cost,
/// which is the cost of BeliefModel. This cost is not a smooth function of the path, so no
/// derivatives are used. Only the beliefs after a change are propagated again. The path stays free
/// of collision and keeps its ends. Deterministic for a given seed.
class PathDescent {
  public:
    PathDescent(ompl::base::SpaceInformationPtr si, std::shared_ptr<BeliefModel> model,
                const DescentOptions& options = {});

    /// Starts from a path (at least one state) whose motions are free. The states are copied.
    void begin(const std::vector<const ompl::base::State*>& path);
    /// Starts from a path with a given belief at its first state, instead of BeliefModel::root().
    void begin(const std::vector<const ompl::base::State*>& path, const Belief& root);

    /// Descends until the condition holds, or until this number of changes or the options' number,
    /// counted since begin(), was tried. Continues where the last call ended.
    void descend(const ompl::base::PlannerTerminationCondition& ptc,
                 unsigned moves = std::numeric_limits<unsigned>::max());

    /// Cost of the present path, including the cost of the belief at its first state.
    double cost() const { return nodes_.back().belief.cost; }
    std::vector<const ompl::base::State*> path() const;  ///< its states, owned by this object
    unsigned tried() const { return tried_; }            ///< number of changes since begin()
    unsigned accepted() const { return accepted_; }  ///< number of changes that lowered the cost

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
