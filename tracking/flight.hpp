// SPDX-License-Identifier: BSD-3-Clause
// A planned path, flown in closed loop by a MAV that knows its pose from its images only.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "dense_aligner.hpp"
#include "simulated_camera.hpp"
#include "waypoint_servo.hpp"

namespace photonav {

/// A step of the plan: where to be, and what will be known there.
struct PlannedView {
    Pose T_w_b = Pose::Identity();
    /// Predicted, of T_c_w (camera frame, left), with the image taken here.
    Matrix6 covariance = Matrix6::Zero();
    double distance = 0.;     ///< way of the position so far [m]
    bool isWaypoint = false;  ///< to be reached, not only passed near
};

struct LostOptions {
    int badImages = 3;        ///< in a row before tracking counts as lost
    double blindTime = 1.5;   ///< without any image before it does [s]
    double hoverTime = 1.;    ///< waited where it is before searching [s]
    double giveUpTime = 20.;  ///< searched in vain before landing [s]
    /// While lost, the estimate is taken to be this much worse than it says [m], growing with time.
    double searchRadius = 0.3;
};

struct FlightOptions {
    /// Of T_c_w at take-off, before any image (camera frame, left); the true start is drawn from
    /// it.
    Matrix6 initialCovariance = Matrix6::Zero();
    double timeStep = 0.02;  ///< of control and odometry [s]
    MavOptions mav;
    SimulatedCameraOptions camera;
    ServoOptions servo;
    AlignmentOptions alignment;
    LostOptions lost;
    bool photometricGoal = true;  ///< servo on the goal's image where that tells enough
    double lookahead = 0.7;       ///< between waypoints, the view flown to is this far ahead [m]
    /// A waypoint counts as reached within this many standard deviations of the believed position,
    /// but not below or above these distances [m], and within `yawTolerance` [rad].
    double toleranceSigmas = 1.;
    double leastTolerance = 0.05;
    double mostTolerance = 0.2;
    double yawTolerance = 0.1;
    double bodyRadius = 0.1;        ///< an obstacle nearer than this is a collision [m]
    double arrivalTolerance = 0.3;  ///< true distance to the goal of a flight that arrived [m]
    double timePerMetre = 6.;       ///< the flight is out of time after as much, and a minute [s]
    std::uint64_t seed = 1;
};

/// What there is: the true world, the map that was planned in, and obstacles.
struct FlightWorld {
    const ViewSource* truth = nullptr;
    const ViewSource* map = nullptr;
    std::function<double(const Eigen::Vector3d& p_w)> clearance;  ///< of the true world [m]
    Camera camera;
    Pose T_b_c = Pose::Identity();
    ImageNoise noise;
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

/// How it stood at one exposure, by its image; by what was known before it, if it never arrived.
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
    int badImages = 0;            ///< of these, with an alignment that was lost
    std::vector<FlightSample> samples;
};

/// What an exposure saw, for recordings.
using OnExposure =
    std::function<void(double time, const Pose& T_c_w, const ImageF& image, const ImageF& depth)>;

/// Flies a plan: true pose -> image -> filter -> servo -> MAV. Everything random follows from
/// options.seed.
/// @param plan at least two views @throws std::invalid_argument otherwise
/// @param isStopped asked now and then
FlightResult fly(const std::vector<PlannedView>& plan, const FlightWorld& world,
                 const FlightOptions& options, const std::function<bool()>& isStopped = {},
                 const OnExposure& onExposure = {});

}  // namespace photonav
