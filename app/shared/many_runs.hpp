// SPDX-License-Identifier: BSD-3-Clause
// Commands of many runs: --jobs, --resume, --shard and --merge.
#pragma once

#include <fmt/format.h>

#include <functional>
#include <map>
#include <optional>

#include "io/error.hpp"
#include "runs/journal.hpp"
#include "shared/command_io.hpp"
#include "shared/result_folder.hpp"

namespace photonav {

struct ManyRunsOptions : CommandOptions {
    unsigned jobs = 1;                 ///< threads
    std::optional<std::string> shard;  ///< "k/n"
    std::vector<std::string> merge;    ///< folders of shards: no runs, only the result
    bool resume = false;               ///< go on with what the result folder holds, or extend it
};

/// Whether the folders of shards are to be merged.
/// @throws InputError for options that exclude each other, and where there is no config to run
bool isMerge(const ManyRunsOptions& options, const RunWords& words);

/// The shard asked for, else the whole. @throws InputError as parseShard()
Shard shardOf(const ManyRunsOptions& options);

/// The folder of the options, or out/<command>-<name>, with -<k>of<n> for a shard.
std::filesystem::path folderOf(const ManyRunsOptions& options, const RunWords& words,
                               const std::string& name, const Shard& shard);

/// Begins the result at a folder, where unfinished work stays.
/// @param inputs besides the config and the shards
/// @throws InputError also when the folder is or contains an input
FolderTransaction beginRuns(const ManyRunsOptions& options, const std::filesystem::path& folder,
                            InputPaths inputs);

/// Remaining time from what each planner's runs took so far.
class RemainingTime {
  public:
    /// @param open the items still to do, which name a planner
    template <typename Item>
    explicit RemainingTime(const std::vector<Item>& open) {
        for (const Item& item : open) ++open_[item.planner];
    }

    /// @param seconds that the run took; @param wall since the first one began [s]
    void count(const std::string& planner, double seconds, double wall);

    /// Time that is left, times what the clock showed per second of a run. @param wall now [s]
    double seconds(double wall) const;

    /// ", about 3 min left"; empty before the first run has ended.
    std::string text(double wall) const;

  private:
    std::pair<double, double> all() const;

    std::map<std::string, double> open_;                      // runs
    std::map<std::string, std::pair<double, double>> taken_;  // seconds, runs
    double wall_ = 0.;
};

/// "90 s", "12 min", "3.5 h".
std::string durationText(double seconds);

/// Where the runs so far are: in the unfinished folder of a killed program, in the result, or
/// nowhere.
/// @throws InputError for runs of a killed program without --resume
template <typename Kind>
std::optional<Journal<Kind>> earlierRuns(const ManyRunsOptions& options,
                                         const FolderTransaction& folder) {
    using Runs = Journal<Kind>;
    const auto hasRuns = [](const std::filesystem::path& path) {
        return std::filesystem::exists(path / Runs::kFileName);
    };
    if (hasRuns(folder.path())) {
        Runs journal = Runs::read(folder.path());
        if (options.resume) return journal;
        if (journal.runs().empty()) return {};
        throw InputError(folder.path().string(), "",
                         fmt::format("holds {} {}s of {} that was killed: go on with --resume, or "
                                     "remove that folder",
                                     journal.runs().size(), Kind::kWords.run, Kind::kWords.aWhole));
    }
    if (!options.resume || !hasRuns(folder.target())) return {};
    return Runs::read(folder.target());
}

/// @throws InputError unless the runs of a journal are those of `wanted`. Which runs are wanted may
///         have changed, what they depend on may not.
void checkIsSame(const JournalHeader& found, const JournalHeader& wanted, const RunWords& words,
                 const std::function<Identity(const Identity&)>& runIdentity,
                 const std::filesystem::path& file);

/// The runs to go on with: those of a killed program, or of one that ended; none without --resume.
/// @throws InputError for runs of another config
template <typename Kind>
std::vector<typename Kind::Run> runsSoFar(const ManyRunsOptions& options,
                                          const FolderTransaction& folder,
                                          const JournalHeader& header) {
    const auto journal = earlierRuns<Kind>(options, folder);
    if (!journal) return {};
    checkIsSame(journal->header(), header, Kind::kWords, Kind::runIdentity, journal->file());
    return journal->runs();
}

/// @throws InputError naming the folder that is being written
void checkIsNotWritten(const std::string& folder);

/// @throws InputError naming the folder that does not fit, or the shard that is missing
void checkMakeOneWhole(const std::vector<std::string>& folders,
                       const std::vector<JournalHeader>& shards);

/// The shards to merge. @throws InputError unless they make one whole
template <typename Kind>
std::vector<Journal<Kind>> readShards(const std::vector<std::string>& folders) {
    std::vector<Journal<Kind>> shards;
    std::vector<JournalHeader> headers;
    for (const std::string& folder : folders) {
        checkIsNotWritten(folder);
        headers.push_back(shards.emplace_back(Journal<Kind>::read(folder)).header());
    }
    checkMakeOneWhole(folders, headers);
    return shards;
}

/// @throws InputError where the result would replace one of its shards
void checkIsNoShard(const ManyRunsOptions& options, const std::filesystem::path& target);

/// The config of the shards: the one given, which must be theirs, or the one they keep.
/// @param journal of a shard, with its `header`
Config configOfShards(const ManyRunsOptions& options, const JournalHeader& header,
                      const std::filesystem::path& journal,
                      const std::function<Config(const std::string& file)>& load,
                      const std::function<Identity(const Config&)>& identity);

/// All runs of the shards, in the order of `items`.
/// @throws InputError naming the first folder with runs to do
template <typename Kind>
std::vector<typename Kind::Run> gather(const ManyRunsOptions& options,
                                       const std::vector<Journal<Kind>>& shards,
                                       const std::vector<typename Kind::Item>& items) {
    std::map<typename Kind::Item, typename Kind::Run> all;
    for (std::size_t i = 0; i < shards.size(); ++i) {
        const auto own = itemsOf(shards[i].header().shard, items);
        const auto open = shards[i].missing(own);
        if (!open.empty()) {
            throw InputError("--merge", options.merge[i],
                             fmt::format("{} {}s are missing; finish it with --resume", open.size(),
                                         Kind::kWords.run));
        }
        for (auto& run : shards[i].runsOf(own)) all.emplace(Kind::itemOf(run), std::move(run));
    }
    std::vector<typename Kind::Run> runs;
    runs.reserve(items.size());
    for (const auto& item : items) runs.push_back(std::move(all.at(item)));
    return runs;
}

}  // namespace photonav
