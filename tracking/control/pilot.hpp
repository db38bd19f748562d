// SPDX-License-Identifier: BSD-3-Clause
// From a plan and a belief to commands.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "control/flown_way.hpp"
#include "control/photometric_servo.hpp"
#include "control/route.hpp"
#include "control/view_search.hpp"
#include "control/waypoint_servo.hpp"
#include "estimation/tracker.hpp"

namespace photonav {

struct PilotOptions {
    RouteOptions route;
    double servoGain = 1.5;  ///< rate at which a pose error decreases exponentially [1/s]
    bool photometricGoal =
        true;  ///< photometric servoing at the goal, if its image determines all velocities
    PhotometricOptions photometric;  ///< options for the information of the goal's image
    double hoverTime = 1.;  ///< time to hover after tracking was lost, before a search begins [s]
    double giveUpTime =
        20.;  ///< time of a search without success after which the flight is given up [s]
    /// Distance from a position to the nearest obstacle of the map [m]. Empty: not known; then the
    /// pilot does not search beside the plan, and does not stop before obstacles while tracking is
    /// lost.
    std::function<double(const Eigen::Vector3d& p_w)> clearance;
    double radius = 0.2;      ///< least clearance of positions in a search beside the plan [m]
    double bodyRadius = 0.1;  ///< radius of the body: a smaller clearance is a collision [m]
};

/// Computes velocity commands from a plan and the present belief.
///
/// The robot follows a smooth path past the views of the plan: the command is the velocity of the
/// path plus visual servoing toward the pose on it. At the goal it servos on the goal's image. If
/// the belief at a waypoint is much wider than planned, the view of the waypoint was not seen: the
/// pilot searches around it for a view that reduces the uncertainty. If it finds none in time, it
/// goes on along the plan; if the goal is not reached with certainty, it gives up.
///
/// While tracking is lost, the pilot first hovers. Then it goes on to the view that it was
/// searching for, if it was. Otherwise it flies back on the way it came, to the last view that
/// determined the pose, or on along the plan to a view that should reduce the uncertainty,
/// whichever is nearer. After giveUpTime it gives up.
///
/// Beside the plan and while tracking is lost it goes only where the body collides with nothing at
/// any position within three standard deviations of the belief. A lost robot hovers before other
/// places: errors of odometry grow with the distance flown.
class Pilot {
  public:
    /// @param plan at least two views @throws std::invalid_argument otherwise
    /// @param map the view of the goal is rendered from it
    Pilot(std::vector<PlannedView> plan, std::shared_ptr<const ViewSource> map,
          const Camera& camera, const Pose& T_b_c, const PilotOptions& options);

    /// Replaces the plan. The robot does not stop if the new plan begins in its direction of
    /// flight.
    /// @throws std::invalid_argument for fewer than two views
    void setPlan(std::vector<PlannedView> plan);
    /// Replaces the map; the plan stays.
    void setMap(std::shared_ptr<const ViewSource> map);

    /// Call it after an image was tracked; used for servoing on the goal's image.
    void observe(const Tracker& tracker, const TrackedFrame& tracked, const ImageF& image);

    /// Velocity for the next `dt` seconds, within the limits of the route.
    /// @param time now [s]
    BodyVelocity command(const Tracker& tracker, double time, double dt);

    /// Whether the belief has been at the goal for long enough, or the image equals the goal's.
    bool hasArrived(const Tracker& tracker, double time) const;
    bool hasGivenUp(const Tracker& tracker, double time) const;

    /// Whether photometric servoing at the goal was used.
    bool hasServoedOnImage() const { return hasServoedOnImage_; }
    const Route& route() const { return route_; }

  private:
    BodyVelocity decide(const Tracker& tracker, double time, double dt);
    BodyVelocity alongRoute(const Tracker& tracker, double time, double dt);
    Route::Reference advance(Route& route, const Tracker& tracker, double dt) const;
    BodyVelocity follow(const Route::Reference& reference, const UncertainPose& belief);
    void beginSearch(const Tracker& tracker, double time);
    void continueSearch(const Tracker& tracker, double time);
    void endSearch();
    void rejoinPlan(const UncertainPose& belief);
    void followRoute(Route route);
    std::optional<Pose> nearestView(const UncertainPose& belief) const;
    IsFree untouchedBy(const UncertainPose& belief) const;
    bool isSearchSafe(const UncertainPose& belief) const;
    bool isCertainViewNearer(const Tracker& tracker) const;
    Pose bodyOf(const Pose& T_c_w) const { return T_c_w.inverse() * T_b_c_.inverse(); }
    void approachOnImage(const ImageF& image, const Pose& T_w_b);
    void leaveImage();
    std::optional<PhotometricServo> servoToGoal() const;
    ViewSearch searchInMap() const;

    std::shared_ptr<const ViewSource> map_;
    Camera camera_;
    Pose T_b_c_;
    PilotOptions options_;
    Route route_;
    WaypointServo servo_;
    std::optional<PhotometricServo> goalServo_;  // none without photometricGoal
    ViewSearch search_;
    std::optional<double> searchSince_;  ///< [s]
    std::optional<Pose> searched_;       ///< body pose of the search; none: the route is followed
    FlownWay flown_;                     ///< since the last view that determined the pose
    std::optional<Route> wayBack_;       ///< to that view, while tracking is lost
    bool hasMissedGoal_ = false;  ///< the belief reached the goal, but was not certain enough
    BodyVelocity command_;
    Eigen::Matrix3d axes_ = Eigen::Matrix3d::Identity();  // R_w_b believed at that command
    std::optional<double> atGoalSince_;                   ///< [s]
    std::optional<BodyVelocity> onImage_;  ///< velocity by photometric servoing at the goal
    int smallSteps_ = 0;  ///< consecutive small displacements from the goal's image
    bool hasServoedOnImage_ = false;
};

}  // namespace photonav
