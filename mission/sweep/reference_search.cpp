// SPDX-License-Identifier: BSD-3-Clause
#include "sweep/reference_search.hpp"

#include "io/interrupted.hpp"

namespace photonav {
namespace {

std::vector<Pose> waypointsOf(const EvaluatedPath& path) {
    std::vector<Pose> waypoints;
    for (const BeliefPoint& point : path.points) {
        if (point.isWaypoint) waypoints.push_back(point.T_w_b);
    }
    return waypoints;
}

}  // namespace

ReferenceSearch::ReferenceSearch(const Config& config, unsigned moves, const World& world,
                                 ReferenceTable& table, const std::atomic<bool>& interrupted)
    : config_(config),
      moves_(moves),
      problem_(config_, world),
      table_(table),
      interrupted_(interrupted) {
    problem_.checkPlaces();
}

void ReferenceSearch::refresh() {
    const ReferencePath* known = table_.at(config_.belief.alpha);
    if (known == nullptr) return;
    const ReferencePath path = *known;
    table_.drop(path.alpha);
    descend(path.waypoints, path);
}

void ReferenceSearch::plan(const std::string& planner, std::uint32_t seed) {
    PlanOutcome outcome;
    try {
        outcome = problem_.solve(problem_.makePlanner(planner, seed), interrupted_);
    } catch (const Interrupted&) {
        return;
    }
    if (!outcome.path) return;
    descend(waypointsOf(*outcome.path), {.alpha = config_.belief.alpha,
                                         .planner = planner,
                                         .vertices = config_.vertices,
                                         .labels = config_.search.labels,
                                         .seed = seed});
}

void ReferenceSearch::descend(const std::vector<Pose>& waypoints, ReferencePath path) {
    const DescentOptions descent{.moves = moves_, .seed = path.seed};
    const auto descended = problem_.descend(waypoints, descent, interrupted_);
    if (!descended) return;
    path.cost = descended->cost;
    path.length = descended->length;
    path.meanTrace = descended->meanTrace;
    path.goalTrace = descended->goalTrace;
    path.waypoints = waypointsOf(*descended);
    table_.offer(path);
}

}  // namespace photonav
