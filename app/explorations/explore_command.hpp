// SPDX-License-Identifier: BSD-3-Clause
// `photonav explore`: flies to a goal in an unknown scene.
#pragma once

#include <atomic>
#include <filesystem>

#include "shared/many_runs.hpp"

namespace photonav {

/// Options of the command. The flights depend only on the config (ExploreConfig) with its
/// overrides.
struct ExploreOptions : ManyRunsOptions {
    std::filesystem::path record;  ///< folder for a recording of the first flight; empty: none
    std::string serve;             ///< "[ADDRESS:]PORT" of a server that shows the first flight
                                   ///< while it is flown; empty: no server
    bool film = false;             ///< also write film.webm, a film of the first flight
};

/// Flies all trials, or merges the shards of an exploration. Writes trials.jsonl, result.json,
/// config.yaml, figures, report.json and report.html, and for the first flight map.ot, flight.json,
/// trajectory.tum, .cov and .ov, and groundtruth.tum.
/// @param interrupted when set, all flights end; the results contain the complete flights, and the
///        first flight even if it is incomplete (exit code 130)
/// @return the exit code: kDone if a flight of the first planner arrived, otherwise kNoAnswer
/// @throws InputError for bad input, before anything is written
int runExplore(const ExploreOptions& options, const std::atomic<bool>& interrupted);

}  // namespace photonav
