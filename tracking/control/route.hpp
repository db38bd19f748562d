// SPDX-License-Identifier: BSD-3-Clause
// How far along its plan a flight is, and what to fly next.
#pragma once

#include <functional>
#include <span>
#include <vector>

#include "control/smooth_path.hpp"
#include "geometry/uncertain_pose.hpp"

namespace photonav {

/// A step of a plan: a pose, and the covariance predicted there.
struct PlannedView {
    Pose T_w_b = Pose::Identity();
    /// Predicted, of T_c_w (camera frame, left), with the image taken here.
    Matrix6 covariance = Matrix6::Zero();
    double distance = 0.;     ///< length of the path so far [m]
    bool isWaypoint = false;  ///< the plan counts on the image taken here
};

struct RouteOptions {
    MotionLimits limits = {};
    /// Share of the limits of acceleration that the route makes use of; the rest is left to
    /// corrections.
    double accelerationShare = 0.75;
    /// Time constant of the body's response to commands, which velocities of the route anticipate
    /// [s].
    double responseTime = 0.25;
    PathTolerance tolerance = {};  ///< of the curve around the plan
    /// A believed position is on the route within this many of its standard deviations, but not
    /// below the tolerance of the curve nor above this [m]. Farther away the flight goes on more
    /// slowly, at twice as far it waits until the belief is nearer.
    double toleranceSigmas = 1.;
    double maxTolerance = 0.2;
};

/// Passes a plan's views on a smooth path, as fast as its limits allow, and stops at the last. A
/// waypoint whose view the belief needs is approached more slowly, to be seen from near.
class Route {
  public:
    /// @param plan at least two views
    /// @param velocity of the body at the first one, in its own axes: the route goes on from it
    /// @throws std::invalid_argument for a shorter plan, and as SmoothPath does
    Route(std::vector<PlannedView> plan, const Pose& T_b_c, const RouteOptions& options,
          const BodyVelocity& velocity = {});

    /// Where the body should be now, and the velocity of the route a response time later.
    struct Reference {
        Pose T_w_b = Pose::Identity();  ///< level
        BodyVelocity velocity;          ///< in the believed axes of the body
    };
    /// Goes on for `dt` seconds, as far as the believed pose allows.
    /// @param isFree where the body may be believed: the route slows down before a place that is
    /// not, and stops; empty: everywhere
    Reference advance(const UncertainPose& belief, double dt,
                      const std::function<bool(const Eigen::Vector3d& p_w)>& isFree = {});
    /// The flight was interrupted: the route goes on from standstill.
    void halt() { rate_ = 0.; }

    /// The same plan after an excursion back along it: from a pose of the body to the nearest place
    /// of the part that was flown, and on from there.
    Route rejoined(const Pose& T_w_b) const;

    /// Whether the belief was at the goal at the last advance().
    bool isAtGoal() const { return atGoal_; }

    /// Whether a belief is wider than the route tolerates, and the plan expects less than half of
    /// its variance at this view.
    bool needs(const PlannedView& view, const UncertainPose& belief) const;

    const PlannedView& lastWaypoint() const { return plan_[passed_]; }
    /// Views that are still to be passed, the next one first; the goal is always among them.
    std::span<const PlannedView> ahead() const { return std::span(plan_).subspan(next_); }
    const PlannedView& goal() const { return plan_.back(); }
    Pose cameraAt(const Pose& T_w_b) const { return (T_w_b * T_b_c_).inverse(); }

    /// Way along the plan until now [m].
    double distance() const;

  private:
    double tolerance(const UncertainPose& belief) const;
    double along(const Station& slope, const Station& offset) const;
    double allowedRate(const UncertainPose& belief, const Station& offset) const;
    double approachRate(const UncertainPose& belief) const;
    double freeRate(const Eigen::Vector3d& offset_w,
                    const std::function<bool(const Eigen::Vector3d& p_w)>& isFree) const;
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
