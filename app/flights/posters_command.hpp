// SPDX-License-Identifier: BSD-3-Clause
// `photonav posters`: which posters or carpets make a path, or a goal, most certain.
#pragma once

#include <atomic>
#include <string>

#include "flights/servo_command.hpp"
#include "posters/poster_study.hpp"

namespace photonav {

/// The servo of ServoOptions::study runs at the goal.
struct PostersOptions : ServoOptions {
    std::string candidates;       ///< YAML file of readPosters()
    std::string trajectory;       ///< file of readGivenTrajectory(); empty: planned
    std::string rankBy = "path";  ///< path or goal
    bool goalOnly = false;        ///< no path at all
    std::size_t most = 1;
    unsigned jobs = 1;
};

/// Ranks the candidates of a file, and the scene without them, and writes result.json, config.yaml,
/// sigma.png, maps.png, goals.png, report.json and report.html.
/// @return the exit code: 1 when even the best set has no path that keeps the camera localised or,
///         ranked by the goal, leaves a direction open there
/// @throws InputError for bad input, before anything is written
int runPosters(const PostersOptions& options, const std::atomic<bool>& interrupted);

}  // namespace photonav
