// SPDX-License-Identifier: BSD-3-Clause
// The section `explore` of a config: how a robot explores an unknown scene. Image noise, odometry
// and speed are set in the section `fly`.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "geometry/types.hpp"

namespace photonav {

enum class ExploreSensor { depth, stereo, monocular };

/// How planners treat space that was never observed: as free (optimistic) or as occupied
/// (pessimistic).
enum class UnknownSpace { optimistic, pessimistic };

/// The information that planners assume for views of space that was never observed.
enum class UnknownInformation {
    none,      ///< no information, as in the paper
    predicted  ///< as what was seen beside it and in the latest views (UnseenInformation)
};

/// Where a robot turns to what it has not seen: where its way that is known to be free ends, with
/// planned headings until there, or on its way to that place.
enum class LookAhead { stopped, flying };

/// Edge of the cells of an exploration's map: the smallest, the largest, and the default. Smaller
/// cells make positions more exact and updates slower [m].
inline constexpr double kLeastExploreCell = 0.01, kMostExploreCell = 0.5, kExploreCell = 0.035;

struct ExploreConfig {
    ExploreConfig();

    ExploreSensor sensor = ExploreSensor::depth;
    /// Standard deviation of the depth sensor at 1 m; it grows with depth squared [m].
    double depthSigma = 0.0015;
    double depthMissing = 0.02;  ///< depth sensor: share of pixels without a measurement
    double baseline = 0.11;      ///< baseline of the stereo camera [m]
    /// Contrast, at 1 m, of the pattern that the projector of the stereo camera adds; 0: none.
    double projector = 1.;
    /// Standard deviation of the vertical that the accelerometer measures with every image [rad];
    /// 0: the vertical is not measured.
    double verticalSigma = 0.01;
    /// Standard deviation of the rotation that the gyroscope measures over one second [rad], whose
    /// square grows with time; 0: no gyroscope. The default is ten times that of usual gyroscopes,
    /// so that a constant error of 0.1 mrad/s is within it for 100 s.
    double gyroscopeNoise = 1e-3;
    double range = 4.;  ///< surfaces farther away are not mapped [m]
    /// Edge of the map's cells [m]. None: that of a known map's cells, which setUpExploration() and
    /// explorerOptions() put here; kExploreCell without a known map.
    std::optional<double> resolution;
    UnknownSpace unknown = UnknownSpace::optimistic;
    UnknownInformation unknownInformation = UnknownInformation::none;
    LookAhead look = LookAhead::stopped;
    // An image is fused if one of the three conditions holds.
    double keyframeDistance = 0.25;  ///< distance from the last fused image [m]
    double keyframeAngle = 0.2;      ///< rotation since the last fused image [rad]
    double keyframeNew = 0.3;        ///< share of the surfaces in view that the map lacks
    unsigned vertices = 400;         ///< vertices of the roadmap or tree
    unsigned shortcut = 100;         ///< changes that the descent tries on each path
                                     ///< (belief_rrt_star)
    unsigned viewTurns = 4;          ///< each update renders one in viewTurns of the views that a
                                     ///< change of the map affects, in turn
    double commitment = 0.1;      ///< another path is taken only if its cost is lower by this share
                                  ///< (belief_rrt_star)
    Matrix6 initialCovariance;    ///< covariance of the pose at the start, body frame
    double goalTolerance = 0.3;   ///< a flight has arrived within this distance of the goal [m]
    double goalConfidence = 0.5;  ///< the robot reports its arrival if it is within goalTolerance
                                  ///< with at least this believed probability
    double timeLimit = 600.;      ///< longest duration of a flight [s]
    bool realtime = false;        ///< a second thread plans while the robot flies by the clock
    unsigned trials = 1;          ///< flights per planner
    std::vector<std::string> planners;  ///< planners to compare; empty: planner.name alone

    double cell() const { return resolution.value_or(kExploreCell); }  ///< see resolution [m]
};

}  // namespace photonav
