// SPDX-License-Identifier: BSD-3-Clause
// The journal that stores each exploration flight when it ends, and the identity by which sets of
// flights are compared.
#pragma once

#include "exploration/explorations.hpp"
#include "runs/journal.hpp"

namespace photonav {

/// The kind of run that an exploration stores in a Journal: flights in an unknown scene. A line
/// holds everything that results, figures and summaries use, without loss of digits. The map of a
/// flight is stored as kMapFile in the folder of the journal; at most one flight of a journal has a
/// map.
struct TrialKind {
    using Item = TrialItem;
    using Run = ExplorationResult;
    static constexpr RunWords kWords{"explore", "trials.jsonl", "flight", "an exploration",
                                     "the exploration"};
    static constexpr const char* kMapFile = "map.ot";

    static TrialItem itemOf(const Run& flight) { return photonav::itemOf(flight); }
    /// identityOf() the config without the keys that each flight sets itself, and without the
    /// section `sweep`.
    static Identity identity(const Config& config);
    static Identity runIdentity(const Identity& exploration);
    static nlohmann::json save(const Run& flight, const std::filesystem::path& folder);
    /// If the map file is missing, the flight has no map.
    /// @throws std::exception for missing or impossible values; InputError for a damaged map
    static Run load(const nlohmann::json& line, const std::filesystem::path& folder);
    static nlohmann::json reproducible(const Run& flight);
};

using TrialJournal = Journal<TrialKind>;

/// Keeps only the map of the first flight, which results show. A first flight without a map is
/// removed from the list, so that it is flown again.
void keepMapOf(const TrialItem& first, std::vector<ExplorationResult>& flights);

}  // namespace photonav
