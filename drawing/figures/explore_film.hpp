// SPDX-License-Identifier: BSD-3-Clause
// Films of flights.
#pragma once

#include <atomic>
#include <filesystem>
#include <functional>

#include "figures/top_view.hpp"
#include "flightlog/flight_log.hpp"

namespace photonav {

/// Writes a film (WebM, VP8) of a flight at twice its speed, or faster for long flights, so that it
/// lasts at most forty seconds. The last frame is shown for one more second.
/// @param log must have at least one moment
/// @param scene gives area, background, start and goal of the view from above
/// @param interrupted when set, the film ends with the frames so far
/// @param onFrame called after each frame with the share done, at most 1; may be empty
/// @throws InputError if the file cannot be written, or OpenCV cannot encode the film
void writeFilm(const std::filesystem::path& file, const FlightLog& log, const TopView& scene,
               const std::atomic<bool>& interrupted,
               const std::function<void(double share)>& onFrame = {});

}  // namespace photonav
