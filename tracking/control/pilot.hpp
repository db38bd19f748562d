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
    double servoGain = 1.5;       ///< of the pose error's exponential decrease [1/s]
    bool photometricGoal = true;  ///< servo on the goal's image where it determines all velocities
    PhotometricOptions photometric;  ///< of that image
    double hoverTime = 1.;           ///< waited on the spot after a loss before flying on [s]
    double giveUpTime = 20.;         ///< searched in vain before giving up [s]
    /// Distance of a place of the world from obstacles [m]; empty: unknown. Then there are no
    /// searches off the plan, and a lost robot stops for nothing.
    std::function<double(const Eigen::Vector3d& p_w)> clearance;
    double radius = 0.2;      ///< kept free by searches off the plan [m]
    double bodyRadius = 0.1;  ///< an obstacle nearer than this is touched [m]
};

/// Flies past the views of a plan on a smooth path, with its velocity and visual servoing on the
/// believed pose; at the goal on its image. A waypoint at which the belief is much wider than
/// planned, so that its view cannot have been seen, begins a search for a view around that narrows
/// it; what is not found in time leaves the route as uncertain as before, and a goal not reached
/// for certain is given up. While tracking is lost the pilot hovers, then flies back on the way it
/// came to the last view that determined the pose, or on along the route to one that should narrow
/// the belief, whichever is nearer; but only as far as the body touches nothing wherever within
/// three standard deviations it is. There it hovers, which adds little to the errors of odometry.
/// It gives up after a while.
class Pilot {
  public:
    /// @param plan at least two views @throws std::invalid_argument otherwise
    /// @param map in which the goal's image is rendered
    Pilot(std::vector<PlannedView> plan, std::shared_ptr<const ViewSource> map,
          const Camera& camera, const Pose& T_b_c, const PilotOptions& options);

    /// Flies another plan from now on, without a stop where it goes on in the same direction.
    /// @throws std::invalid_argument below two views
    void setPlan(std::vector<PlannedView> plan);
    /// Exchanges the map; the plan stays.
    void setMap(std::shared_ptr<const ViewSource> map);

    /// An image was tracked: for servoing on the goal's.
    void observe(const Tracker& tracker, const TrackedFrame& tracked, const ImageF& image);

    /// Velocity for the next `dt` seconds, within the limits of the route.
    /// @param time now [s]
    BodyVelocity command(const Tracker& tracker, double time, double dt);

    /// Whether the belief has been at the goal for long enough, or the image is the goal's.
    bool hasArrived(const Tracker& tracker, double time) const;
    bool hasGivenUp(const Tracker& tracker, double time) const;

    /// Whether the goal's image was servoed on.
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
    bool isCertainViewNearer(const Tracker& tracker) const;
    Pose bodyOf(const Pose& T_c_w) const { return T_c_w.inverse() * T_b_c_.inverse(); }
    void approachOnImage(const ImageF& image, const Pose& T_w_b);
    void leaveImage();
    PhotometricServo servoToGoal() const;
    ViewSearch searchInMap() const;

    std::shared_ptr<const ViewSource> map_;
    Camera camera_;
    Pose T_b_c_;
    PilotOptions options_;
    Route route_;
    WaypointServo servo_;
    PhotometricServo goalServo_;
    ViewSearch search_;
    std::optional<double> searchSince_;  ///< [s]
    std::optional<Pose> searched_;       ///< body pose to search from; none: the route goes on
    FlownWay flown_;                     ///< since the last view that determined the pose
    std::optional<Route> wayBack_;       ///< to that view, while tracking is lost
    bool hasMissedGoal_ = false;         ///< at the goal, but not for certain
    BodyVelocity command_;
    std::optional<double> atGoalSince_;    ///< [s]
    std::optional<BodyVelocity> onImage_;  ///< wanted by the goal's image
    int smallSteps_ = 0;                   ///< in a row
    bool hasServoedOnImage_ = false;
};

}  // namespace photonav
