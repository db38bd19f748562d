// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>

namespace photonav {

/// How long an exploring robot waits for a way, or for its arrival, before its flight ends. All
/// times are those of the flight [s].
class Patience {
  public:
    /// An update gave a way.
    /// @param isStopped an obstacle in view is right ahead: the robot hovers until its map has it
    void onWay(bool isStopped, double time);
    /// An update gave no way that may be flown.
    void onNoWay(double time);
    /// @param toGoal distance to the goal, by the belief [m]
    /// @param isAtGoal the plan was flown to its end, at the goal
    void onStep(double toGoal, bool isAtGoal, double time);

    /// Whether six updates in a row gave no way, for two seconds or longer.
    bool hasNoWay(double time) const;
    /// Whether the obstacle right ahead does not become part of the map.
    bool isStopped(double time) const;
    /// Whether the robot was at its goal and is still around it, but too often lost to arrive.
    bool isStuckAtGoal(double time) const;

  private:
    int withoutWay_ = 0;  // updates in a row
    std::optional<double> withoutWaySince_;
    std::optional<double> stoppedSince_;
    std::optional<double> atGoalSince_;
};

}  // namespace photonav
