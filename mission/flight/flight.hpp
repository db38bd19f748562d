// SPDX-License-Identifier: BSD-3-Clause
// A plan flown in closed loop by a simulated robot, evaluated against the ground truth.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "control/pilot.hpp"
#include "flight/arrival.hpp"
#include "flight/flight_end.hpp"
#include "io/interrupted.hpp"
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
    TrackerOptions tracker{.searchPrior = true};  ///< mount and sharpness are the robot's
    PilotOptions pilot;
    double bodyRadius = 0.1;        ///< an obstacle nearer than this is a collision [m]
    double arrivalTolerance = 0.3;  ///< distance to the goal of a flight that arrived [m]
    double timePerMetre = 6.;       ///< the flight is out of time after as much, and a minute [s]
    std::uint64_t seed = 1;
};

/// The outcome of tracking an image.
enum class ImageUse {
    missing,   ///< it never arrived
    used,      ///< the belief was updated
    rejected,  ///< the belief is the predicted one
};

/// Truth and belief at one exposure: the belief with the image of that exposure; without it if it
/// never arrived.
struct FlightSample {
    double time = 0.;               ///< [s]
    double distance = 0.;           ///< along the plan, of its nearest point [m]
    Pose T_c_w = Pose::Identity();  ///< true
    UncertainPose belief;           ///< of T_c_w
    ImageUse image = ImageUse::missing;
    Exposure exposure = {};  ///< gain and offset of a used image, as its alignment found them
};

struct FlightResult {
    std::size_t number = 0;  ///< of several flights of a plan
    FlightEnd end = FlightEnd::stopped;
    double duration = 0.;  ///< [s]
    double flown = 0.;     ///< length of the true path [m]
    /// Length of the true path until the belief was at the goal for the first time, or else until
    /// the end, divided by the time until then [m/s].
    std::optional<double> meanSpeed;
    double lostTime = 0.;  ///< without tracking [s]
    int timesLost = 0;
    double goalError = 0.;  ///< true distance to the goal at the end [m]
    /// Of a flight that ended at its believed goal: where it believed to be, wider where its last
    /// corrections were larger than it had believed, and the probability to be there.
    std::optional<PositionBelief> believedGoal;
    double arrivalProbability = 0.;
    bool photometric = false;     ///< the goal was approached on its image
    double goalErrorBefore = 0.;  ///< true distance to the goal when that began [m]
    double leastClearance = 0.;   ///< truly, over the flight [m]
    int images = 0;               ///< received
    int rejectedImages = 0;       ///< of these
    std::vector<FlightSample> samples;

    bool hasArrived() const { return end == FlightEnd::arrived; }
};

/// Where a flight truly begins: a body pose drawn from the belief at take-off.
Pose drawStart(const UncertainPose& start, const Pose& T_b_c, std::uint64_t seed);

/// Compares a flight with the truth as it goes on.
class FlightEvaluator {
  public:
    /// @param world,robot must outlive the evaluator
    FlightEvaluator(const FlightWorld& world, const SimulatedRobot& robot,
                    const Eigen::Vector3d& goal_w);

    /// Once after every step of the robot.
    /// @param tracked of this step; @param distance of the sample, if the camera exposed now [m]
    void onStep(const std::vector<TrackedFrame>& tracked, const Tracker& tracker, double distance);
    /// Sets the mean speed until now, unless it is set already.
    void measureSpeed();
    /// True distance of the body to the goal [m].
    double goalError() const { return (robot_.T_w_b().translation() - goal_w_).norm(); }
    /// Of a robot whose estimate is at the goal: it reports its arrival if it is within `tolerance`
    /// [m] of the goal with at least the probability `confidence`.
    FlightEnd endAtGoal(const BelievedArrival& arrival, double tolerance,
                        double confidence = kArrivalConfidence);
    FlightResult& result() { return result_; }
    const FlightResult& result() const { return result_; }
    /// Enters what is known at the end.
    void finish(const Tracker& tracker);

  private:
    const FlightWorld& world_;
    const SimulatedRobot& robot_;
    Eigen::Vector3d goal_w_;
    Eigen::Vector3d before_w_;
    FlightResult result_;
};

/// Called for every exposure, for recordings.
using OnExposure = std::function<void(const Exposed& exposed)>;

/// Flies a plan with flyLoop() until it ends. Everything random follows from options.seed.
/// @param plan at least two views
/// @param isStopped asked after every step; when it returns true, the flight ends as
///        FlightEnd::stopped
/// @throws std::invalid_argument for a shorter plan, or a world without truth, map or clearance
FlightResult fly(const std::vector<PlannedView>& plan, const FlightWorld& world,
                 const FlightOptions& options, const IsStopped& isStopped = {},
                 const OnExposure& onExposure = {});

}  // namespace photonav
