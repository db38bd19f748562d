// SPDX-License-Identifier: BSD-3-Clause
// The results of a sweep's runs, and their lines in its journal.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "geometry/types.hpp"
#include "runs/journal.hpp"
#include "sweep/sweep_plan.hpp"

namespace photonav {

/// The result of one run. Numbers about the path are NaN when there is none.
struct SweepRun {
    SweepItem item;
    double cost, length, meanTrace, goalTrace;  ///< as in EvaluatedPath, with the item's alpha
    std::size_t vertices = 0;
    std::size_t views = 0;    ///< rendered by this run alone, with no cached views
    double seconds = 0.;      ///< planning with no cached views; wall clock
    std::string status;       ///< "done", or why there is no path
    std::vector<Place> path;  ///< its waypoints, the body's

    bool isSolved() const { return status == "done"; }
};

/// Runs of a sweep, for Journal.
struct SweepKind {
    using Item = SweepItem;
    using Run = SweepRun;
    static constexpr RunWords kWords{"sweep", "runs.jsonl", "run", "a sweep", "the sweep"};

    static const Item& itemOf(const Run& run) { return run.item; }
    static Identity identity(const Config& config) { return sweepIdentity(config); }
    static Identity runIdentity(const Identity& sweep) { return photonav::runIdentity(sweep); }
    static nlohmann::json save(const Run& run, const std::filesystem::path& folder);
    /// @throws std::exception for numbers that no run gives
    static Run load(const nlohmann::json& line, const std::filesystem::path& folder);
};

using SweepJournal = Journal<SweepKind>;

/// A run as result.json holds it, `path` left out.
nlohmann::json toJson(const SweepRun& run);

}  // namespace photonav
