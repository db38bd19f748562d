// SPDX-License-Identifier: BSD-3-Clause
// Progress along a plan, and the reference to fly next.
#pragma once

#include <span>
#include <vector>

#include "control/smooth_path.hpp"
#include "control/view_search.hpp"
#include "geometry/uncertain_pose.hpp"

namespace photonav {

/// A step of a plan: a pose and the covariance that the plan predicts there.
struct PlannedView {
    Pose T_w_b = Pose::Identity();
    /// Predicted covariance of T_c_w (camera frame, left perturbation) after the image taken here.
    Matrix6 covariance = Matrix6::Zero();
    double distance = 0.;     ///< distance from the start along the path [m]
    bool isWaypoint = false;  ///< a vertex of the path; the plan relies on the image taken here
};

struct RouteOptions {
    MotionLimits limits = {};
    /// Share of the acceleration limits that the route uses; the rest is left to corrections.
    double accelerationShare = 0.75;
    /// Time constant with which the body's velocity in the world responds to commands [s]. The
    /// velocity of the route is ahead by this time.
    double responseTime = 0.25;
    PathTolerance tolerance = {};  ///< largest distance of the smooth path from the plan
    /// The believed position counts as on the route within toleranceSigmas of its standard
    /// deviations, at least the tolerance of the path and at most maxTolerance [m]. Farther away
    /// the flight slows down; at twice this distance it waits.
    double toleranceSigmas = 1.;
    double maxTolerance = 0.2;
};

/// Follows a plan on a smooth path as fast as the limits allow, and stops at the last view only. It
/// slows down before a waypoint if the belief needs its view, so that the view is seen from near.
class Route {
  public:
    /// @param plan at least two views
    /// @param velocity of the body at the first view, in its own axes: the initial velocity
    /// @throws std::invalid_argument for a shorter plan, and as SmoothPath does
    Route(std::vector<PlannedView> plan, const Pose& T_b_c, const RouteOptions& options,
          const BodyVelocity& velocity = {});

    /// The pose on the route now, and the velocity of the route one response time later.
    struct Reference {
        Pose T_w_b = Pose::Identity();  ///< level
        BodyVelocity velocity;          ///< in the believed axes of the body
    };
    /// Goes on for `dt` seconds, as far as the believed pose allows.
    /// @param isFree whether the body may fly to a position; the route slows down and stops before
    ///        positions where it may not. Empty: it may fly anywhere
    Reference advance(const UncertainPose& belief, double dt, const IsFree& isFree = {});
    /// Call it when the robot left the route or stopped: the route goes on from standstill.
    void halt() { rate_ = 0.; }

    /// The route after an excursion back along it: it leads from a pose of the body to the nearest
    /// position on the part already flown, and from there along the plan.
    Route rejoined(const Pose& T_w_b) const;

    /// Whether the belief was at the goal at the last advance().
    bool isAtGoal() const { return atGoal_; }

    /// Whether a belief is wider than the route tolerates, and the plan predicts less than half of
    /// its variance after this view.
    bool needs(const PlannedView& view, const UncertainPose& belief) const;

    const PlannedView& lastWaypoint() const { return plan_[passed_]; }
    /// The views not yet passed, the next one first; the goal is always among them.
    std::span<const PlannedView> ahead() const { return std::span(plan_).subspan(next_); }
    const PlannedView& goal() const { return plan_.back(); }
    Pose cameraAt(const Pose& T_w_b) const { return (T_w_b * T_b_c_).inverse(); }

    /// Distance along the plan until now [m].
    double distance() const;

  private:
    double tolerance(const UncertainPose& belief) const;
    double along(const Station& slope, const Station& offset) const;
    double allowedRate(const UncertainPose& belief, const Station& offset) const;
    double approachRate(const UncertainPose& belief) const;
    double freeRate(const Eigen::Vector3d& offset_w, const IsFree& isFree) const;
    void passViews(const UncertainPose& belief);

    std::vector<PlannedView> plan_;
    Pose T_b_c_;
    RouteOptions options_;
    SmoothPath path_;
    double phase_ = 0.;  // along the path [s]
    double rate_ = 0.;
    std::size_t next_ = 1;    // view
    std::size_t passed_ = 0;  // the last waypoint
    bool atGoal_ = false;
};

}  // namespace photonav
