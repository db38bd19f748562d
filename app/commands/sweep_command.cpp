// SPDX-License-Identifier: BSD-3-Clause
#include "commands/sweep_command.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <unistd.h>

#include <memory>

#include "commands/result_folder.hpp"
#include "io/atomic_file.hpp"
#include "io/error.hpp"
#include "io/reading.hpp"
#include "io/stopwatch.hpp"
#include "problem/planning_problem.hpp"
#include "report/sweep_report.hpp"
#include "result/json_values.hpp"

namespace photonav {
namespace fs = std::filesystem;
namespace {

/// The config, with what was typed in place of its values.
Config loadSweepConfig(const SweepOptions& options, const std::string& file) {
    Config config = loadConfig(file, options.lists.after(options.overrides));
    checkSeeds(config, config.sweep.runs);
    return config;
}

std::string nameOf(const std::string& file) { return fs::path(file).stem().string(); }

/// Remaining time from what each planner's runs took so far.
class RemainingTime {
  public:
    explicit RemainingTime(const std::vector<SweepItem>& open) {
        for (const SweepItem& item : open) ++open_[item.planner];
    }

    void count(const SweepRun& run, double wallSeconds) {
        --open_[run.item.planner];
        auto& [seconds, runs] = taken_[run.item.planner];
        seconds += run.seconds;
        runs += 1.;
        planned_ += run.seconds;
        wall_ = wallSeconds;
    }

    /// Planning time that is left, times what the clock showed per second of planning.
    double seconds() const {
        double rest = 0.;
        for (const auto& [planner, runs] : open_) {
            const auto known = taken_.find(planner);
            const auto& [seconds, count] = known != taken_.end() ? known->second : all();
            rest += runs * seconds / std::max(count, 1.);
        }
        return planned_ > 0. ? rest * wall_ / planned_ : 0.;
    }

  private:
    std::pair<double, double> all() const {
        std::pair<double, double> sum{0., 0.};
        for (const auto& entry : taken_) {
            sum.first += entry.second.first;
            sum.second += entry.second.second;
        }
        return sum;
    }

