// SPDX-License-Identifier: BSD-3-Clause
// From a planning problem to the flights of its plans.
#pragma once

#include <span>
#include <vector>

#include "belief/belief.hpp"
#include "estimation/calibration.hpp"
#include "flight/flight.hpp"
#include "problem/planning_problem.hpp"
#include "problem/tracking_map.hpp"

namespace photonav {

/// The plan that a flight flies: the beliefs along a path of the planner.
std::vector<PlannedView> plannedViews(std::span<const BeliefPoint> path);

struct FlightSetup {
    FlightWorld world;
    FlightOptions options;
    MapKind map = MapKind::mesh;  ///< of the tracking map; mesh if that is the world itself
};

/// World and options of flights under the conditions that the config of the problem describes, its
/// section `fly` above all: camera, odometry, start, obstacles, noise and the map to track in.
///
///     const FlightSetup setup = setUpFlight(problem);
///     const FlightResult flight =
///         fly(plannedViews(outcome.path->points), setup.world, setup.options);
///
/// @param problem its world must outlive the setup
/// @throws InputError for a map that cannot be read
FlightSetup setUpFlight(const PlanningProblem& problem);

/// Options of flights under the conditions of a config, without those that depend on a world: start
/// and space for searches.
/// @param map kind of the map to which images are aligned
/// @param cellSize edge of the cells of that map [m]; 0 for a mesh
FlightOptions flightOptions(const Config& config, MapKind map, double cellSize);

/// How images are aligned under the conditions of the section `fly`: covariances follow from their
/// residuals.
/// @param map kind of the map to which images are aligned
/// @param cellSize edge of the cells of that map [m]; 0 for a mesh
AlignmentOptions flightAlignment(const Config& config, MapKind map, double cellSize);

/// Largest distance to the goal at which a flight has arrived [m].
double arrivalTolerance(const Config& config);

/// Sets scale and least sigmas of alignments as calibrated. The factor is divided by the number of
/// images with correlated errors, because a tracker averages images.
void applyCalibration(const Calibration& calibration, FlyConfig& fly);

}  // namespace photonav
