// SPDX-License-Identifier: BSD-3-Clause
// The results of a sweep's runs, and the file that keeps each one as soon as it is done.
#pragma once

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "geometry/types.hpp"
#include "sweep/sweep_plan.hpp"

namespace photonav {

/// The result of one run. Numbers about the path are NaN when there is none.
struct SweepRun {
    SweepItem item;
    double cost, length, meanTrace, goalTrace;  ///< as in EvaluatedPath, with the item's alpha
    std::size_t vertices = 0;
    std::size_t views = 0;              ///< rendered by this run alone, with no cached views
    double seconds = 0.;                ///< planning with no cached views; wall clock
    std::string status;                 ///< "done", or why there is no path
    std::vector<Eigen::Vector3d> path;  ///< its waypoints in w [m]

    bool isSolved() const { return status == "done"; }
};

/// The first line of a sweep's file of runs.
struct SweepHeader {
    std::string name;    ///< of the config
    std::string config;  ///< YAML, complete
    SweepIdentity identity;
    SweepShard shard;
};

/// runs.jsonl: the header and one line per run, in the order they ended. Lines are only added, and
/// each is flushed: a killed sweep loses the runs in progress. An item has one run.
class SweepJournal {
  public:
    static constexpr const char* kFileName = "runs.jsonl";

    /// Begins a file with the runs done so far. One that is there stays whole until then.
    /// @throws InputError if it cannot be written
    static SweepJournal create(const std::filesystem::path& folder, const SweepHeader& header,
                               std::vector<SweepRun> runs = {});

    /// Reads the file of a folder; a last line that was cut is dropped, and so is a second run of
    /// an item.
    /// @throws InputError if it is missing or not ours, and for numbers that no run gives
    static SweepJournal read(const std::filesystem::path& folder);

    /// @throws InputError if it cannot be written
    void append(const SweepRun& run);

    const SweepHeader& header() const { return header_; }
    const std::vector<SweepRun>& runs() const { return runs_; }
    const std::filesystem::path& file() const { return file_; }

    /// The runs that belong to `items`.
    std::vector<SweepRun> runsOf(const std::vector<SweepItem>& items) const;

    /// Those of `items` that have no run yet.
    std::vector<SweepItem> missing(const std::vector<SweepItem>& items) const;

  private:
    explicit SweepJournal(std::filesystem::path file) : file_(std::move(file)) {}
    static SweepJournal readLines(const std::filesystem::path& folder);
    void write(const nlohmann::json& line);

    std::filesystem::path file_;
    SweepHeader header_;
    std::vector<SweepRun> runs_;
    std::uintmax_t size_ = 0;  ///< of the whole lines [bytes]
    std::ofstream stream_;
};

/// A run as result.json holds it, `path` left out.
nlohmann::json toJson(const SweepRun& run);

}  // namespace photonav
