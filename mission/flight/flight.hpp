// SPDX-License-Identifier: BSD-3-Clause
// A plan flown in closed loop by a simulated robot, evaluated against the ground truth.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "control/pilot.hpp"
#include "simulation/simulated_robot.hpp"

namespace photonav {

/// The true world, the map that was planned in, and obstacles. All of it must be given, except the
/// noise.
struct FlightWorld {
    std::shared_ptr<const ViewSource> truth;
    std::shared_ptr<const ViewSource> map;
    std::function<double(const Eigen::Vector3d& p_w)> clearance;  ///< of the true world [m]
    Camera camera;
    Pose T_b_c = Pose::Identity();
    ImageNoise noise;  ///< empty: assumedNoise() of tracker.map.photometric
};

struct FlightOptions {
    /// Of T_c_w at take-off, before any image (camera frame, left); the true start is drawn from
    /// it.
    Matrix6 initialCovariance = Matrix6::Zero();
    double timeStep = 0.02;  ///< of control and odometry [s]
    SimulatedRobotOptions robot;
    TrackerOptions tracker{.searchPrior = true};  ///< its camera mount is that of the world
    PilotOptions pilot;
    double bodyRadius = 0.1;        ///< an obstacle nearer than this is a collision [m]
    double arrivalTolerance = 0.3;  ///< true distance to the goal of a flight that arrived [m]
    double timePerMetre = 6.;       ///< the flight is out of time after as much, and a minute [s]
    std::uint64_t seed = 1;
};

enum class FlightEnd {
    arrived,
    astray,  ///< believed to be at the goal, but is not
    collided,
    lost,  ///< gave up searching
    outOfTime,
    stopped,  ///< by the caller
};
std::string nameOf(FlightEnd end);

/// Truth and belief at one exposure: the belief with the image of that exposure; without it if it
/// never arrived.
struct FlightSample {
    double time = 0.;               ///< [s]
    double distance = 0.;           ///< along the plan, of its nearest point [m]
    Pose T_c_w = Pose::Identity();  ///< true
    UncertainPose belief;           ///< of T_c_w
};

struct FlightResult {
    std::size_t number = 0;  ///< of several flights of a plan
    FlightEnd end = FlightEnd::stopped;
    double duration = 0.;  ///< [s]
    double way = 0.;       ///< truly flown [m]
    double lost = 0.;      ///< time without tracking [s]
    int timesLost = 0;
    double goalError = 0.;        ///< true distance to the goal at the end [m]
    bool photometric = false;     ///< the goal was approached on its image
    double goalErrorBefore = 0.;  ///< true distance to the goal when that began [m]
    double leastClearance = 0.;   ///< truly, over the flight [m]
    int images = 0;               ///< received
    int rejectedImages = 0;       ///< of these
    std::vector<FlightSample> samples;
};

/// Called for every exposure, for recordings. @param depth true
using OnExposure = std::function<void(const Exposed& exposed)>;

/// Flies a plan with flyLoop() until it ends. Everything random follows from options.seed.
/// @param plan at least two views
/// @throws std::invalid_argument for a shorter plan, or a world without truth, map or clearance
/// @param isStopped asked now and then
FlightResult fly(const std::vector<PlannedView>& plan, const FlightWorld& world,
                 const FlightOptions& options, const std::function<bool()>& isStopped = {},
                 const OnExposure& onExposure = {});

}  // namespace photonav
