// SPDX-License-Identifier: BSD-3-Clause
// The results of the runs of a sweep, and the journal that stores them.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "geometry/types.hpp"
#include "runs/journal.hpp"
#include "sweep/sweep_plan.hpp"

namespace photonav {

/// The result of one run. Numbers about the path are NaN if no path was found.
struct SweepRun {
    SweepItem item;
    double cost, length, meanTrace, goalTrace;  ///< as in EvaluatedPath, with the item's alpha
    std::size_t vertices = 0;
    std::size_t views = 0;    ///< views rendered by this run, which starts without cached views
    double seconds = 0.;      ///< wall-clock time of planning without cached views [s]
    std::string status;       ///< "done", or the reason why there is no path
    std::vector<Place> path;  ///< waypoints of the body

    bool isSolved() const { return status == "done"; }
};

/// The kind of run that a sweep stores in a Journal.
struct SweepKind {
    using Item = SweepItem;
    using Run = SweepRun;
    static constexpr RunWords kWords{"sweep", "runs.jsonl", "run", "a sweep", "the sweep"};

    static const Item& itemOf(const Run& run) { return run.item; }
    static Identity identity(const Config& config) { return sweepIdentity(config); }
    static Identity runIdentity(const Identity& sweep) { return photonav::runIdentity(sweep); }
    static nlohmann::json save(const Run& run, const std::filesystem::path& folder);
    /// @throws std::exception for values that no run can have
    static Run load(const nlohmann::json& line, const std::filesystem::path& folder);
    static nlohmann::json reproducible(const Run& run);
};

using SweepJournal = Journal<SweepKind>;

/// A run as an object of result.json, without `path`.
nlohmann::json toJson(const SweepRun& run);

}  // namespace photonav
