// SPDX-License-Identifier: BSD-3-Clause
// The search for the best path of a reference table.
#pragma once

#include <atomic>
#include <string>
#include <vector>

#include "problem/planning_problem.hpp"
#include "sweep/reference_table.hpp"

namespace photonav {

/// All that is done for one alpha.
class ReferenceSearch {
  public:
    /// @param config with the alpha and the effort; @param moves tried by the descent from each
    /// path
    /// @param table, world and `interrupted` must outlive the search
    /// @throws InputError for a start or goal that cannot be flown to
    ReferenceSearch(const Config& config, unsigned moves, const World& world, ReferenceTable& table,
                    const std::atomic<bool>& interrupted);

    /// Descends from the path known so far, which may be of another problem, or not at its best.
    void refresh();

    /// Plans, and descends from the path.
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
