// SPDX-License-Identifier: BSD-3-Clause
#include "comparisons/sweep_command.hpp"

#include <fmt/format.h>

#include "comparisons/sweep_report.hpp"
#include "io/error.hpp"
#include "io/reading.hpp"
#include "io/stopwatch.hpp"
#include "plans/plan_progress.hpp"
#include "problem/planning_problem.hpp"

namespace photonav {
namespace fs = std::filesystem;
namespace {

std::string nameOf(const std::string& file) { return fs::path(file).stem().string(); }

/// The last step of every sweep: sort, report, print.
int conclude(const ManyRunsOptions& options, const Config& config, const World& world,
             FolderTransaction& folder, SweepOutcome outcome, const ReferenceCosts& reference,
             const Stopwatch& watch) {
    outcome.commandLine = options.commandLine;
    outcome.seconds = watch.seconds();
    const nlohmann::json result = sweepResult(config, outcome, reference);
    writeSweepReport(folder.path(), config, world, outcome, reference, result);
    concludeResult(folder, options, result, [&] {
        fmt::print("{}\n", sweepTable(summarize(config.sweep, outcome.runs, reference)));
        std::map<std::string, int> failures;
        for (const SweepRun& run : outcome.runs) {
            if (!run.isSolved()) ++failures[run.item.planner + ": " + run.status];
        }
        for (const auto& [reason, runs] : failures) fmt::print("{} ({} runs)\n", reason, runs);
        fmt::print("{} of {} runs, {}\n", outcome.runs.size(), outcome.asked,
                   durationText(outcome.seconds));
    });
    if (outcome.interrupted) return kInterrupted;
    return result["status"] == "done" ? kDone : kNoAnswer;
}

ReferenceCosts referenceOf(const Config& config) {
    if (config.sweep.reference.empty()) return {};
    try {
        return reading(config.sweep.reference,
                       [&] { return ReferenceCosts(config.sweep.reference); });
    } catch (const InputError& error) {
        throw config.invalid("sweep.reference", error.what());
    }
}

FolderTransaction beginSweep(const ManyRunsOptions& options, const Config& config,
                             const fs::path& folder) {
    return beginRuns(options, folder, inputsOf(config));
}

int sweepAll(const ManyRunsOptions& options, const std::atomic<bool>& interrupted) {
    const Stopwatch watch;
    const Config config = loadConfig(options.config, options.overrides);
    checkSeeds(config, config.sweep.runs);
    const ReferenceCosts reference = referenceOf(config);
    const Shard shard = shardOf(options);
    const World world(config);
    PlanningProblem(config, world).checkPlaces();
    const std::string name = nameOf(options.config);
    FolderTransaction folder =
        beginSweep(options, config, folderOf(options, SweepKind::kWords, name, shard));
    const auto items = itemsOf(shard, sweepItems(config));
    const JournalHeader header{name, toYaml(config), sweepIdentity(config), shard};
    SweepJournal journal =
        SweepJournal::create(folder.path(), header, runsSoFar<SweepKind>(options, folder, header));

    const auto open = journal.missing(items);
    ProgressLine line(options.quiet);
    const Config planned = withKappaSaid(config, world, line, interrupted);  // for all seeds
    RemainingTime rest(open);
    const Stopwatch running;
    std::size_t done = items.size() - open.size();
    line.show(fmt::format("{} of {} runs", done, items.size()));
    runItems(planned, world, open, options.jobs, interrupted, [&](const SweepRun& run) {
        journal.append(run);
        const double wall = running.seconds();
        rest.count(run.item.planner, run.seconds, wall);
        line.show(fmt::format("{} of {} runs, {} done{}", ++done, items.size(), nameOf(run.item),
                              rest.text(wall)));
    });
    line.clear();
    const bool stopped = interrupted && !journal.missing(items).empty();
    if (stopped && leavesEarlierRuns(folder, journal)) return kInterrupted;
    return conclude(options, planned, world, folder,
                    {name, "", shard, journal.runsOf(items), items.size(), stopped, 0.}, reference,
                    watch);
}

int mergeSweep(const ManyRunsOptions& options, const std::atomic<bool>& interrupted) {
    const Stopwatch watch;
    const auto shards = readShards<SweepKind>(options.merge);
    JournalHeader header = shards.front().header();
    const fs::path target = folderOf(options, SweepKind::kWords, header.name, {});
    checkIsNoShard(options, target);
    const Config config =
        configOfShards(options, header, shards.front().file(), SweepKind::identity);
    checkSeeds(config, config.sweep.runs);
    const ReferenceCosts reference = referenceOf(config);
    const World world(config);
    ProgressLine line(options.quiet);
    const Config planned = withKappaSaid(config, world, line, interrupted);
    const auto items = sweepItems(config);
    auto runs = gather(options, shards, items);
    FolderTransaction folder = beginSweep(options, config, target);
    header.shard = {};
    SweepJournal::create(folder.path(), header, runs);
    return conclude(options, planned, world, folder,
                    {header.name, "", {}, std::move(runs), items.size(), false, 0.}, reference,
                    watch);
}

}  // namespace

int runSweep(const ManyRunsOptions& options, const std::atomic<bool>& interrupted) {
    return isMerge(options, SweepKind::kWords) ? mergeSweep(options, interrupted)
                                               : sweepAll(options, interrupted);
}

}  // namespace photonav
