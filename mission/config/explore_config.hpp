// SPDX-License-Identifier: BSD-3-Clause
// The section `explore` of a config: how a robot explores a scene that it does not know. Camera,
// odometry and speed are those of the section `fly`.
#pragma once

#include <string>
#include <vector>

#include "geometry/types.hpp"

namespace photonav {

enum class ExploreSensor { depth, stereo, monocular };

/// What space that was never seen is to a planner.
enum class UnknownSpace { optimistic, pessimistic };

/// The information assumed of a view of space that was never seen.
enum class UnknownInformation {
    none,      ///< the paper
    predicted  ///< as much as the views that were flown through lately
};

struct ExploreConfig {
    ExploreConfig();

    ExploreSensor sensor = ExploreSensor::depth;
    double depthSigma = 0.0015;   ///< of the depth sensor at 1 m, growing with depth squared [m]
    double depthMissing = 0.02;   ///< share of its pixels without a measurement
    double baseline = 0.11;       ///< of the stereo camera [m]
    double verticalSigma = 0.01;  ///< of the vertical by the accelerometer [rad]; 0: not measured
    double range = 4.;            ///< farther surfaces are not mapped [m]
    double resolution = 0.05;     ///< edge of the map's cells [m]
    UnknownSpace unknown = UnknownSpace::optimistic;
    UnknownInformation unknownInformation = UnknownInformation::none;
    double keyframeDistance = 0.25;  ///< an image this far from the last one fused is fused [m]
    double keyframeAngle = 0.2;      ///< the same for a turn [rad]
    double keyframeNew = 0.3;        ///< or with this share of surfaces not in the map
    unsigned vertices = 400;         ///< of the roadmap or tree, grown again after every keyframe
    unsigned shortcut = 100;         ///< changes tried on each path (belief_rrt_star)
    unsigned viewTurns = 4;          ///< views that changed are rendered again in as many updates
    double commitment = 0.1;         ///< a path is left for one that costs less by this share
    Matrix6 initialCovariance;       ///< of the pose at the start, body frame
    double goalTolerance = 0.3;      ///< distance to the goal of a flight that arrived [m]
    double goalConfidence = 0.5;     ///< least believed probability of an arrival that is claimed
    double timeLimit = 600.;         ///< of a flight [s]
    unsigned trials = 1;             ///< per planner
    std::vector<std::string> planners;  ///< that are compared; empty: planner.name
};

}  // namespace photonav
