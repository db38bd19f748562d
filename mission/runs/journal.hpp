// SPDX-License-Identifier: BSD-3-Clause
// A journal of finished runs, in memory and in a file.
#pragma once

#include <map>
#include <set>

#include "io/error.hpp"
#include "runs/journal_file.hpp"

namespace photonav {

/// The finished runs, in the order in which they ended, at most one per item. Kind (SweepKind,
/// TrialKind) describes the runs:
///
///     Item                   the input of a run; has an order
///     Run                    the result of a run
///     itemOf(run)            the item of a result
///     kWords                 RunWords
///     identity(config)       everything on which the results of all runs depend
///     runIdentity(identity)  the same without the keys that choose the runs
///     save(run, folder)      a run as JSON; may write other files into the journal's folder
///     load(line, folder)     the inverse of save()
///     reproducible(run)      a run as JSON, without what differs when it is repeated
///
/// and nameOf(item) is the name of an item in messages.
template <typename Kind>
class Journal {
  public:
    using Run = typename Kind::Run;
    using Item = typename Kind::Item;
    static constexpr const char* kFileName = Kind::kWords.file;

    /// Writes a new file with the given finished runs. An older file is replaced when the new one
    /// is complete.
    /// @throws InputError if the file cannot be written
    static Journal create(const std::filesystem::path& folder, const JournalHeader& header,
                          std::vector<Run> runs = {}) {
        Journal journal(folder);
        std::vector<nlohmann::json> lines;
        lines.reserve(runs.size());
        for (const Run& run : runs) lines.push_back(Kind::save(run, folder));
        journal.file_.create(header, lines);
        journal.header_ = header;
        journal.runs_ = std::move(runs);
        return journal;
    }

    /// Reads the file in a folder. An incomplete last line and a repeated run are ignored.
    /// @throws InputError if the file is missing or no journal of this kind, for impossible values,
    ///         and for two runs of the same item with different results
    static Journal read(const std::filesystem::path& folder) {
        Journal journal(folder);
        std::map<Item, std::size_t> known;
        journal.header_ = journal.file_.read([&](const nlohmann::json& line) {
            Run run = Kind::load(line, folder);
            const auto [first, isNew] = known.try_emplace(Kind::itemOf(run), journal.runs_.size());
            if (isNew) {
                journal.runs_.push_back(std::move(run));
            } else if (Kind::reproducible(run) !=
                       Kind::reproducible(journal.runs_[first->second])) {
                throw InputError(journal.file().string(), nameOf(first->first),
                                 "is there twice, with different results");
            }
        });
        return journal;
    }

    /// Adds a run. @throws InputError if the file cannot be written
    void append(Run run) {
        file_.append(Kind::save(run, folder_));
        runs_.push_back(std::move(run));
    }

    const JournalHeader& header() const { return header_; }
    const std::vector<Run>& runs() const { return runs_; }
    const std::filesystem::path& file() const { return file_.path(); }

    /// The runs of the given items, in the order of the items. Items without run are left out.
    std::vector<Run> runsOf(const std::vector<Item>& items) const {
        std::map<Item, const Run*> done;
        for (const Run& run : runs_) done.emplace(Kind::itemOf(run), &run);
        std::vector<Run> runs;
        for (const Item& item : items) {
            if (const auto run = done.find(item); run != done.end()) runs.push_back(*run->second);
        }
        return runs;
    }

    /// Whether this journal has every run of another one, whose runs depend on the same values.
    bool includes(const Journal& other) const {
        std::vector<Item> items;
        items.reserve(other.runs_.size());
        for (const Run& run : other.runs_) items.push_back(Kind::itemOf(run));
        return header_.shard == other.header_.shard &&
               Kind::runIdentity(header_.identity) == Kind::runIdentity(other.header_.identity) &&
               missing(items).empty();
    }

    /// The items that have no run yet.
    std::vector<Item> missing(const std::vector<Item>& items) const {
        std::set<Item> done;
        for (const Run& run : runs_) done.insert(Kind::itemOf(run));
        std::vector<Item> open = items;
        std::erase_if(open, [&](const Item& item) { return done.contains(item); });
        return open;
    }

  private:
    explicit Journal(const std::filesystem::path& folder)
        : folder_(folder), file_(folder, Kind::kWords) {}

    std::filesystem::path folder_;
    JournalFile file_;
    JournalHeader header_;
    std::vector<Run> runs_;
};

}  // namespace photonav
