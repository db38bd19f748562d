// SPDX-License-Identifier: BSD-3-Clause
// The runs that are done, of many of one kind, in memory and in a file.
#pragma once

#include <set>

#include "result/json_values.hpp"
#include "runs/journal_file.hpp"

namespace photonav {

/// Runs as they end; an item has one run. A kind of run (SweepKind, TrialKind) has
///
///     Item     what is run, ordered            Run    its result
///     kWords   RunWords                        itemOf(run)
///     identity(config)                         what the results depend on
///     runIdentity(identity)                    a single run: without what chooses the runs
///     save(run, folder), load(line, folder)    the JSON of a run, and any files beside the journal
template <typename Kind>
class Journal {
  public:
    using Run = typename Kind::Run;
    using Item = typename Kind::Item;
    static constexpr const char* kFileName = Kind::kWords.file;

    /// Begins a file with the runs done so far. One that is there stays whole until then.
    /// @throws InputError if it cannot be written
    static Journal create(const std::filesystem::path& folder, const JournalHeader& header,
                          std::vector<Run> runs = {}) {
        Journal journal(folder);
        std::string lines;
        for (const Run& run : runs) lines += jsonLine(Kind::save(run, folder));
        journal.file_.create(header, lines);
        journal.header_ = header;
        journal.runs_ = std::move(runs);
        return journal;
    }

    /// Reads the file of a folder; a last line that was cut is dropped, and so is a second run of
    /// an item.
    /// @throws InputError if it is missing or not ours, and for numbers that no run gives
    static Journal read(const std::filesystem::path& folder) {
        Journal journal(folder);
        std::set<Item> known;
        journal.header_ = journal.file_.read([&](const nlohmann::json& line) {
            Run run = Kind::load(line, folder);
            if (known.insert(Kind::itemOf(run)).second) journal.runs_.push_back(std::move(run));
        });
        return journal;
    }

    /// @throws InputError if it cannot be written
    void append(Run run) {
        file_.append(Kind::save(run, folder_));
        runs_.push_back(std::move(run));
    }

    const JournalHeader& header() const { return header_; }
    const std::vector<Run>& runs() const { return runs_; }
    const std::filesystem::path& file() const { return file_.path(); }

    /// The runs that belong to `items`, in their order.
    std::vector<Run> runsOf(const std::vector<Item>& items) const {
        std::map<Item, const Run*> done;
        for (const Run& run : runs_) done.emplace(Kind::itemOf(run), &run);
        std::vector<Run> runs;
        for (const Item& item : items) {
            if (const auto run = done.find(item); run != done.end()) runs.push_back(*run->second);
        }
        return runs;
    }

    /// Those of `items` that have no run yet.
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
