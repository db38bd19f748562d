// SPDX-License-Identifier: BSD-3-Clause
// How far a plan is, in a line.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "problem/planning_problem.hpp"

namespace photonav {

/// Predicts when the last vertex will be added: the time of growth follows a power of the number of
/// vertices, which is fitted from half the present number on. Until a first path is found and
/// searched, growth takes next to no time and predicts nothing. The last search and the descent,
/// which follow, are not part of it: their duration is not known before.
class RemainingGrowth {
  public:
    explicit RemainingGrowth(unsigned vertices) : vertices_(vertices) {}

    void add(const PlanProgress& progress) { history_.push_back(progress); }

    /// Until the last vertex [s]; nothing while no path was known at half the present number of
    /// vertices, and after the last vertex.
    std::optional<double> seconds() const;

  private:
    double vertices_;
    std::vector<PlanProgress> history_;
};

/// Vertices, cost and views so far, and what comes when.
std::string progressText(const PlanProgress& progress, unsigned vertices,
                         const RemainingGrowth& growth);

}  // namespace photonav
