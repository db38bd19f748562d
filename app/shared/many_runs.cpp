// SPDX-License-Identifier: BSD-3-Clause
#include "shared/many_runs.hpp"
#include "shared/command_io.hpp"
#include "shared/path_inside.hpp"

#include <algorithm>

namespace photonav {
namespace fs = std::filesystem;

bool isMerge(const ManyRunsOptions& options, const RunWords& words) {
    if (!options.merge.empty()) {
        if (!options.shard && !options.resume) return true;
        throw InputError("--merge", "", "goes without --shard and --resume");
    }
    if (!options.config.empty()) return false;
    throw InputError(words.command, "", "give a CONFIG, or --merge with the folders of its shards");
}

Shard shardOf(const ManyRunsOptions& options) {
    return options.shard ? parseShard(*options.shard) : Shard{};
}

fs::path folderOf(const ManyRunsOptions& options, const RunWords& words, const std::string& name,
                  const Shard& shard) {
    if (!options.out.empty()) return options.out;
    fs::path folder = fs::path("out") / fmt::format("{}-{}", words.command, name);
    if (shard.count > 1) folder += fmt::format("-{}of{}", shard.index, shard.count);
    return folder;
}

FolderTransaction beginRuns(const ManyRunsOptions& options, const fs::path& folder,
                            InputPaths inputs) {
    inputs.emplace_back(options.config);
    inputs.insert(inputs.end(), options.merge.begin(), options.merge.end());
    return beginResult(folder, inputs, FolderTransaction::Unfinished::kept);
}

void reportNewBegin(const ManyRunsOptions& options, const FolderTransaction& folder,
                    const RunWords& words) {
    const std::string target = folder.target().string();
    if (!Manifest::read(target).empty()) {
        throw InputError("--resume", target,
                         fmt::format("holds a result, but not {} to go on with; give another "
                                     "folder (--out)",
                                     words.aWhole));
    }
    if (options.quiet) return;
    printMessage(
        fmt::format("--resume: {}: nothing there yet; {} begins anew", target, words.theWhole));
}

void RemainingTime::count(const std::string& planner, double seconds, double wall) {
    --open_[planner];
    auto& [sum, runs] = taken_[planner];
    sum += seconds;
    runs += 1.;
    wall_ = wall;
}

std::pair<double, double> RemainingTime::all() const {
    std::pair<double, double> sum{0., 0.};
    for (const auto& entry : taken_) {
        sum.first += entry.second.first;
        sum.second += entry.second.second;
    }
    return sum;
}

double RemainingTime::seconds(double wall) const {
    double rest = 0.;
    for (const auto& [planner, runs] : open_) {
        const auto known = taken_.find(planner);
        const auto& [seconds, count] = known != taken_.end() ? known->second : all();
        rest += runs * seconds / std::max(count, 1.);
    }
    const double taken = all().first;
    return taken > 0. ? std::max(0., rest * wall_ / taken - (wall - wall_)) : 0.;
}

std::string RemainingTime::text(double wall) const {
    if (taken_.empty()) return "";
    return remainingText(seconds(wall));
}

void checkIsSame(const JournalHeader& found, const JournalHeader& wanted, const RunWords& words,
                 const std::function<Identity(const Identity&)>& runIdentity,
                 const fs::path& file) {
    const std::string changed =
        difference(runIdentity(wanted.identity), runIdentity(found.identity));
    if (!changed.empty()) {
        throw InputError(
            "--resume", file.string(),
            fmt::format("{} was begun with another config: {}", words.theWhole, changed));
    }
    if (!(found.shard == wanted.shard)) {
        throw InputError(
            "--resume", file.string(),
            fmt::format("holds shard {}, not {}", toString(found.shard), toString(wanted.shard)));
    }
}

void checkIsNotWritten(const std::string& folder) {
    if (!WorkingFolder::isLocked(folder)) return;
    throw InputError("--merge", folder, "another photonav is writing it");
}

void checkMakeOneWhole(const std::vector<std::string>& folders,
                       const std::vector<JournalHeader>& shards) {
    std::map<unsigned, std::string> folderOf;
    const JournalHeader& first = shards.front();
    for (std::size_t i = 0; i < shards.size(); ++i) {
        const JournalHeader& header = shards[i];
        const auto refuse = [&](const std::string& reason) {
            throw InputError("--merge", folders[i], reason);
        };
        const std::string changed = difference(header.identity, first.identity);
        if (!changed.empty()) refuse(changed + ", as in " + folders.front());
        const std::string shard = toString(header.shard);
        if (header.shard.count != first.shard.count) {
            refuse(fmt::format("is shard {}, {} is shard {}", shard, folders.front(),
                               toString(first.shard)));
        }
        const auto [known, isNew] = folderOf.emplace(header.shard.index, folders[i]);
        if (!isNew) refuse(fmt::format("is shard {}, as is {}", shard, known->second));
    }
    for (unsigned k = 1; k <= first.shard.count; ++k) {
        if (folderOf.contains(k)) continue;
        throw InputError("--merge", "shard " + toString({k, first.shard.count}), "missing");
    }
}

void checkIsNoShard(const ManyRunsOptions& options, const fs::path& target) {
    for (const std::string& shard : options.merge) {
        if (!isInside(target, shard)) continue;
        throw InputError("--merge", shard, "the result needs another folder (--out)");
    }
}

Config configOfShards(const ManyRunsOptions& options, const JournalHeader& header,
                      const fs::path& journal,
                      const std::function<Identity(const Config&)>& identity) {
    Config config = options.config.empty()
                        ? parseConfig(header.config, journal.string(), options.overrides)
                        : loadConfig(options.config, options.overrides);
    const std::string changed = difference(header.identity, identity(config));
    if (changed.empty()) return config;
    throw InputError("--merge", options.merge.front(), changed + ", as in " + config.file);
}

}  // namespace photonav
