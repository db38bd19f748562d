// SPDX-License-Identifier: BSD-3-Clause
// Figures of an exploration flight, drawn from its log.
#pragma once

#include "figures/flight_log_pictures.hpp"
#include "figures/top_view.hpp"
#include "flightlog/flight_log.hpp"

namespace photonav {

/// One column per moment, at about equal distances flown. The rows show, from above, the scene with
/// tree, plan and flown path; free and occupied space at the robot's height; and the information of
/// views.
/// @param log must have at least one moment
/// @param scene gives area, background, start and goal
/// @param columns largest number of moments
Figure stagesFigure(const FlightLog& log, const TopView& scene, std::size_t columns = 4);

/// At most twelve plans, evenly spread over the updates, and the true flown path.
/// @param log must have at least one moment
Figure plansFigure(const FlightLog& log, const TopView& scene);

/// Draws the frames of a film: scene, obstacles, information, images and uncertainty. All frames
/// have the same size.
class FilmScript {
  public:
    /// @param log must have at least one moment, and outlive the script
    /// @param scene must outlive the script
    FilmScript(const FlightLog& log, const TopView& scene);

    /// The frame at a time.
    /// @param time in the flight [s]
    /// @param moment index of the last moment before this time, or of the first moment
    Figure frame(double time, std::size_t moment) const;

  private:
    Plot tracePanel(double time) const;

    const FlightLog& log_;
    const TopView& scene_;
    Plot::Points traces_;  // time [s], trace [m^2]
    LevelRange range_;
};

/// The true camera positions until a time [s], x and y in the world frame [m].
Plot::Points flownUntil(const FlightLog& log, double time);

}  // namespace photonav
