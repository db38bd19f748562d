// SPDX-License-Identifier: BSD-3-Clause
// A flight as a film.
#pragma once

#include <atomic>
#include <filesystem>
#include <functional>

#include "figures/top_view.hpp"
#include "flightlog/flight_log.hpp"

namespace photonav {

/// Writes a film (WebM, VP8) of a flight at twice its speed; of a long one faster, so that it lasts
/// at most forty seconds. The last frame stays for a second.
/// @param log at least one moment; @param scene from above: its area, background, start and goal
/// @param onFrame called with the share that is done, at most 1; may be empty
/// @param interrupted when set, the film ends there
/// @throws InputError where it cannot be written, or OpenCV cannot encode it
void writeFilm(const std::filesystem::path& file, const FlightLog& log, const TopView& scene,
               const std::atomic<bool>& interrupted,
               const std::function<void(double share)>& onFrame = {});

}  // namespace photonav
