// SPDX-License-Identifier: BSD-3-Clause
#include "comparisons/reference_command.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

#include "io/error.hpp"
#include "io/file_lock.hpp"
#include "io/stopwatch.hpp"
#include "plans/plan_progress.hpp"
#include "shared/many_runs.hpp"
#include "sweep/reference_search.hpp"

namespace photonav {
namespace fs = std::filesystem;
namespace {

/// Makes a folder and checks that files can be written there, before any work is done.
void prepareFolder(const fs::path& folder) {
    std::error_code error;
    fs::create_directories(folder, error);
    if (error) throw InputError(folder.string(), "", "cannot be made: " + error.message());
    if (access(folder.c_str(), W_OK | X_OK) != 0) {
        throw InputError(folder.string(), "", std::string("not writable: ") + std::strerror(errno));
    }
}

/// With the effort of references, but the kappa of the sweeps that are compared with them.
Config withEffort(const Config& config, const ReferenceOptions& options, const World& world,
                  ProgressLine& line, const std::atomic<bool>& interrupted) {
    Config effort = withKappaSaid(config, world, line, interrupted);
    effort.vertices = options.vertices;
    effort.search.labels = options.labels;
    return effort;
}

std::string budgetOf(const ReferenceOptions& options, const Config& config) {
    return fmt::format(
        "alpha {}: {}, seeds {} to {}, {} vertices, {} labels, {} changes per descent",
        fmt::join(config.sweep.alphas, " "), fmt::join(config.sweep.planners, " "), config.seed,
        config.seed + options.runs - 1, config.vertices, config.search.labels, options.moves);
}

/// All plans of a reference search.
std::vector<SweepItem> itemsOf(const SweepConfig& sweep, unsigned runs) {
    std::vector<SweepItem> items;
    for (std::size_t i = 0; i < sweep.alphas.size() * runs; ++i) {
        for (const std::string& planner : sweep.planners) items.push_back({planner});
    }
    return items;
}

void print(const ReferenceTable& table) {
    fmt::print("traces in m²\n{:>6} {:>10} {:>9} {:>11} {:>11}  {}\n", "alpha", "cost", "length",
               "mean trace", "goal trace", "from");
    for (const double alpha : table.alphas()) {
        const ReferencePath& row = *table.at(alpha);
        fmt::print("{:>6} {:>10.6g} {:>7.2f} m {:>11.3g} {:>11.3g}  {}, {} vertices, seed {}\n",
                   row.alpha, row.cost, row.length, row.meanTrace, row.goalTrace, row.planner,
                   row.vertices, row.seed);
    }
}

}  // namespace

int runReference(const ReferenceOptions& options, const std::atomic<bool>& interrupted) {
    const Config given = loadConfig(options.config, options.overrides);
    const World world(given);
    const fs::path source(options.config);
    const fs::path file = options.file.empty() ? source.parent_path() / "reference" /
                                                     (source.stem().string() + ".csv")
                                               : fs::path(options.file);
    ReferenceTable table(file);
    prepareFolder(fs::absolute(file).parent_path());
    const FileLock lock(file);
    table.read();
    if (options.fromScratch) {
        for (const double alpha : given.sweep.alphas) table.setAside(alpha);
    }
    ProgressLine line(options.quiet);
    const Config config = withEffort(given, options, world, line, interrupted);
    RemainingTime rest(itemsOf(config.sweep, options.runs));
    const Stopwatch watch;
    bool isComplete = true;
    for (const double alpha : config.sweep.alphas) {
        Config own = config;
        own.belief.alpha = alpha;
        ReferenceSearch search(own, options.moves, world, table, interrupted);
        if (!options.fromScratch) {
            search.refresh();
            table.write();
        }
        for (std::uint32_t run = 0; run < options.runs && !interrupted; ++run) {
            for (const std::string& planner : config.sweep.planners) {
                const double begin = watch.seconds();
                line.show(fmt::format("alpha {}: {}, run {} of {}{}", alpha, planner, run + 1,
                                      options.runs, rest.text(begin)));
                search.plan(planner, config.seed + run);
                table.write();
                rest.count(planner, watch.seconds() - begin, watch.seconds());
            }
        }
        if (!interrupted) table.dropAside(alpha);
        table.write();
        isComplete = isComplete && table.at(alpha) != nullptr;
    }
    line.clear();
    if (!interrupted && options.runs > 0) {
        table.addNote(budgetOf(options, config));
        table.write();
    }
    if (!options.quiet) print(table);
    if (interrupted) return kInterrupted;
    return isComplete ? kDone : kNoAnswer;
}

}  // namespace photonav
