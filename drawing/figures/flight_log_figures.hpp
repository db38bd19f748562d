// SPDX-License-Identifier: BSD-3-Clause
// Figures of a flight from its log.
#pragma once

#include "figures/flight_log_pictures.hpp"
#include "figures/top_view.hpp"
#include "flightlog/flight_log.hpp"

namespace photonav {

/// Moments of the flight from left to right, at equal distances flown; from above the scene with
/// tree, plan and way flown, what is free at the height of the robot, and the information of views.
/// @param log at least one moment
/// @param scene from above: its area, background, start and goal
Figure stagesFigure(const FlightLog& log, const TopView& scene, std::size_t columns = 4);

/// At most a dozen plans, evenly chosen, and the way flown.
Figure plansFigure(const FlightLog& log, const TopView& scene);

/// The frames of a film: scene, obstacles, information, images and uncertainty. All have the same
/// size.
class FilmScript {
  public:
    /// @param log at least one moment; both must outlive the script
    FilmScript(const FlightLog& log, const TopView& scene);

    /// @param time [s]; @param moment the last one before it, or the first
    Figure frame(double time, std::size_t moment) const;

  private:
    Plot tracePanel(double time) const;

    const FlightLog& log_;
    const TopView& scene_;
    Plot::Points traces_;  // over time
    LevelRange range_;
};

/// The truth until a time, in w [m].
Plot::Points flownUntil(const FlightLog& log, double time);

}  // namespace photonav
