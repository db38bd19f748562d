// SPDX-License-Identifier: BSD-3-Clause
// How far along its plan a flight is, and which view to fly to.
#pragma once

#include <span>
#include <vector>

#include "geometry/uncertain_pose.hpp"

namespace photonav {

/// A step of a plan: a pose, and the covariance predicted there.
struct PlannedView {
    Pose T_w_b = Pose::Identity();
    /// Predicted, of T_c_w (camera frame, left), with the image taken here.
    Matrix6 covariance = Matrix6::Zero();
    double distance = 0.;     ///< way of the position so far [m]
    bool isWaypoint = false;  ///< to be reached, not only passed near
};

struct RouteOptions {
    double lookahead = 0.7;  ///< between waypoints, the view flown to is this far ahead [m]
    /// A waypoint counts as reached within this many standard deviations of the believed position,
    /// but not below or above these distances [m], and within `yawTolerance` [rad].
    double toleranceSigmas = 1.;
    double minTolerance = 0.05;
    double maxTolerance = 0.2;
    double yawTolerance = 0.1;
};

/// Between waypoints the target view is a little ahead; a waypoint must be reached, within the
/// uncertainty of the belief.
class Route {
  public:
    /// @param plan at least two views @throws std::invalid_argument otherwise
    Route(std::vector<PlannedView> plan, const Pose& T_b_c, const RouteOptions& options);

    /// Moves on as far as the believed pose allows. @return the view to fly to
    const PlannedView& advance(const UncertainPose& belief);

    /// Whether the belief was at the last waypoint at the last advance().
    bool isAtGoal() const { return atGoal_; }

    const PlannedView& target() const { return plan_[target_]; }
    const PlannedView& lastWaypoint() const { return plan_[passed_]; }
    /// Views that are still to be flown to, the target first.
    std::span<const PlannedView> ahead() const { return std::span(plan_).subspan(target_); }
    const PlannedView& goal() const { return plan_.back(); }
    Pose cameraAt(const PlannedView& view) const { return (view.T_w_b * T_b_c_).inverse(); }

    /// Way along the plan of its point nearest to here, among those around the target view [m].
    double progress(const Pose& T_c_w) const;

  private:
    bool isReached(const UncertainPose& belief) const;
    Pose bodyOf(const Pose& T_c_w) const { return T_c_w.inverse() * T_b_c_.inverse(); }

    std::vector<PlannedView> plan_;
    Pose T_b_c_;
    RouteOptions options_;
    std::size_t target_ = 1;
    std::size_t passed_ = 0;  // the last waypoint reached
    bool atGoal_ = false;
};

}  // namespace photonav
