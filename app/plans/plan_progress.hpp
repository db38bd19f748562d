// SPDX-License-Identifier: BSD-3-Clause
// The progress of planning, as one line of text.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "problem/planning_problem.hpp"
#include "shared/command_io.hpp"

namespace photonav {

/// Predicts the time until the last vertex is added. The model is a power law, time over number of
/// vertices, fitted to two points: the present number of vertices and half of it. Before a first
/// path is found and searched, the tree grows so fast that its times predict nothing. The last
/// search and the descent after the last vertex are not included: their duration cannot be
/// predicted.
class RemainingGrowth {
  public:
    /// @param vertices number of vertices at the end
    explicit RemainingGrowth(unsigned vertices) : vertices_(vertices) {}

    void add(const PlanProgress& progress) { history_.push_back(progress); }

    /// Time until the last vertex [s]. Nothing if no path was known at half the present number of
    /// vertices, and after the last vertex.
    std::optional<double> seconds() const;

  private:
    double vertices_;
    std::vector<PlanProgress> history_;
};

/// Shows the progress of a planner on a line.
/// @param vertices number of vertices at the end
/// @param purpose beginning of the line, such as the planner's name
OnPlanProgress shownOn(ProgressLine& line, unsigned vertices, const std::string& purpose);

/// Shows on a line how rrt_star grows, from whose path automatic kappa is computed.
OnPlanProgress kappaShownOn(ProgressLine& line, const Config& config);

/// Says on a line which kappa was chosen, if it was to be chosen.
/// @param given the config as it was read
void sayKappa(ProgressLine& line, const Config& given, double kappa);

/// withKappa(), with progress and the value on a line.
Config withKappaSaid(const Config& given, const World& world, ProgressLine& line,
                     const std::atomic<bool>& interrupted);

/// One line of text: vertices, best cost and views so far, and the time so far or the time left.
/// @param vertices number of vertices at the end
std::string progressText(const PlanProgress& progress, unsigned vertices,
                         const RemainingGrowth& growth);

}  // namespace photonav
