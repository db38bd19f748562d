// SPDX-License-Identifier: BSD-3-Clause
// `photonav explore`: to the goal of a problem in a scene that the robot does not know.
#pragma once

#include <atomic>
#include <filesystem>

#include "shared/many_runs.hpp"

namespace photonav {

/// All that the results depend on is in the config (ExploreConfig) and its overrides.
struct ExploreOptions : ManyRunsOptions {
    std::filesystem::path record;  ///< folder for the first flight as a recording; empty: none
    std::string serve;             ///< where browsers see the first flight; empty: nowhere
    bool film = false;             ///< write one of the first flight
};

/// Flies every trial, or merges the shards of an exploration, and writes trials.jsonl, result.json,
/// config.yaml, map.ot, flight.json, trajectory.tum, .cov and .ov and groundtruth.tum of the first
/// flight, figures, report.json and report.html.
/// @param interrupted when set, flying ends with the flights that ended, and the first as far as it
///        was flown (exit code 130)
/// @return the exit code: kNoAnswer unless the first flight arrived or, with several trials, one of
///         the first planner's did
/// @throws InputError for bad input, before anything is written
int runExplore(const ExploreOptions& options, const std::atomic<bool>& interrupted);

}  // namespace photonav
