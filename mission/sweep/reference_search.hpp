// SPDX-License-Identifier: BSD-3-Clause
// The search for near-optimal paths, which fill a reference table.
#pragma once

#include <atomic>
#include <string>
#include <vector>

#include "problem/planning_problem.hpp"
#include "sweep/reference_table.hpp"

namespace photonav {

/// The search for one value of alpha. Every path that it finds is offered to the table.
class ReferenceSearch {
  public:
    /// @param config  gives alpha (belief.alpha) and the effort: vertices and labels
    /// @param moves   changes that the descent tries on each path
    /// @param world   must outlive the search
    /// @param table   must outlive the search
    /// @param interrupted  must outlive the search
    /// @throws InputError for a start or goal in collision
    ReferenceSearch(const Config& config, unsigned moves, const World& world, ReferenceTable& table,
                    const std::atomic<bool>& interrupted);

    /// Evaluates the table's path for this alpha again and improves it by descent. The path may
    /// come from a search with another config; it is dropped if it is not free.
    void refresh();

    /// Plans a path and improves it by descent.
    void plan(const std::string& planner, std::uint32_t seed);

  private:
    void descend(const std::vector<Pose>& waypoints, ReferencePath path);

    Config config_;
    unsigned moves_;
    PlanningProblem problem_;
    ReferenceTable& table_;
    const std::atomic<bool>& interrupted_;
};

}  // namespace photonav
