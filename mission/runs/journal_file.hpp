// SPDX-License-Identifier: BSD-3-Clause
// The file of a journal: one line of JSON per finished run, written as soon as the run is done,
// with a checksum.
#pragma once

#include <filesystem>
#include <fstream>
#include <functional>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "runs/identity.hpp"
#include "runs/work_items.hpp"

namespace photonav {

/// The words for runs of a kind, and for all of them together, in files and messages.
struct RunWords {
    const char* command;   ///< "sweep"
    const char* file;      ///< file name of the journal, "runs.jsonl"
    const char* run;       ///< "run"
    const char* aWhole;    ///< "a sweep"
    const char* theWhole;  ///< "the sweep"
};

/// The first line of a journal.
struct JournalHeader {
    std::string name;    ///< name of the config
    std::string config;  ///< complete config as YAML
    Identity identity;
    Shard shard;
};

/// The text of a JSON object with the checksum of its further text as first key:
/// {"crc32":"01234567","alpha":0.5}. The inverse throws std::exception for text that was changed.
std::string withChecksum(std::string_view object);
std::string withoutChecksum(std::string_view line);

/// The lines of a journal: a header, then one line per run, in the order in which runs ended. Lines
/// are only appended, and each is flushed: a killed program loses only the unfinished runs.
class JournalFile {
  public:
    JournalFile(const std::filesystem::path& folder, const RunWords& words)
        : path_(folder / words.file), words_(words) {}

    /// Writes a new file with a header and complete lines. An older file is replaced when the new
    /// one is complete.
    /// @throws InputError if the file cannot be written
    void create(const JournalHeader& header, const std::vector<nlohmann::json>& lines = {});

    /// Reads the header and all lines. An incomplete last line is ignored.
    /// @param onLine called with each line after the header; throws if the line is no run
    /// @throws InputError naming file and line if the file is missing, is no journal of this kind,
    ///         was changed, or onLine throws
    JournalHeader read(const std::function<void(const nlohmann::json&)>& onLine);

    /// Appends a line. @throws InputError if the file cannot be written
    void append(const nlohmann::json& line);

    const std::filesystem::path& path() const { return path_; }

  private:
    JournalHeader readLines(const std::function<void(const nlohmann::json&)>& onLine);

    std::filesystem::path path_;
    RunWords words_;
    std::uintmax_t size_ = 0;  // size of all complete lines [bytes]
    std::ofstream stream_;
};

}  // namespace photonav
