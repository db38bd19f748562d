// SPDX-License-Identifier: BSD-3-Clause
#include "explorations/explore_command.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "exploration/real_time_json.hpp"
#include "exploration/trial_journal.hpp"
#include "explorations/explore_report.hpp"
#include "explorations/flight_watch.hpp"
#include "figures/explore_film.hpp"
#include "flights/flight_recording.hpp"
#include "io/error.hpp"
#include "io/stopwatch.hpp"
#include "onlinemap/known_map.hpp"
#include "plans/plan_progress.hpp"
#include "report/problem_report.hpp"
#include "result/json_values.hpp"
#include "result/text_table.hpp"
#include "shared/command_io.hpp"
#include "shared/result_folder.hpp"

namespace photonav {
namespace fs = std::filesystem;
namespace {

void printFlight(const ExplorationResult& flight, const ExplorationSummary& s) {
    fmt::print("{} after {:.1f} m and {:.1f} s{}\n", nameOf(flight.end), flight.flown,
               flight.duration, flight.reason.empty() ? "" : ": " + flight.reason);
    fmt::print(
        "position error (rms) {}, NEES {:.2f} (1: consistent)\n"
        "goal error {}, believed standard deviation of the pose {} (root of the weighted trace)\n"
        "{} keyframes{}\n",
        lengthText(s.positionRmse), s.nees, lengthText(flight.goalError),
        lengthText(std::sqrt(s.goalTrace)), flight.keyframes,
        std::isfinite(s.updateMedian) ? fmt::format(", update {:.0f} ms (95 %: {:.0f} ms)",
                                                    1e3 * s.updateMedian, 1e3 * s.update95)
                                      : "");
    if (!flight.realTime) return;
    for (const auto& [what, value] : realTimeRows(*flight.realTime)) {
        fmt::print("{}: {}\n", what, value);
    }
}

void printSummary(const std::vector<ExplorationSummary>& summaries) {
    TextTable table{{"planner", "arrived", "collisions", "error (rms)", "NEES (median)",
                     "goal error", "duration", "length", "decided after", "mean trace"},
                    {}};
    for (const ExplorationSummary& s : summaries) {
        table.rows.push_back(
            {s.planner, fmt::format("{} of {}", s.arrived, s.flights),
             fmt::format("{}", s.collisions), lengthText(s.positionRmse),
             fmt::format("{:.2f} ({:.2f})", s.nees, s.neesMedian), lengthText(s.goalError),
             fmt::format("{:.1f} s", s.duration), fmt::format("{:.1f} m", s.length),
             std::isfinite(s.decidedAfter) ? fmt::format("{:.1f} m", s.decidedAfter) : "-",
             fmt::format("{:.3g} m²", s.meanTrace)});
    }
    fmt::print("{}", alignedText(table));
}

bool hasArrived(const std::vector<ExplorationResult>& flights) {
    for (const ExplorationResult& flight : flights) {
        if (flight.planner == flights.front().planner && flight.hasArrived()) return true;
    }
    return false;
}

FolderTransaction beginExploration(const ExploreOptions& options, const Config& config,
                                   const fs::path& folder) {
    return beginRuns(options, folder, inputsOf(config));
}

void print(const ExploreOutcome& outcome) {
    const std::vector<ExplorationResult>& flights = outcome.flights;
    if (flights.size() == 1) printFlight(flights.front(), outcome.summaries.front());
    if (flights.size() > 1) printSummary(outcome.summaries);
    if (outcome.asked > 1) {
        fmt::print("{} of {} flights ended{}\n", outcome.ended, outcome.asked,
                   outcome.interrupted ? " and are kept; fly the others with --resume" : "");
    }
}

/// A film that was interrupted is not kept.
void film(const ExploreOptions& options, const ExplorationSetup& setup, const World& world,
          const fs::path& folder, ExploreOutcome& outcome, const std::atomic<bool>& interrupted) {
    if (!outcome.log || outcome.log->moments.empty()) {
        printMessage("warning: no film: the first flight has no log");
        return;
    }
    ProgressLine line(options.quiet);
    writeFilm(folder / "film.webm", *outcome.log, viewFromAbove(setup.config, world, {}),
              interrupted,
              [&](double share) { line.show(fmt::format("film: {:.0f} %", 100. * share), share); });
    if (!interrupted) return;
    fs::remove(folder / "film.webm");
    outcome.interrupted = true;
}

/// The last step of every exploration: report, film, print.
int conclude(const ExploreOptions& options, const ExplorationSetup& setup, const World& world,
             FolderTransaction& folder, ExploreOutcome outcome, const Stopwatch& watch,
             const std::atomic<bool>& interrupted) {
    outcome.summaries =
        summariesByPlanner(outcome.flights, setup.config.belief.characteristicLength);
    nlohmann::json result = exploreResult(setup, outcome);
    result["time"]["total_s"] = watch.seconds();
    writeExploreReport(folder.path(), setup, world, outcome, result);
    if (options.film) film(options, setup, world, folder.path(), outcome, interrupted);
    concludeResult(folder, options, result, [&] { print(outcome); });
    if (outcome.interrupted) return kInterrupted;
    return hasArrived(outcome.flights) ? kDone : kNoAnswer;
}

/// The progress of many flights on a line.
class ExploreProgress {
  public:
    ExploreProgress(bool quiet, std::size_t asked, const std::vector<TrialItem>& open)
        : line_(quiet), rest_(open), asked_(asked), flown_(asked - open.size()) {}

