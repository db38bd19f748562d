// SPDX-License-Identifier: BSD-3-Clause
// Commands that make many runs: the options --jobs, --resume, --shard and --merge.
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
    unsigned jobs = 1;                 ///< number of threads
    std::optional<std::string> shard;  ///< "k/n": do only the k-th of n parts; none: do all runs
    std::vector<std::string> merge;    ///< result folders of all shards, to merge without new runs
    bool resume = false;  ///< keep the finished runs of the result folder and add to them
};

/// Whether the command merges shards instead of making runs.
/// @throws InputError for options that exclude each other, and if neither a config nor shards are
///         given
bool isMerge(const ManyRunsOptions& options, const RunWords& words);

/// The shard of the option --shard; without the option, the only shard 1/1.
/// @throws InputError as parseShard() does
Shard shardOf(const ManyRunsOptions& options);

/// The result folder options.out or, if it is empty, out/<command>-<name>, with -<k>of<n> for a
/// shard.
std::filesystem::path folderOf(const ManyRunsOptions& options, const RunWords& words,
                               const std::string& name, const Shard& shard);

/// Begins to write a result folder. Its working folder is kept if the program is killed, for
/// --resume.
/// @param inputs files that the command reads, without the config and the shards
/// @throws InputError as beginResult() does
FolderTransaction beginRuns(const ManyRunsOptions& options, const std::filesystem::path& folder,
                            InputPaths inputs);

/// Estimates the remaining time from the mean duration of each planner's runs so far.
class RemainingTime {
  public:
    /// @param open items that are not yet done; each has a member `planner`
    template <typename Item>
    explicit RemainingTime(const std::vector<Item>& open) {
        for (const Item& item : open) ++open_[item.planner];
    }

    /// Adds a finished run.
    /// @param seconds duration of the run [s]
    /// @param wall wall-clock time since the first run began [s]
    void count(const std::string& planner, double seconds, double wall);

    /// Remaining wall-clock time [s]: the expected durations of all open runs, times the wall-clock
    /// time per second of finished runs (below 1 with several threads). 0 before a run has ended.
    /// @param wall wall-clock time since the first run began [s]
    double seconds(double wall) const;

    /// The remaining time as text, ", about 3 min left"; empty before the first run has ended.
    std::string text(double wall) const;

  private:
    std::pair<double, double> all() const;

    std::map<std::string, double> open_;                      // number of open runs
    std::map<std::string, std::pair<double, double>> taken_;  // seconds, runs
    double wall_ = 0.;
};

/// Prints that --resume finds no earlier runs and begins anew, unless --quiet is given.
/// @throws InputError where there is a result, of another command
void reportNewBegin(const ManyRunsOptions& options, const FolderTransaction& folder,
                    const RunWords& words);

/// The journal of earlier runs: from the working folder of a killed program or, with --resume, from
/// the result folder. Nothing if there is neither, which --resume says on standard error.
/// @throws InputError if a killed program left runs, and --resume is not given; for --resume where
///         the result is another command's
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
                         fmt::format("holds {} {}s of {} that did not end: go on with --resume, or "
                                     "remove that folder",
                                     journal.runs().size(), Kind::kWords.run, Kind::kWords.aWhole));
    }
    if (!options.resume) return {};
    if (hasRuns(folder.target())) return Runs::read(folder.target());
    reportNewBegin(options, folder, Kind::kWords);
    return {};
}

/// Checks that the runs of an earlier journal can be kept: they must have the same shard and depend
/// on the same values. The choice of runs may differ.
/// @param found header of the earlier journal
/// @param wanted header of the new journal
/// @param runIdentity removes from an identity the keys that only choose the runs
/// @param file the earlier journal, for the message
/// @throws InputError if they cannot be kept
void checkIsSame(const JournalHeader& found, const JournalHeader& wanted, const RunWords& words,
                 const std::function<Identity(const Identity&)>& runIdentity,
                 const std::filesystem::path& file);