    std::map<std::string, double> open_;                      // runs
    std::map<std::string, std::pair<double, double>> taken_;  // seconds, runs
    double planned_ = 0., wall_ = 0.;
};

std::string durationText(double seconds) {
    const auto total = std::lround(seconds);
    if (total < 120) return fmt::format("{} s", total);
    if (total < 7200) return fmt::format("{} min", (total + 30) / 60);
    return fmt::format("{:.1f} h", static_cast<double>(total) / 3600.);
}

void sortRuns(std::vector<SweepRun>& runs, const std::vector<SweepItem>& items) {
    std::map<SweepItem, std::size_t> order;
    for (const SweepItem& item : items) order.emplace(item, order.size());
    std::sort(runs.begin(), runs.end(), [&](const SweepRun& a, const SweepRun& b) {
        return order.at(a.item) < order.at(b.item);
    });
}

/// The last step of every sweep: sort, report, print.
int conclude(const SweepOptions& options, const Config& config, const World& world,
             FolderTransaction& folder, SweepOutcome outcome, const ReferenceCosts& reference,
             const Stopwatch& watch) {
    sortRuns(outcome.runs, sweepItems(config));
    outcome.commandLine = options.commandLine;
    outcome.seconds = watch.seconds();
    const nlohmann::json result = sweepResult(config, outcome, reference);
    writeSweepReport(folder.path(), config, world, outcome, reference, result);
    folder.commit();
    if (options.json) {
        fmt::print("{}", jsonText(result));
    } else if (!options.quiet) {
        fmt::print("{}\n",
                   sweepTable(config.sweep, summarize(config.sweep, outcome.runs, reference)));
        std::map<std::string, int> failures;
        for (const SweepRun& run : outcome.runs) {
            if (!run.isSolved()) ++failures[run.item.planner + ": " + run.status];
        }
        for (const auto& [reason, runs] : failures) fmt::print("{} ({} runs)\n", reason, runs);
        fmt::print("{} of {} runs, {}\nreport: {}\n", outcome.runs.size(), outcome.asked,
                   durationText(outcome.seconds), (folder.target() / "report.html").string());
    }
    if (outcome.interrupted) return kInterrupted;
    return result["status"] == "done" ? kDone : kNoAnswer;
}

ReferenceCosts referenceOf(const Config& config) {
    if (config.sweep.reference.empty()) return {};
    try {
        return reading(config.sweep.reference,
                       [&] { return ReferenceCosts(config.sweep.reference); });
    } catch (const InputError& error) {
        throw InputError(config.file, "sweep.reference", error.what());
    }
}

/// @throws InputError unless the runs are those of this sweep. Which runs are wanted may have
///         changed, what they depend on may not.
void checkIsSame(const SweepJournal& journal, const SweepHeader& header) {
    const std::string file = journal.file().string();
    const std::string changed =
        difference(runIdentity(header.identity), runIdentity(journal.header().identity));
    if (!changed.empty()) {
        throw InputError("--resume", file, "the sweep was begun with another config: " + changed);
    }
    if (!(journal.header().shard == header.shard)) {
        throw InputError("--resume", file,
                         fmt::format("holds shard {}, not {}", toString(journal.header().shard),
                                     toString(header.shard)));
    }
}

/// The runs so far, of a sweep that was killed or of one that ended, or a new file where there are
/// none.
SweepJournal openJournal(const SweepOptions& options, const FolderTransaction& folder,
                         const SweepHeader& header) {
    const auto hasRuns = [](const fs::path& path) {
        return fs::exists(path / SweepJournal::kFileName);
    };
    const bool wasKilled = hasRuns(folder.path());
    if (wasKilled && !options.resume) {
        throw InputError(folder.path().string(), "",
                         fmt::format("holds {} runs of a sweep that was killed: go on with "
                                     "--resume, or remove that folder",
                                     SweepJournal::read(folder.path()).runs().size()));
    }
    const fs::path source = wasKilled ? folder.path() : folder.target();
    if (!options.resume || !hasRuns(source)) return SweepJournal::create(folder.path(), header);
    SweepJournal journal = SweepJournal::read(source);
    checkIsSame(journal, header);
    return SweepJournal::create(folder.path(), header, journal.runs());
}

fs::path sweepFolder(const SweepOptions& options, const std::string& name,
                     const SweepShard& shard) {
    fs::path folder = options.out;
    if (folder.empty()) {
        folder = fs::path("out") / ("sweep-" + name);
        if (shard.count > 1) folder += fmt::format("-{}of{}", shard.index, shard.count);
    }
    return folder;
}

FolderTransaction beginSweep(const SweepOptions& options, const Config& config,
                             const fs::path& folder) {
    InputPaths inputs{config.sceneFile, config.mapFile, config.sweep.reference, options.config};
    inputs.insert(inputs.end(), options.merge.begin(), options.merge.end());
    return beginResult(folder, inputs, FolderTransaction::Unfinished::kept);
}

int runAll(const SweepOptions& options, const std::atomic<bool>& interrupted) {
    const Stopwatch watch;
    const Config config = loadSweepConfig(options, options.config);
    const ReferenceCosts reference = referenceOf(config);
    const SweepShard shard = options.shard ? parseShard(*options.shard) : SweepShard{};
    const World world(config);
    PlanningProblem(config, world).checkPlaces();
    const std::string name = nameOf(options.config);
    FolderTransaction folder = beginSweep(options, config, sweepFolder(options, name, shard));
    const auto items = itemsOf(shard, sweepItems(config));
    SweepJournal journal =
        openJournal(options, folder, {name, toYaml(config), sweepIdentity(config), shard});

    const auto open = journal.missing(items);
    {
        ProgressLine line(options.quiet);
        RemainingTime rest(open);
        const Stopwatch running;
        std::size_t done = items.size() - open.size();
        line.show(fmt::format("{} of {} runs", done, items.size()));
        runItems(config, world, open, options.jobs, interrupted, [&](const SweepRun& run) {
            journal.append(run);
            rest.count(run, running.seconds());
            line.show(fmt::format("{} of {} runs, {} alpha {} seed {} done, about {} left", ++done,
                                  items.size(), run.item.planner, run.item.alpha, run.item.seed,
                                  durationText(rest.seconds())));
        });
    }
    const bool stopped = interrupted && !journal.missing(items).empty();
    return conclude(options, config, world, folder,
                    {name, "", shard, journal.runsOf(items), items.size(), stopped, 0.}, reference,
                    watch);
}

/// Shards that make one sweep.
/// @throws InputError naming the folder that does not fit
std::vector<SweepJournal> readShards(const std::vector<std::string>& folders) {
    std::vector<SweepJournal> shards;
    std::map<unsigned, std::string> folderOf;
    for (const std::string& folder : folders) {
        if (FolderTransaction::isBeingWritten(folder)) {
            throw InputError("--merge", folder, "another photonav is writing it");
        }
        SweepJournal& journal = shards.emplace_back(SweepJournal::read(folder));
        const SweepHeader& first = shards.front().header();
        const SweepHeader& header = journal.header();
        const std::string changed = difference(header.identity, first.identity);
        if (!changed.empty()) {
            throw InputError("--merge", folder, changed + ", as in " + folders.front());
        }
        if (header.shard.count != first.shard.count) {
            throw InputError("--merge", folder,
                             fmt::format("is shard {}, {} is shard {}", toString(header.shard),
                                         folders.front(), toString(first.shard)));
        }
        const auto [known, isNew] = folderOf.emplace(header.shard.index, folder);
        if (!isNew) {
            throw InputError(
                "--merge", folder,
                fmt::format("is shard {}, as is {}", toString(header.shard), known->second));
        }
    }
    const unsigned count = shards.front().header().shard.count;
    for (unsigned k = 1; k <= count; ++k) {
        if (folderOf.contains(k)) continue;
        throw InputError("--merge", fmt::format("shard {}/{}", k, count), "missing");
    }
    return shards;
}

/// The config that the shards keep. Nothing is written to the result's folder yet.
Config keptConfig(const SweepOptions& options, const SweepJournal& shard) {
    const fs::path copy =
        fs::temp_directory_path() / fmt::format("photonav_merge_{}.yaml", getpid());
    writeFileAtomically(copy, shard.header().config);
    const std::unique_ptr<const fs::path, void (*)(const fs::path*)> removed(
        &copy, [](const fs::path* file) { fs::remove(*file); });
    Config config = loadSweepConfig(options, copy.string());
    config.file = shard.file().string();
    return config;
}

/// The config of the shards: the one given, which must be theirs, or the one they keep.
Config configOfShards(const SweepOptions& options, const SweepJournal& shard) {
    const Config config = options.config.empty() ? keptConfig(options, shard)
                                                 : loadSweepConfig(options, options.config);
    const std::string changed = difference(shard.header().identity, sweepIdentity(config));
    if (changed.empty()) return config;
    throw InputError("--merge", options.merge.front(), changed + ", as in " + config.file);
}

/// @throws InputError naming the first folder with runs to do
void checkComplete(const SweepOptions& options, const std::vector<SweepJournal>& shards,
                   const std::vector<SweepItem>& items) {
    for (std::size_t i = 0; i < shards.size(); ++i) {
        const auto open = shards[i].missing(itemsOf(shards[i].header().shard, items));
        if (open.empty()) continue;
        throw InputError("--merge", options.merge[i],
                         fmt::format("{} runs are missing; finish it with --resume", open.size()));
    }
}

/// All runs of the shards as one sweep's.
SweepJournal gather(const std::vector<SweepJournal>& shards, const std::vector<SweepItem>& items,
                    const fs::path& folder) {
    SweepHeader header = shards.front().header();
    header.shard = {};
    std::vector<SweepRun> runs;
    for (const SweepJournal& shard : shards) {
        const auto own = shard.runsOf(items);
        runs.insert(runs.end(), own.begin(), own.end());
    }
    return SweepJournal::create(folder, header, std::move(runs));
}

int mergeShards(const SweepOptions& options) {
    const Stopwatch watch;
    const auto shards = readShards(options.merge);
    const std::string name = shards.front().header().name;
    const fs::path target = sweepFolder(options, name, {});
    for (const std::string& shard : options.merge) {
        std::error_code noFolder;  // none yet: no shard's
        if (fs::equivalent(shard, target, noFolder)) {
            throw InputError("--merge", shard, "the result needs another folder (--out)");
        }
    }
    const Config config = configOfShards(options, shards.front());
    const ReferenceCosts reference = referenceOf(config);
    const World world(config);
    const auto items = sweepItems(config);
    checkComplete(options, shards, items);
    FolderTransaction folder = beginSweep(options, config, target);
    const SweepJournal whole = gather(shards, items, folder.path());
    return conclude(options, config, world, folder,
                    {name, "", {}, whole.runs(), items.size(), false, 0.}, reference, watch);
}

}  // namespace

int runSweep(const SweepOptions& options, const std::atomic<bool>& interrupted) {
    if (!options.merge.empty()) {
        if (options.shard || options.resume) {
            throw InputError("--merge", "", "goes without --shard and --resume");
        }
        return mergeShards(options);
    }
    if (options.config.empty()) {
        throw InputError("sweep", "", "give a CONFIG, or --merge with the folders of its shards");
    }
    return runAll(options, interrupted);
}

}  // namespace photonav
