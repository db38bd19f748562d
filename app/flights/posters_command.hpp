// SPDX-License-Identifier: BSD-3-Clause
// `photonav posters`: ranks posters and carpets by the uncertainty along a path or at a goal.
#pragma once

#include <atomic>
#include <string>

#include "flights/servo_command.hpp"
#include "posters/poster_study.hpp"

namespace photonav {

/// Options of the command. ServoOptions::study describes the servoing at the goal.
struct PostersOptions : ServoOptions {
    std::string candidates;       ///< YAML file for readPosters()
    std::string trajectory;       ///< file for readGivenTrajectory(); empty: paths are planned
    std::string rankBy = "path";  ///< rank by "path" or "goal"
    bool goalOnly = false;        ///< no paths; rank by the goal
    std::size_t most = 1;         ///< largest number of candidates in a set
    unsigned jobs = 1;            ///< number of threads
};

/// Ranks the candidates of a file, and the scene without them. Writes result.json, config.yaml,
/// sigma.png (if there is a path), maps.png, goals.png, report.json and report.html.
/// @param interrupted when set, the sets evaluated so far are ranked (exit code 130)
/// @return the exit code. Ranked by the path, kNoAnswer if the best set has no path on which the
///         camera stays localised; ranked by the goal, kNoAnswer if the view at the goal leaves a
///         direction open with the best set.
/// @throws InputError for bad input, before anything is written
int runPosters(const PostersOptions& options, const std::atomic<bool>& interrupted);

}  // namespace photonav
