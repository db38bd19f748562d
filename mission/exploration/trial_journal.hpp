// SPDX-License-Identifier: BSD-3-Clause
// The file that keeps each of many explorations as soon as it ended, and what makes two sets of
// explorations the same.
#pragma once

#include "exploration/explorations.hpp"
#include "runs/journal.hpp"

namespace photonav {

/// Flights of an unknown scene, for Journal. A line holds what results, figures and summaries of
/// explorations read of a flight; numbers have all digits. The map of a flight that has one is
/// kMapFile beside the journal: at most one flight of a journal keeps its map.
struct TrialKind {
    using Item = TrialItem;
    using Run = ExplorationResult;
    static constexpr RunWords kWords{"explore", "trials.jsonl", "flight", "an exploration",
                                     "the exploration"};
    static constexpr const char* kMapFile = "map.ot";

    static TrialItem itemOf(const Run& flight) { return photonav::itemOf(flight); }
    /// The config without what flights set themselves, and without the section of sweeps.
    static Identity identity(const Config& config);
    static Identity runIdentity(const Identity& exploration);
    static nlohmann::json save(const Run& flight, const std::filesystem::path& folder);
    /// A map that is missing leaves the flight without.
    /// @throws std::exception for numbers that no flight gives; InputError for a damaged map
    static Run load(const nlohmann::json& line, const std::filesystem::path& folder);
};

using TrialJournal = Journal<TrialKind>;

/// A result shows the map of its first flight: the others drop theirs. A first flight that has none
/// is dropped, to be flown again.
void keepMapOf(const TrialItem& first, std::vector<ExplorationResult>& flights);

}  // namespace photonav