/// The finished runs to keep with --resume, of a killed or of a complete command; none without
/// --resume.
/// @throws InputError as earlierRuns() and checkIsSame() do
template <typename Kind>
std::vector<typename Kind::Run> runsSoFar(const ManyRunsOptions& options,
                                          const FolderTransaction& folder,
                                          const JournalHeader& header) {
    const auto journal = earlierRuns<Kind>(options, folder);
    if (!journal) return {};
    checkIsSame(journal->header(), header, Kind::kWords, Kind::runIdentity, journal->file());
    return journal->runs();
}

/// Whether an interrupted command leaves an earlier result in its place, because not every run of
/// that is one of its own. Its own runs then stay in the working folder for --resume, as a line on
/// standard error says.
template <typename Kind>
bool leavesEarlierRuns(const FolderTransaction& folder, const Journal<Kind>& own) {
    if (!folder.hasEarlier()) return false;
    if (std::filesystem::exists(folder.target() / Journal<Kind>::kFileName) &&
        own.includes(Journal<Kind>::read(folder.target()))) {
        return false;
    }
    printMessage(
        fmt::format("the earlier result in {} stays; --resume goes on with this one ({} {}s "
                    "have ended)",
                    folder.target().string(), own.runs().size(), Kind::kWords.run));
    return true;
}

/// Checks that no other process is writing a folder.
/// @throws InputError naming the folder if a process is writing it
void checkIsNotWritten(const std::string& folder);

/// Checks that shards belong together and are complete: each of the n shards once, with the same
/// config.
/// @param shards headers of the journals in `folders`
/// @throws InputError naming a folder that does not belong to the first one, or a missing shard
void checkMakeOneWhole(const std::vector<std::string>& folders,
                       const std::vector<JournalHeader>& shards);

/// Checks that runs which several shards have are the same.
/// @throws InputError naming the run and the journals whose results differ
template <typename Kind>
void checkAgree(const std::vector<Journal<Kind>>& shards) {
    std::map<typename Kind::Item, std::pair<const typename Kind::Run*, std::string>> known;
    for (const Journal<Kind>& shard : shards) {
        for (const auto& run : shard.runs()) {
            const std::string file = shard.file().string();
            const auto [first, isNew] = known.try_emplace(Kind::itemOf(run), &run, file);
            const auto& [other, otherFile] = first->second;
            if (isNew || Kind::reproducible(*other) == Kind::reproducible(run)) continue;
            throw InputError(
                "--merge", file,
                fmt::format("{}: has another result in {}", nameOf(first->first), otherFile));
        }
    }
}

/// Reads the journals of the shards to merge.
/// @throws InputError as checkIsNotWritten(), Journal::read(), checkMakeOneWhole() and
///         checkAgree() do
template <typename Kind>
std::vector<Journal<Kind>> readShards(const std::vector<std::string>& folders) {
    std::vector<Journal<Kind>> shards;
    std::vector<JournalHeader> headers;
    for (const std::string& folder : folders) {
        checkIsNotWritten(folder);
        headers.push_back(shards.emplace_back(Journal<Kind>::read(folder)).header());
    }
    checkMakeOneWhole(folders, headers);
    checkAgree(shards);
    return shards;
}

/// Checks that the result folder is not the folder of a shard.
/// @throws InputError naming the shard that the result would replace
void checkIsNoShard(const ManyRunsOptions& options, const std::filesystem::path& target);

/// The config of the shards: the config of the options if given, otherwise the config in the
/// header.
/// @param header header of a shard's journal
/// @param journal file of this journal
/// @param identity everything on which the results of the runs depend
/// @throws InputError if the config differs from the config of the shards
Config configOfShards(const ManyRunsOptions& options, const JournalHeader& header,
                      const std::filesystem::path& journal,
                      const std::function<Identity(const Config&)>& identity);

/// All runs of the shards, in the order of `items`.
/// @throws InputError naming the first folder in which runs are missing
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