    void onEnd(const ExplorationResult& flight) {
        ++flown_;
        arrived_ += flight.hasArrived();
        rest_.count(flight.planner, flight.wallSeconds, running_.seconds());
    }

    void onUpdate(const ExplorationResult& flight) {
        const PlanUpdate& update = flight.updates.back();
        line_.show(fmt::format(
            "{} of {} flights, {} arrived; {}, seed {}: {:.1f} s, {:.1f} m flown, {}{}", flown_,
            asked_, arrived_, flight.planner, flight.seed, update.time, flight.flown,
            std::isnan(update.length) ? "no way" : fmt::format("{:.1f} m to go", update.length),
            rest_.text(running_.seconds())));
    }

  private:
    ProgressLine line_;
    RemainingTime rest_;
    Stopwatch running_;
    std::size_t asked_, flown_, arrived_ = 0;
};

/// Flies those of `items` that the journal lacks, and adds them.
/// @return the first flight as far as it was flown, if it was interrupted
std::optional<ExplorationResult> flyMissing(const ExploreOptions& options,
                                            const ExplorationSetup& setup,
                                            const std::vector<TrialItem>& items,
                                            TrialJournal& journal, FlightRecording& recording,
                                            FlightWatch& watch, const fs::path& folder,
                                            const std::atomic<bool>& interrupted) {
    const std::vector<TrialItem> open = journal.missing(items);
    std::optional<ExplorationResult> cut;
    ExploreProgress progress(options.quiet, items.size(), open);
    const auto onEnd = [&](ExplorationResult flight) {
        const bool isFirst = itemOf(flight) == items.front();
        const bool isCut = flight.end == FlightEnd::stopped;
        if (isFirst && !(isCut && watch.isBehindStored())) watch.finish(flight, folder);
        if (!isCut) {
            progress.onEnd(flight);
            if (!isFirst) flight.map.reset();
            journal.append(std::move(flight));
            if (isFirst) watch.removeStored();
        } else if (isFirst) {
            cut = std::move(flight);
        }
    };
    const auto onUpdate = [&](const ExplorationResult& soFar) { progress.onUpdate(soFar); };
    const bool isWatched = !open.empty() && open.front() == items.front();
    exploreMany(setup, open, options.jobs, interrupted,
                {onEnd, onUpdate, recording.onExposure(),
                 isWatched ? watch.onMoment() : OnExplorationMoment{}});
    return cut;
}

/// @throws InputError where the first flight, which is to be recorded or watched, was flown before
void checkIsOpen(const ExploreOptions& options, bool isFlown) {
    if (!isFlown) return;
    if (!options.record.empty()) {
        throw InputError(
            "--record", "",
            "the first flight is finished, and its images were not stored: record a new run");
    }
    if (!options.serve.empty()) {
        throw InputError("--serve", "",
                         "the first flight has been flown: its report shows it again");
    }
}

/// The log of the first flight, which was flown before: in the folder that is being written, or in
/// the result that it will replace.
std::optional<FlightLog> earlierLog(const FolderTransaction& folder, const TrialItem& first) {
    std::optional<FlightLog> log = readFlightLog(folder.path(), first);
    return log ? log : readFlightLog(folder.target(), first);
}

/// @throws InputError where a killed program has left a flight, and this command does not fly it
///         again
void checkNoFlightIsLost(const ExploreOptions& options, const Config& config,
                         const FolderTransaction& folder, const TrialItem& first, bool isFlown) {
    const StoredFlight stored = storedFlight(folder.path());
    const bool isFirst = stored.name == nameOf(first);
    if (stored.keyframes == 0 || (isFirst && isFlown)) return;
    if (options.resume && isFirst && !config.explore.realtime) return;
    const std::string what = fmt::format("holds {} keyframes of a ", stored.keyframes);
    if (config.explore.realtime) {
        throw InputError(folder.path().string(), "",
                         what +
                             "killed flight in real time, which cannot be flown again: move that "
                             "folder away");
    }
    if (options.resume) {
        throw InputError(folder.path().string(), "",
                         fmt::format("{}flight that was killed, {}: go on with its planner and "
                                     "seed, or remove that folder",
                                     what, stored.name));
    }
    throw InputError(folder.path().string(), "",
                     what + "flight that was killed: go on with --resume, or remove that folder");
}

/// Stores the first flight while it is flown.
void store(const ExploreOptions& options, const ExplorationSetup& setup, const World& world,
           const JournalHeader& header, const TrialItem& first, const fs::path& folder,
           FlightWatch& watch) {
    JournalHeader ofFlight = header;
    ofFlight.name = nameOf(first);
    const std::size_t earlier = watch.storeIn(std::make_unique<FlightStore>(
        folder, ofFlight, pageSoFar(setup, world, header.name, options.commandLine)));
    if (earlier == 0 || options.quiet) return;
    printMessage(
        fmt::format("{}: killed after {} keyframes; it is flown again from its start, as its "
                    "seed says",
                    ofFlight.name, earlier));
}

/// Whether an interrupted exploration leaves what was there before: a killed flight that went on
/// longer than this one, or an earlier result of other flights or where nothing was done now.
bool leavesEarlierWork(const FlightWatch& watch, const TrialJournal& flights,
                       FolderTransaction& folder) {
    if (watch.isBehindStored()) {
        printMessage(fmt::format("the killed flight in {} stays", folder.path().string()));
        return true;
    }
    if (flights.runs().empty() && keepsEarlierResult(folder, watch.log().moments.empty())) {
        folder.discard();
        return true;
    }
    return leavesEarlierRuns(folder, flights);
}

void checkJobs(const ExploreOptions& options, const Config& config) {
    if (!config.explore.realtime || options.jobs <= 1) return;
    throw InputError("--jobs", fmt::format("{}", options.jobs),
                     "flights in real time (explore.realtime) are flown one after the other");
}

int exploreAll(const ExploreOptions& options, const std::atomic<bool>& interrupted) {
    const Stopwatch stopwatch;
    const auto address =
        options.serve.empty() ? std::optional<ServerAddress>{} : parseServerAddress(options.serve);
    const Config config = loadConfig(options.config, options.overrides);
    checkJobs(options, config);
    const Shard shard = shardOf(options);
    const std::vector<TrialItem> items = itemsOf(shard, trialItems(config));
    const World world = trueWorld(config);
    const PlanningProblem problem(config, world);
    const ExplorationSetup setup = setUpExploration(problem);
    {
        ProgressLine line(options.quiet);
        sayKappa(line, config, setup.config.belief.kappa);
    }
    const std::string name = fs::path(options.config).stem().string();
    FlightWatch watch(setup.config, world, items.front(), interrupted);
    if (address) {
        watch.serve(*address, livePage(setup, world, name, options.commandLine, watch.log()));
    }
    FolderTransaction folder =
        beginExploration(options, config, folderOf(options, TrialKind::kWords, name, shard));
    FlightRecording recording(options.record, folder.target(), inputsOf(config), setup.truth.camera,
                              setup.flight.tracker.map);
    const JournalHeader header{name, toYaml(config), TrialKind::identity(config), shard};
    std::vector<ExplorationResult> earlier = runsSoFar<TrialKind>(options, folder, header);
    keepMapOf(items.front(), earlier);
    const bool isFlown = std::any_of(
        earlier.begin(), earlier.end(),
        [&](const ExplorationResult& flight) { return itemOf(flight) == items.front(); });
    checkNoFlightIsLost(options, config, folder, items.front(), isFlown);
    checkIsOpen(options, isFlown);
    std::optional<FlightLog> log;
    if (isFlown) log = earlierLog(folder, items.front());
    TrialJournal journal = TrialJournal::create(folder.path(), header, std::move(earlier));
    if (log) writeFlightLog(folder.path(), *log);
    if (isFlown) {
        fs::remove(folder.path() / FlightStore::kWords.file);  // of a flight not asked for any more
    } else {
        store(options, setup, world, header, items.front(), folder.path(), watch);
    }

    const auto cut =
        flyMissing(options, setup, items, journal, recording, watch, folder.path(), interrupted);
    std::vector<ExplorationResult> flights = journal.runsOf(items);
    const std::size_t ended = flights.size();
    if (cut && leavesEarlierWork(watch, journal, folder)) return kInterrupted;
    if (cut) watch.removeStored();
    recording.commit();
    if (!isFlown) log = watch.log();
    if (cut) flights.insert(flights.begin(), *cut);
    return conclude(options, setup, world, folder,
                    {{.flights = std::move(flights),
                      .ended = ended,
                      .asked = items.size(),
                      .interrupted = ended < items.size()},
                     name,
                     options.commandLine,
                     std::move(log)},
                    stopwatch, interrupted);
}

/// The log of the first flight of a merged exploration, in the folder of its shard.
std::optional<FlightLog> logOfShards(const ExploreOptions& options, const TrialItem& first) {
    for (const std::string& folder : options.merge) {
        if (auto log = readFlightLog(folder, first)) return log;
    }
    return {};
}

int mergeExplorations(const ExploreOptions& options, const std::atomic<bool>& interrupted) {
    const Stopwatch watch;
    if (!options.record.empty()) throw InputError("--merge", "", "goes without --record");
    if (!options.serve.empty()) throw InputError("--merge", "", "goes without --serve");
    const auto shards = readShards<TrialKind>(options.merge);
    JournalHeader header = shards.front().header();
    const fs::path target = folderOf(options, TrialKind::kWords, header.name, {});
    checkIsNoShard(options, target);
    const Config config =
        configOfShards(options, header, shards.front().file(), TrialKind::identity);
    const auto items = trialItems(config);
    std::vector<ExplorationResult> flights = gather(options, shards, items);
    keepMapOf(items.front(), flights);
    if (flights.size() < items.size()) {
        throw InputError("--merge", "shard " + toString({1, header.shard.count}),
                         "the map of its first flight is missing; finish it with --resume");
    }
    const World world = trueWorld(config);
    const PlanningProblem problem(config, world);
    const ExplorationSetup setup = setUpExploration(problem);
    FolderTransaction folder = beginExploration(options, config, target);
    header.shard = {};
    TrialJournal::create(folder.path(), header, flights);
    std::optional<FlightLog> log = logOfShards(options, items.front());
    if (log) writeFlightLog(folder.path(), *log);
    return conclude(options, setup, world, folder,
                    {{.flights = std::move(flights), .ended = items.size(), .asked = items.size()},
                     header.name,
                     options.commandLine,
                     std::move(log)},
                    watch, interrupted);
}

}  // namespace

int runExplore(const ExploreOptions& options, const std::atomic<bool>& interrupted) {
    return isMerge(options, TrialKind::kWords) ? mergeExplorations(options, interrupted)
                                               : exploreAll(options, interrupted);
}

}  // namespace photonav
