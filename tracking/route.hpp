// SPDX-License-Identifier: BSD-3-Clause
// How far along its plan a flight is, and which view to fly to.
#pragma once

#include <vector>

#include "flight.hpp"

namespace photonav {

/// Between waypoints the wanted view is a little ahead; a waypoint must be reached, as well as the
/// belief can tell.
class Route {
  public:
    Route(const std::vector<PlannedView>& plan, const Pose& T_b_c, const FlightOptions& options)
        : plan_(plan), T_b_c_(T_b_c), options_(options) {}

    /// Moves on as far as the believed pose allows. @return the view to fly to
    const PlannedView& advance(const UncertainPose& belief);

    /// Whether the last waypoint was reached.
    bool isAtGoal() const { return atGoal_; }

    const PlannedView& wanted() const { return plan_[wanted_]; }
    const PlannedView& goal() const { return plan_.back(); }
    Pose cameraAt(const PlannedView& view) const { return (view.T_w_b * T_b_c_).inverse(); }

    /// Way along the plan of its point nearest to here, among those around the wanted view [m].
    double progress(const Pose& T_c_w) const;

  private:
    bool isReached(const UncertainPose& belief) const;
    Pose bodyOf(const Pose& T_c_w) const { return T_c_w.inverse() * T_b_c_.inverse(); }

    const std::vector<PlannedView>& plan_;
    Pose T_b_c_;
    FlightOptions options_;
    std::size_t wanted_ = 1;
    std::size_t passed_ = 0;  // the last waypoint reached
    bool atGoal_ = false;
};

}  // namespace photonav
