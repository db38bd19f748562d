// SPDX-License-Identifier: BSD-3-Clause
// The file that keeps each of many runs as soon as it is done, as lines of JSON.
#pragma once

#include <filesystem>
#include <fstream>
#include <functional>
#include <nlohmann/json.hpp>
#include <string>

#include "runs/identity.hpp"
#include "runs/work_items.hpp"

namespace photonav {

/// What runs of a kind, and all of them together, are called in files and messages.
struct RunWords {
    const char* command;   ///< "sweep"
    const char* file;      ///< the journal's name, "runs.jsonl"
    const char* run;       ///< "run"
    const char* aWhole;    ///< "a sweep"
    const char* theWhole;  ///< "the sweep"
};

/// The first line of a journal.
struct JournalHeader {
    std::string name;    ///< of the config
    std::string config;  ///< YAML, complete
    Identity identity;
    Shard shard;
};

/// The lines of a journal: a header, then one per run, in the order they ended. Lines are only
/// added, and each is flushed: a killed program loses the runs in progress.
class JournalFile {
  public:
    JournalFile(const std::filesystem::path& folder, const RunWords& words)
        : path_(folder / words.file), words_(words) {}

    /// Begins a file with a header and whole lines. One that is there stays whole until then.
    /// @throws InputError if it cannot be written
    void create(const JournalHeader& header, const std::string& lines);

    /// Reads the header and each line; a last line that was cut is dropped.
    /// @param onLine throws for what is no run
    /// @throws InputError naming file and line if it is missing or not ours; those of onLine
    JournalHeader read(const std::function<void(const nlohmann::json&)>& onLine);

    /// @throws InputError if it cannot be written
    void append(const nlohmann::json& line);

    const std::filesystem::path& path() const { return path_; }

  private:
    JournalHeader readLines(const std::function<void(const nlohmann::json&)>& onLine);

    std::filesystem::path path_;
    RunWords words_;
    std::uintmax_t size_ = 0;  // of the whole lines [bytes]
    std::ofstream stream_;
};

}  // namespace photonav
